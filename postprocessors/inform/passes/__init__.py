"""What only INFORM needs of a program, each pass with its place among those of the core, and right in front of the
writer."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed, again

from .asread import AS_READ
from .cutmoves import cut_moves
from .dialogs import number_dialogs
from .framenumbers import frame_numbers
from .groupsizes import groups_in_sizes
from .jointways import stand_before_ways
from .longconditions import short_conditions
from .pathpoints import path_points
from .shiftedpoints import shifted_points
from .watches import counted_watches

PASSES: tuple[Placed, ...] = (
    Placed(counted_watches, "io", behind="timers_to_clocks"),
    Placed(groups_in_sizes, "io", behind="shared_groups_to_bits"),
    Placed(again(groups_in_sizes, "some have their numbers by now"), "io", behind="named_numbers"),
    Placed(stand_before_ways, "settings", behind="reduced_zones"),
    Placed(frame_numbers, "settings", behind="stand_first"),
    Placed(shifted_points, "settings", behind="stand_first"),
    Placed(path_points, "records", behind="arc_distances"),
    Placed(short_conditions, "control", behind="steps"),
    Placed(again(short_conditions, "opposites of conditions are longer"), "control", behind="steps again"),
    Placed(number_dialogs, "statements", behind="decide_logic"),
)
LAST = (*AS_READ, cut_moves)
