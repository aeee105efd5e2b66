"""Shapes of ways: arcs, circles, splines, how the wrist turns on them. Behind it each way is one that the target
drives.
"""
