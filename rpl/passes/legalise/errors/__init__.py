"""Handlers, raised errors and their names, and the source's own routines and data that the program uses. Behind it
errors have the numbers and texts of the target.
"""
