"""The page that plays a run: its frame, its style and its scripts (drawing, motion, panels), put together by `page`."""
