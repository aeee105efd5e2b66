"""What KRL's controller does, as data. `M` marks what rests on memory and has its own test."""

from __future__ import annotations

from rpl.ir.analog import AnalogPorts, AnalogRange
from rpl.ir.rules import AdvanceRules, InputRules, LoadVariables, PassingRules, Range, Rules, TriggerRules

from . import tables

_XYZABC = {name: name for name in ("x", "y", "z", "a", "b", "c")}
_EXTERNAL = {f"e{n}": f"e{n}" for n in range(1, 7)}

COMPONENTS = {
    "PoseType": _XYZABC,
    "TargetType": {**_XYZABC, **_EXTERNAL, "s": "s", "t": "t"},
    "JointsType": {**{f"a{n}": f"j{n}" for n in range(1, 7)}, **_EXTERNAL},
}

# Statements before which the advance run stops (expert programming, table of automatic stops); signals and actual
# positions stop it wherever they are read or written.
STOPS = frozenset(("Wait", "WaitUntil", "WaitForMotion", "Halt", "Pulse", "Message", "Dialog", "ResumeLevel"))

# Expert programming KSS 5.2, 8.1 (DISTANCE and DELAY, figures 45 to 48) and 8.2 (PATH, figure 49, special cases).
TRIGGERS = TriggerRules(
    measured="path",
    start_behind_corner=True,
    delays_within_move=True,
    passes_points=True,
    end_at_joint_corner=True,
    on_paths_only=True,
)

# $LOAD is the load at the flange; the inline forms and BAS take it from LOAD_DATA with the number of the tool.
LOADS = LoadVariables(
    "$LOAD", "LOAD_DATA", "$ACT_TOOL", {"mass": "m", "frame": "cm", "ix": "j.x", "iy": "j.y", "iz": "j.z"}
)

# Expert programming 3.5.2 (at most half of the shorter block); 3.1.4: $TOOL and $BASE have no valid value until they
# are set, and moves to poses need both. M: the emulator takes them as zero.
INPUTS = InputRules(
    large_corner="begins it {half:g} mm before the point, at half of that",
    without_tool="after power-on $TOOL is not valid and the controller refuses the move (here it counts as zero)",
    # M: KSS refuses a value beyond 100 percent; with $OV_PRO=0 it is in order and the robot stands.
    ranges={
        "joint_speed": Range(most=100.0),
        "override": Range(
            0.0, 100.0, at_least="the robot stands until it is raised (here it drives at a thousandth of the speed)"
        ),
    },
)

# robot-forum.com thread 44124: $ANIN and $ANOUT are -1 to 1 for -100 % to 100 % of the module's range, 1 is 10 V there.
_SHARE = AnalogRange((0.0, 1.0), (0.0, 10.0), usual=True)
ANALOG = (AnalogPorts("analog_in", _SHARE), AnalogPorts("analog_out", _SHARE))

RULES = Rules(
    name="krl",
    first_signal=1,  # $IN[1]..$IN[4096], $OUT, $FLAG, $ANOUT alike
    advance=AdvanceRules(
        moves=3,
        runs_ahead_of="all",
        stop_statements=STOPS,
        signals_stop=True,
        most=5,
        source="KUKA Expert Programming KSS 5.2, 3.4: $ADVANCE is 0 in the system, 3 by BAS(#INITMOV,0), 5 at most",
    ),
    real_to_int="round_half_away",
    # RG 2.1.3.1: REAL up to 3.4E+38 (four bytes), INT of 32 bits. M: KSS rounds each operation, and stops at a result
    # that is too large for an INT.
    real_bits=24,
    whole_bits=32,
    char_numbers=True,
    components=COMPONENTS,
    undefined=True,
    # KUKA's own MsgLib finds out so whether a variable was initialised; which numbers errors have is not published.
    passing=PassingRules("on_error_proceed", "err_clear", "$ERR", "number"),
    unset_length=True,  # MsgLib of KSS 8 asks so for the length of a text that its caller has left out
    by_file=True,  # expert programming manual: the first DEF is the program, those behind it are its subprograms
    call_depth=20,  # M: about 20 levels, interrupts included
    # The state after power-on, before BAS(#INITMOV,0) has run: no look-ahead, tool and base not valid (identity here).
    system_defaults={
        "advance": 0,
        "override": 100.0,
        "path_speed": 3000.0,
        "path_acceleration": 5000.0,
        "swivel_speed": 400.0,
        "twist_speed": 400.0,
        "swivel_acceleration": 1000.0,
        "twist_acceleration": 1000.0,
        "joint_speed": 100.0,
        "joint_acceleration": 100.0,
        "external_speed": 100.0,
        "external_acceleration": 100.0,
        "blend_distance": 0.0,
        "blend_rotation": 0.0,
        "blend_speed": 0.0,
        "blend_joint": 0.0,
        "orientation_mode": "variable",
        "circle_orientation": "path",
        "interpolation": "base",
        "path_limit_rule": "constant",
        "singular_rule": 0,
        "held_work": False,
    },
    type_names=tables.BASIC_TYPES,
    triggers=TRIGGERS,
    load_variables=LOADS,
    system_data=frozenset(("$config",)),
    analog=ANALOG,
    inputs=INPUTS,
    pulse_step_s=0.1,  # expert programming, 5.4: rounded to the nearest tenth of a second
)
