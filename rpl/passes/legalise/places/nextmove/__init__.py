"""Settings that hold for the next move only, as settings of that move."""
