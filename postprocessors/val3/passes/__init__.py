"""What only VAL3 needs of a program, each pass with its place among those of the core, and right in front of the
writer."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .components import components_in_variables
from .exits import loops_left_by_flags
from .onenamespace import one_namespace, points_in_data
from .pulses import pulses_as_tasks
from .searches import searches_beside_the_queue
from .timers import timers_by_the_clock
from .waits import waits_put_in

PASSES: tuple[Placed, ...] = (
    Placed(components_in_variables, "records", behind="arithmetic"),
    Placed(timers_by_the_clock, "storage", before="drop_unused"),
    Placed(loops_left_by_flags, "storage", behind="number_data"),
    Placed(waits_put_in, "storage", behind="number_data"),
    Placed(searches_beside_the_queue, "storage", behind="number_data"),
    Placed(pulses_as_tasks, "storage", behind="number_data"),
)
LAST = (one_namespace, points_in_data)
