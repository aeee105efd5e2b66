"""Rewritings that VAL3 alone needs."""
