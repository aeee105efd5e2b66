"""What FANUC's controller does silently, as data. `M` marks what rests on memory and has its own test."""

from __future__ import annotations

from rpl.ir.rules import AdvanceRules, InputRules, Range, Rules

from . import tables

_XYZ = {name: name for name in ("x", "y", "z", "a", "b", "c")}
_WPR = {"w": "c", "p": "b", "r": "a"}
_EXTERNAL = {f"e{n}": f"e{n}" for n in range(1, 7)}
_FLAGS = {name: name for name in ("flip", "down", "back", "t1", "t4", "t6")}

COMPONENTS = {
    "PoseType": {**_XYZ, **_WPR},
    "TargetType": {**_XYZ, **_WPR, **_EXTERNAL, **_FLAGS},
    "JointsType": {**{f"j{n}": f"j{n}" for n in range(1, 7)}, **_EXTERNAL},
}

# M: corners of a given size (CR, CD) take at most half of the shorter move beside them; the option's manual is not at
# hand. CNT has no size of its own.
# M (the operator's manual is not at hand): J and CNT end at 100 percent, OVERRIDE goes from 1 to 100, a move with a
# time needs more than none, and numbers of frames go up to what the controller has.
_INPUTS = InputRules(
    large_corner="makes it {half:g} mm, half of that",
    ranges={
        "joint_speed": Range(most=100.0),
        "override": Range(1.0, 100.0),
        "move_duration": Range(0.0, above=True),
    },
    variable_ranges={f"{bank}_NUM": Range(0.0, float(most)) for bank, most in tables.FRAMES.items()},
)

# M: where the pendant shows what the controller keeps.
_KEPT_AT = {
    "R": "DATA, Registers",
    "SR": "DATA, String Registers",
    "PR": "DATA, Position Registers",
    "UFRAME": "SETUP, Frames, User",
    "UTOOL": "SETUP, Frames, Tool",
}

RULES = Rules(
    name="tp",
    first_signal=1,  # DO[1], F[1], AO[1]
    kept_at=_KEPT_AT,
    settings_data=frozenset((*tables.FRAMES, *(f"{bank}_NUM" for bank in tables.FRAMES), "$WAITTMOUT")),
    inputs=_INPUTS,
    # Behind FINE the program goes on when the robot is in position, behind CNT as soon as the move slows down (M: at
    # the beginning of the corner).
    advance=AdvanceRules(
        moves=4,
        runs_ahead_of="fly_by",
        lead_s=0.0,
        source="M: not published; logic behind CNT runs where the next move takes over",
    ),
    real_to_int="trunc",  # M: a register written to a group output or used as a number is cut
    text_plus=True,
    # KAREL reference: REAL has four bytes, INTEGER 32 bits; M: a register holds either, each operation is rounded.
    real_bits=24,
    leading_numbers=True,  # M: a text that goes on behind its number gives the number, one without gives 0
    components=COMPONENTS,
    undefined=True,
    whole_targets=True,  # a position that was not taught is a fault when it is used
    call_depth=100,
    group_bits=16,  # M: a group has two to sixteen signals, which the controller's configuration says
    message_numbers=r"R\d+",  # MESSAGE shows constant text only: how a message names the register of a value
    message_texts=r"(?:SR|F|PR)\d+",
    system_defaults={
        "override": 100.0,
        "path_speed": 250.0,
        "joint_speed": 100.0,
        "joint_acceleration": 100.0,
        "swivel_speed": 190.0,  # $ROTSPEEDLIM of R-2000iB controller files, deg/s
        "twist_speed": 190.0,
        "orientation_mode": "variable",
        "circle_orientation": "path",
        "path_limit_rule": "reduce",
        "joint_configuration_check": True,
        "path_configuration_check": False,  # M: linear moves keep the posture they start with
    },
)
