"""What a Universal Robots controller does, as data. `M` marks what rests on memory and has its own test.

Further facts of this kind stand where they are used and are tested in tests/urscript/test_urscript_facts.py:
M: precedence from high to low is ^, signs, * / %, + -, comparisons, not, and, xor, or (grammars/urscript.lark).
M: `and` and `or` do not look at their right side when the left one decides; `/` is real division (expressions.py).
M: pose_sub is what pose_add undoes: pose_add(b, pose_sub(a, b)) is a, so its rotation is R_b^-1 R_a (calls.py).
M: `list * list` is element by element; a matrix times a list is the product (infer.py).
"""

from __future__ import annotations

from typing import Final

from rpl.ir.analog import AnalogPorts, AnalogRange
from rpl.ir.rules import AdvanceRules, InputRules, Rules
from rpl.registry import words

# A move without blend has ended before the next statement begins; behind one with a blend the program goes on when the
# robot enters the blend (M: it does not matter to the path what the program does then).
_ADVANCE = AdvanceRules(
    moves=1,
    runs_ahead_of="fly_by",
    stop_statements=frozenset(("Halt",)),
    source="URScript Manual 5.2, movel: a move blocks; with a blend radius up to where the blend begins",
)

_WORDS: Final = words("urscript")
_DIGITAL, _ANALOG = (
    {name: int(number) for name, number in _WORDS.numbers(f"first_{kind}").items()} for kind in ("digital", "analog")
)

STEP_TIME_S: Final = float(_WORDS.numbers("numbers")["step_s"])  # one cycle of the controller

# M: the distance of two poses counts the angle between them (rad) like a length (m): the length of the six numbers of
# pose_sub.
POSE_DIST_COUNTS_ANGLE: Final = True

# First neutral number of the general purpose registers that are signals like others.
FIRST_REGISTER: Final = {"boolean_register": _DIGITAL["boolean"], "float_register": _ANALOG["float"]}

# First neutral number of each kind of signal by the function that names it.
FIRST_SIGNAL: Final = {
    **{f"{where}_digital": _DIGITAL[where] for where in ("standard", "configurable", "tool")},
    "digital": _DIGITAL["standard"],
    **{f"{where}_analog": _ANALOG[where] for where in ("standard", "tool")},
    "analog": _ANALOG["standard"],
}
# M: the old functions without a word for the kind count on: 8 and 9 are the tool's (16 and 17 on some versions).
LEGACY_DIGITAL: Final = {8: 17, 9: 18, 16: 17, 17: 18}
LEGACY_ANALOG: Final = {2: 3, 3: 4}

# Script manual: set_standard_analog_out takes 0 to 1, a share of the range; get_standard_analog_in and
# get_tool_analog_in give volts or amperes. Which of both the program can say (levels.py), else the installation does:
# volts as a rule. Registers behind them have no unit.
_SHARE = AnalogRange((0.0, 1.0), (0.0, 10.0), usual=True)
_VOLTS = AnalogRange((0.0, 1.0), (0.0, 1.0), usual=True)
ANALOG = (AnalogPorts("analog_out", _SHARE, 1, 2), AnalogPorts("analog_in", _VOLTS, 1, 4))

# Script manual, movej: a move whose blend overlaps with that of a waypoint beside it is skipped.
_INPUTS = InputRules(
    overlapping_blends="Overlapping blends: this move is left out, its blend of {radius:g} mm and the one of"
    " {before:g} mm before it are longer than the {way:g} mm between them",
)

RULES = Rules(
    name="urscript",
    advance=_ADVANCE,
    inputs=_INPUTS,
    case_sensitive=True,
    text_plus=True,
    undefined=True,
    analog=ANALOG,
    array_base=0,
    group_bits=32,  # integer registers
    text_decimals=6,
    call_depth=100,
    wait_poll_s=STEP_TIME_S,
    task_instances=True,
    system_defaults={
        "path_speed": 250.0,
        "path_acceleration": 1200.0,
        "swivel_speed": 180.0,
        "twist_speed": 180.0,
        "swivel_acceleration": 720.0,
        "twist_acceleration": 720.0,
        "joint_speed": 100.0,
        "joint_acceleration": 100.0,
        "override": 100.0,
        "circle_orientation": "base",
        "held_work": False,
    },
)
