"""Shapes of ways that only the source has: splines, fixed orientations, levels."""
