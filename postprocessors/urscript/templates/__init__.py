"""Frames of URScript files; a package so that the wheel holds them."""
