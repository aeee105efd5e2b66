"""Signals and flags as only the source has them."""
