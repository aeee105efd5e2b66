"""What places and data are made of, where the target has no such types: parts, numbers, calculated poses. They stand
behind settings, because tools and frames of moves are places with names until then.
"""

from __future__ import annotations

from rpl.passes.legalise.advance.arcdistances import arc_distances
from rpl.passes.legalise.advance.pathevents import path_events
from rpl.passes.legalise.advance.pathpoints import path_points
from rpl.passes.legalise.data.aggregates import aggregates
from rpl.passes.legalise.data.arithmetic import arithmetic
from rpl.passes.legalise.data.flatrecords import flat_records
from rpl.passes.legalise.interrupts.watching import watching
from rpl.passes.legalise.places.composition import compositions
from rpl.passes.legalise.places.geometry import geometry
from rpl.passes.legalise.places.seenplaces import posed_places, seen_places
from rpl.passes.legalise.postures.wholeturns import whole_turns
from rpl.passes.legalise.routines.unreadparameters import drop_unread_parameters
from rpl.passes.legalise.stages import Stage
from rpl.passes.legalise.tasks.taskstarts import stand_before_tasks

STAGE = Stage(
    "records",
    (
        arc_distances,
        path_points,
        seen_places,
        posed_places,
        aggregates,
        geometry,
        whole_turns,
        flat_records,
        drop_unread_parameters,
        compositions,
        path_events,
        watching,
        stand_before_tasks,
        arithmetic,
    ),
)
