"""Runs linked programs: tasks, virtual clock, values, signals, trace. Entry: `rpl.simulation`.

`moves` is the robot's side of a run, `functions` what built-in names do.
"""
