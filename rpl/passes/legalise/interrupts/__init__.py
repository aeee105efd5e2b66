"""Conditions that break into a program, and moves that a condition ends. Behind it they stand in the one form that the
target has.
"""
