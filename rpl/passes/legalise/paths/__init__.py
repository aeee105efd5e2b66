"""Ways, and what a program does while the robot drives them. Behind it each way is one that the target drives."""
