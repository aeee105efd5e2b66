"""Frames, targets and postures, and the settings that hold for the next move only, which decide where it ends. They
stand behind errors, because places of the prelude are places too; before paths, because a way needs its ends.
"""

from __future__ import annotations

from rpl.passes.legalise.places.arcpoints import whole_arc_points
from rpl.passes.legalise.places.circles import circle_rules
from rpl.passes.legalise.places.destinations import destinations
from rpl.passes.legalise.places.externalplaces import external_places
from rpl.passes.legalise.places.nextmove.joinedmoves import joined_moves
from rpl.passes.legalise.places.nextmove.jointspeeds import joint_speeds
from rpl.passes.legalise.places.nextmove.movetimes import move_times
from rpl.passes.legalise.places.nextmove.nextmove import settings_of_next_move
from rpl.passes.legalise.places.nextmove.queuedwaits import queued_waits
from rpl.passes.legalise.places.nextmove.scaledaccelerations import scaled_accelerations
from rpl.passes.legalise.places.partialplaces import partial_places
from rpl.passes.legalise.places.postures.askedpostures import asked_postures
from rpl.passes.legalise.places.postures.configurations import configurations
from rpl.passes.legalise.places.postures.freepostures import free_postures
from rpl.passes.legalise.places.postures.jointgoals import joint_goals
from rpl.passes.legalise.places.postures.nearjoints import near_joints
from rpl.passes.legalise.places.postures.otherarms import places_on_other_arm
from rpl.passes.legalise.places.postures.seenjoints import seen_joints
from rpl.passes.legalise.places.postures.taughtpostures import taught_postures
from rpl.passes.legalise.places.postures.turns import told_turns
from rpl.passes.legalise.places.postures.unreachable import unreachable_moves
from rpl.passes.legalise.places.threepoints import three_point_arcs
from rpl.passes.legalise.stages import Clause, Stage

# What another arm needs, also where the language stays the same.
OTHER_ARM = (places_on_other_arm, configurations, unreachable_moves)

STAGE = Stage(
    "places",
    (
        queued_waits,
        settings_of_next_move,
        scaled_accelerations,
        joined_moves,
        move_times,
        joint_speeds,
        seen_joints,
        near_joints,
        asked_postures,
        joint_goals,
        partial_places,
        external_places,
        whole_arc_points,
        three_point_arcs,
        circle_rules,
        destinations,
        taught_postures,
        free_postures,
        *OTHER_ARM,
        told_turns,
    ),
    Clause(
        statements="SetForNextMove",
        system="posture_shoulder",
    ),
)
