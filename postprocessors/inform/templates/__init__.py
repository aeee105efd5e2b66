"""Macros of INFORM jobs; a package so that the wheel holds them."""
