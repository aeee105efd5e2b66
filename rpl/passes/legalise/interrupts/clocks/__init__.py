"""Clocks that interrupts stop, read or hold."""
