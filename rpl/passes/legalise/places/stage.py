"""Frames, targets and postures. Taught data stays taught data; what is calculated has the target's means."""

from __future__ import annotations

from rpl.passes.legalise.data.aliases import without_aliases
from rpl.passes.legalise.paths.arcpoints import whole_arc_points
from rpl.passes.legalise.paths.circles import circle_rules
from rpl.passes.legalise.paths.threepoints import three_point_arcs
from rpl.passes.legalise.places.destinations import destinations
from rpl.passes.legalise.places.elementwise import elementwise
from rpl.passes.legalise.places.partialplaces import partial_places
from rpl.passes.legalise.postures.askedpostures import asked_postures
from rpl.passes.legalise.postures.configurations import configurations
from rpl.passes.legalise.postures.externalplaces import external_places
from rpl.passes.legalise.postures.flagreadings import flag_readings
from rpl.passes.legalise.postures.freepostures import free_postures
from rpl.passes.legalise.postures.jointgoals import joint_goals
from rpl.passes.legalise.postures.knownjoints import known_joints
from rpl.passes.legalise.postures.nearjoints import near_joints
from rpl.passes.legalise.postures.otherarms import places_on_other_arm
from rpl.passes.legalise.postures.seenjoints import seen_joints
from rpl.passes.legalise.postures.solvedplaces import solved_places
from rpl.passes.legalise.postures.turns import told_turns
from rpl.passes.legalise.stages import Stage

STAGE = Stage(
    "places",
    (
        seen_joints,
        near_joints,
        known_joints,
        solved_places,
        elementwise,
        asked_postures,
        joint_goals,
        partial_places,
        external_places,
        whole_arc_points,
        three_point_arcs,
        circle_rules,
        destinations,
        flag_readings,
        free_postures,
        places_on_other_arm,
        configurations,
        told_turns,
        without_aliases,
    ),
)
