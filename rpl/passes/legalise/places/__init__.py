"""Frames, targets, postures and what holds for the next move only. Behind it a move knows where it ends and how the
arm comes there.
"""
