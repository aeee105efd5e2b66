"""What the passes of settings say of them in common: which settings targets leave out, and the words of modes."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code

JOINT_BLEND = code(
    "approximated-blend", Severity.WARNING, "this blend has no exact counterpart; it is written as a zone of {size}"
)
DROPPED = code(
    "dropped-setting",
    Severity.WARNING,
    "the target has no setting for {name}; it is left out",
    several="{count} settings have no counterpart and are left out: [{name}]",
)
# The mechanism that carries the frame in force, and where it stands.
UNIT, ROOT = "base_unit", "base_root"
# Values with which a dropped setting says what the target does anyway.
USUAL = {
    "orientation_mode": "variable",
    "circle_orientation": "base",
    "path_limit_rule": "constant",
    "interpolation": "base",
}
DROPPED_SETTINGS = frozenset(
    {
        *("path_acceleration", "swivel_acceleration", "twist_acceleration", "joint_acceleration", "path_jerk"),
        *("external_speed", "external_acceleration", "blend_rotation", "blend_speed", "orientation_mode"),
        *("circle_orientation", "singular_rule", "path_limit_rule", "advance", "load", "interpolation"),
        *("end_tolerance", "deceleration_percent"),
    }
)


def says(value: ir.Expression, word: str) -> bool:
    """Is it this mode word?"""
    return isinstance(value, ir.EnumLiteral | ir.TextLiteral | ir.Name) and word == _word(value)


def _word(value: ir.EnumLiteral | ir.TextLiteral | ir.Name) -> str:
    match value:
        case ir.EnumLiteral(member=word) | ir.TextLiteral(value=word) | ir.Name(id=word):
            return word.lower()
