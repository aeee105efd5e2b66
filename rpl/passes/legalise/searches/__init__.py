"""Moves that a condition ends. Behind it a search is one that the target has, or an interrupt ends the move."""
