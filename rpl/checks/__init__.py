"""Warnings about programs: they look at what was read and change nothing."""
