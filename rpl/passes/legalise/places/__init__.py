"""Frames, targets and what is calculated with them. Behind it a place is made of what the target has."""
