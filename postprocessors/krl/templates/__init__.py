"""Frames of KRL files; a package so that the wheel holds them."""
