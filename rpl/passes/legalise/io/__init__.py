"""Signals, groups, waits, clocks and pulses. Behind it they have the target's numbers, names and forms."""
