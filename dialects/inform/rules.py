"""What the controller does, as data. `M` marks what rests on memory and has its own test."""

from __future__ import annotations

from rpl.ir.analog import AnalogPorts, AnalogRange
from rpl.ir.rules import AdvanceRules, InputRules, Range, Rules

from . import tables

_EXTERNAL = {f"e{n}": f"e{n}" for n in range(1, 7)}
_POSE = {**{name: name for name in ("x", "y", "z", "a", "b", "c")}, "rx": "c", "ry": "b", "rz": "a"}

COMPONENTS = {
    "PoseType": _POSE,
    "TargetType": {**_POSE, **_EXTERNAL, **{name: name for name in tables.POSTURE}},
    "JointsType": {**{name: f"j{n}" for n, name in enumerate("slurbt", 1)}, **_EXTERNAL},
}

# AOUT takes volts, and a whole-number variable 0.01 V (tables.VOLTS_PER_COUNT), which the reader turns into volts.
# M: an input counts in volts too.
_VOLTS = AnalogRange((0.0, 1.0), (0.0, 1.0))
ANALOG = (AnalogPorts("analog_in", _VOLTS), AnalogPorts("analog_out", _VOLTS))

# M: a value beyond is an alarm wherever it is stored.
_HELD = {f"{local}{bank}": Range(*held) for bank, held in tables.WIDTHS.items() for local in ("", "L")}

# M: where the pendant shows what the controller keeps.
_KEPT_AT = {
    "B": "VARIABLE, BYTE",
    "I": "VARIABLE, INTEGER",
    "D": "VARIABLE, DOUBLE",
    "R": "VARIABLE, REAL",
    "S": "VARIABLE, STRING",
    "P": "VARIABLE, POSITION (ROBOT)",
    "TL": "ROBOT, TOOL",
    "UF": "ROBOT, USER COORDINATE",
}

RULES = Rules(
    name="inform",
    first_signal=1,  # OT#(1), IN#(1), OG#(1), AO#(1)
    kept_at=_KEPT_AT,
    settings_data=frozenset((tables.SHIFT, tables.SHIFT_IN_TOOL, tables.WAIT_LATE)),  # of SFTON, and of WAIT .. T=
    case_sensitive=True,  # M: jobs and labels are kept as they are written; controllers use capitals
    # Instructions behind a move wait until the robot has come to its point, within its positioning level.
    advance=AdvanceRules(
        moves=5,
        runs_ahead_of="fly_by",
        lead_s=0.0,
        source="M: not published; 5 to 7 moves by a parameter; NWAIT runs what follows with the move",
    ),
    real_to_int="trunc",  # M: the decimals are dropped
    # R variables are single, D variables have 32 bits and an overflow is an alarm. M: each operation rounds.
    real_bits=24,
    whole_bits=32,
    components=COMPONENTS,
    undefined=False,
    call_depth=100,  # M: a controller allows about 12 nested calls; JUMP JOB does not count there, but does here
    system_defaults={
        # M: speeds of a move without one, before SPEED
        "joint_speed": 10.0,
        "path_speed": 100.0,
        "swivel_speed": 180.0,
        "twist_speed": 180.0,
        "deceleration_percent": 100.0,  # M: DEC is given apart from ACC; without it a move slows down as it can
        "path_limit_rule": "reduce",
    },
    # Operator's manuals: VJ is 0.01 to 100 percent.
    # M: VJ and EV end at 100 %.
    inputs=InputRules(
        ranges={"joint_speed": Range(most=100.0), "external_speed": Range(most=100.0)}, variable_ranges=_HELD
    ),
    blend_levels=tables.LEVELS,
    # MOVS is the parabola through three points; where two of them overlap "a composite path" is made (operator's
    # manuals). M: the composite is their mean, weighted evenly along the way from one to the other.
    mean_parabolas=True,
    analog=ANALOG,
)
