"""Corners in the measure of the target, and what the program does while the robot drives through one."""
