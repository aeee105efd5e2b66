"""What the V+ controller does, as data. `M` marks what rests on memory and has its own test."""

from __future__ import annotations

from rpl.ir.analog import AnalogPorts, AnalogRange
from rpl.ir.rules import AdvanceRules, Rules

from . import tables

_XYZABC = {name: name for name in ("x", "y", "z", "a", "b", "c")}

# A move starts and the program goes on at once; at the next move it waits until the present one has ended or goes over
# into it. So a step behind a move acts just after that move has begun (user's guide, forward processing). Signals and
# waits do not hold the program. A halt lets the motion end first.
ADVANCE = AdvanceRules(
    moves=1,
    runs_ahead_of="begun",
    stop_statements=frozenset(("Halt",)),
    source="V+ Language User's Guide, motion control: one motion is executed, one is waited for",
    waits_queue=True,  # M: DELAY is a move without a way: it begins when the move before has ended, the program goes on
)

# M: AIO.IN and AIO.OUT are -1 to 1 for the range of the analogue board, 10 V as delivered.
_SHARE = AnalogRange((0.0, 1.0), (0.0, 10.0), usual=True)
ANALOG = (AnalogPorts("analog_in", _SHARE), AnalogPorts("analog_out", _SHARE))

RULES = Rules(
    name="vplus",
    # Language user's guide, real and integer data types: a real has 32 bits (IEEE single, 24 bits of precision), whole
    # numbers go from -16,777,216 to 16,777,215. M: each operation rounds, and DOUBLE variables are taken as others.
    real_bits=24,
    text_length=128,  # user's guide: a string has 0 to 128 characters
    whole_bits=24,
    advance=ADVANCE,
    components={"PoseType": _XYZABC, "TargetType": _XYZABC},
    text_plus=True,
    number_marks=tables.NUMBER_MARKS,
    leading_numbers=True,  # M: VAL stops at the first sign that is no part of a number
    undefined=True,
    whole_targets=True,  # "undefined value" at a location that was never set
    wait_poll_s=tables.CYCLE_S,
    # SPEED 100,100 ALWAYS, ACCEL 100,100, continuous path: the state in which every program starts.
    system_defaults={
        "override": 100.0,
        "joint_speed": 100.0,
        "joint_acceleration": 100.0,
        "path_speed": tables.FULL_PATH_SPEED_MM_S,
        "swivel_speed": tables.FULL_ROTATION_SPEED_DEG_S,
        "twist_speed": tables.FULL_ROTATION_SPEED_DEG_S,
        "acceleration_percent": 100.0,
        "deceleration_percent": 100.0,
        # V+ Language Reference Guide, SCALE.ACCEL: on at the start; the effective acceleration and deceleration are the
        # program speed times what ACCEL says. The speed up to which this holds is "very large" as delivered.
        "scale_acceleration": True,
        "blending": True,
        "end_tolerance": 100.0,
        "circle_orientation": "path",
        "held_work": False,
    },
    # V+ Language Reference Guide, ACCEL: 1 to 100 as a rule (a robot's maker may allow more); else the nearest of both.
    percent_limits={"acceleration_percent": (1.0, 100.0), "deceleration_percent": (1.0, 100.0)},
    errors=tables.ERRORS,
    analog=ANALOG,
)
