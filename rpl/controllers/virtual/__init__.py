"""Virtual controllers: the emulator behind a maker's own interfaces, in a process of its own.

`cabinet` is the inside of a controller, the same for all makers: its files (`store`), the program that runs, mode,
drives, signals, where the robot stands. A maker's `server` puts its interfaces in front of it (`endpoints`), `faults`
are the ways in which it misbehaves when asked to, and `transcript` keeps what it was told.
"""
