"""What only URScript needs of a program, each pass with its place among those of the core, and right in front of
the writer."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .lists import gathered_lists
from .outputlevels import output_levels
from .partedcorners import parted_corners
from .readings import clean_readings
from .references import references_as_copies
from .taskstarts import stand_before_tasks

PASSES: tuple[Placed, ...] = (
    Placed(references_as_copies, "statements", behind="split_messages"),
    Placed(parted_corners, "settings", behind="settings_at_moves"),
    Placed(stand_before_tasks, "records", behind="watching"),
    Placed(clean_readings, "storage", behind="number_data"),
)
LAST = (gathered_lists, output_levels)
