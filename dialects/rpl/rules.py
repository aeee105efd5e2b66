"""How a program in RPL itself behaves; a module `USING` another language keeps that language's rules.

The choices are the ones that surprise least. Conversions are written down, a variable without a value is an error,
`AND` and `OR` evaluate both sides (`AND THEN`, `OR ELSE` do not). A move without a blend has ended before the next
statement begins; behind a move with a blend the program goes on when the robot reaches the corner.
"""

from __future__ import annotations

from rpl.ir.analog import AnalogPorts, AnalogRange
from rpl.ir.rules import AdvanceRules, InputRules, Range, Rules
from rpl.ir.words import NATIVE

# Names that a handler or a WAIT ... ERROR may use. The numbers lie above those that programs raise themselves.
_ERROR_NAMES = (
    "timeout",
    "dialog_timeout",
    "division_by_zero",
    "out_of_range",
    "not_present",
    "unknown_routine",
    "unknown_data",
    "negative_argument",
    "overflow",
    "text_too_long",
    "search_missed",
    "search_already",
    "unreachable",
    "not_whole",
    "already_connected",
    "unknown_interrupt",
    "path_not_stored",
    "bad_raise",
)
_FIRST_ERROR = 1001

# docs/rpl.md: an analogue signal is a voltage in V.
_VOLTS = AnalogRange((0.0, 1.0), (0.0, 1.0))
ANALOG = (AnalogPorts("analog_in", _VOLTS), AnalogPorts("analog_out", _VOLTS))

RULES = Rules(
    name=NATIVE,
    advance=AdvanceRules(
        moves=1,
        runs_ahead_of="fly_by",
        stop_statements=frozenset(("Halt",)),
        source="docs/rpl.md: a move with a blend lets the program go on where the corner begins",
    ),
    inputs=InputRules(ranges={"joint_speed": Range(most=100.0), "override": Range(0.0, 100.0, above=True)}),
    analog=ANALOG,
    undefined=True,
    last_tool=False,
    system_defaults={
        "path_speed": 250.0,
        "path_acceleration": 2000.0,
        "swivel_speed": 90.0,
        "twist_speed": 90.0,
        "swivel_acceleration": 360.0,
        "twist_acceleration": 360.0,
        "joint_speed": 100.0,
        "joint_acceleration": 100.0,
        "external_speed": 100.0,
        "external_acceleration": 100.0,
        "blend_distance": 0.0,
        "blend_rotation": 0.0,
        "blend_speed": 0.0,
        "blend_joint": 0.0,
        "override": 100.0,
        "orientation_mode": "variable",
        "circle_orientation": "base",
        "held_work": False,
    },
    errors={name: _FIRST_ERROR + position for position, name in enumerate(_ERROR_NAMES)},
)
