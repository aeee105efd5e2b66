"""The emulated arm: its kinematics, how its controller names a posture, the shape and the timing of its moves.

Nothing here knows a language or a vendor. Lengths are mm, times s; angles are radians inside and the robot's own
pendant degrees at the border of `rpl.emulator.model`. Import the module you need: this package imports nothing on its
own, so that reading and translating a program never pays for kinematics.
"""
