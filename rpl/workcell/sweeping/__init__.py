"""The search for contacts along the way of a cell: ways of robots, solids, what may meet what, and the sweep."""
