"""Data of the source: what it is called, what it holds where no file says so, what is fixed."""
