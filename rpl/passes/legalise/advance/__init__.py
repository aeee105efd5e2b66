"""Programs that run ahead of the robot: corners, actions on the way, statements that wait for the robot."""
