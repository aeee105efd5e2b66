"""Tool, frame, speed, acceleration, load and override, at a move or before it. Behind it each stands where the target
says it.
"""
