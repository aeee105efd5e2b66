"""Tool, frame, speed, acceleration, corner and load: at each move or before it, as the target says them. They stand
behind statements, because calls of built-in routines make settings too.
"""

from __future__ import annotations

from rpl.passes.legalise.settings.accelerations import accelerations_of_moves
from rpl.passes.legalise.settings.coordinatedmoves import coordinated_moves
from rpl.passes.legalise.settings.corners.cornerleads import corner_leads
from rpl.passes.legalise.settings.corners.corners import corners
from rpl.passes.legalise.settings.corners.cornersteps import corner_steps
from rpl.passes.legalise.settings.corners.keptcorners import kept_corners
from rpl.passes.legalise.settings.corners.overlapping import left_out_moves
from rpl.passes.legalise.settings.corners.standing import stand_first
from rpl.passes.legalise.settings.corners.turningzones import reduced_zones
from rpl.passes.legalise.settings.corners.waitedmoves import waits_at_moves
from rpl.passes.legalise.settings.explicit import explicit_to_modal
from rpl.passes.legalise.settings.mixedspeeds import mixed_speeds
from rpl.passes.legalise.settings.movesettings import settings_at_moves
from rpl.passes.legalise.settings.ownplaces import own_places
from rpl.passes.legalise.settings.scaledspeeds import scaled_override
from rpl.passes.legalise.settings.speeds import fit_speeds
from rpl.passes.legalise.settings.strengths import strengths
from rpl.passes.legalise.settings.usualaccelerations import usual_accelerations
from rpl.passes.legalise.stages import Clause, Stage

STAGE = Stage(
    "settings",
    (
        coordinated_moves,
        strengths,
        usual_accelerations,
        fit_speeds,
        left_out_moves,
        corners,
        reduced_zones,
        accelerations_of_moves,
        corner_leads,
        own_places,
        mixed_speeds,
        corner_steps,
        explicit_to_modal,
        kept_corners,
        settings_at_moves,
        scaled_override,
        stand_first,
        waits_at_moves,
    ),
    Clause(
        system="advance base blend_distance blend_joint blend_rotation blend_speed circle_orientation "
        "coordinated deceleration_percent external_speed interpolation joint_acceleration joint_speed "
        "load orientation_mode path_acceleration path_configuration_check path_speed "
        "swivel_acceleration swivel_speed tool twist_acceleration twist_speed",
    ),
)
