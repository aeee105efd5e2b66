"""Handlers, raised errors and their names. Behind it errors are told and caught as the target does."""
