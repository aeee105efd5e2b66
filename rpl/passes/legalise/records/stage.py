"""What places and data are made of, where the target has no such types: parts, numbers, calculated poses. They stand
behind settings, because tools and frames of moves are places with names until then.
"""

from __future__ import annotations

from rpl.passes.legalise.records.aggregates import aggregates
from rpl.passes.legalise.records.arcdistances import arc_distances
from rpl.passes.legalise.records.arithmetic import arithmetic
from rpl.passes.legalise.records.flatrecords import flat_records
from rpl.passes.legalise.records.geometry import geometry
from rpl.passes.legalise.records.pathevents import path_events
from rpl.passes.legalise.records.seenplaces import posed_places, seen_places
from rpl.passes.legalise.records.unreadparameters import drop_unread_parameters
from rpl.passes.legalise.records.watching import watching
from rpl.passes.legalise.records.wholeturns import whole_turns
from rpl.passes.legalise.stages import Clause, Stage

STAGE = Stage(
    "records",
    (
        arc_distances,
        seen_places,
        posed_places,
        aggregates,
        geometry,
        whole_turns,
        flat_records,
        drop_unread_parameters,
        path_events,
        watching,
        arithmetic,
    ),
    Clause(
        statements="OrderInterrupt ResumeLevel StopMotion",
        functions="acos current_joints current_target distance euler_x euler_y euler_z frame_from_points "
        "inverse joints_to_target magnitude offset rotation_zyx tool_offset transform",
        operators="@",
        system="null_frame",
        types="NamedType SpeedType ToolType VectorType WorkObjectType ZoneType",
        further=frozenset(("declaration RecordDeclaration",)),
    ),
)
