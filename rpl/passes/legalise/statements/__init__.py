"""Waits, messages, choices, conditions and calls. Behind it each is a statement or a function of the target."""
