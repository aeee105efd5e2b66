"""Runs linked programs: tasks, virtual clock, values, signals, motion queue, trace. Entry: `rpl.simulation`."""
