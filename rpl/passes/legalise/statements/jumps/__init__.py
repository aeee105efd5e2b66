"""Jumps as structure, for targets that have none."""
