"""How a program in RPL itself behaves; a module `USING` another language keeps that language's rules.

The choices are the ones that surprise least. Conversions are written down, a variable without a value is an error,
`AND` and `OR` evaluate both sides (`AND THEN`, `OR ELSE` do not). A move without a blend has ended before the next
statement begins; behind a move with a blend the program goes on when the robot reaches the corner.
"""

from __future__ import annotations

from rpl.ir.rules import AdvanceRules, Rules
from rpl.ir.words import NATIVE

RULES = Rules(
    name=NATIVE,
    advance=AdvanceRules(moves=1, runs_ahead_of="fly_by", stop_statements=frozenset(("Halt",))),
    undefined=True,
    system_defaults={
        "path_speed": 250.0,
        "path_acceleration": 2000.0,
        "swivel_speed": 90.0,
        "twist_speed": 90.0,
        "swivel_acceleration": 360.0,
        "twist_acceleration": 360.0,
        "blend_distance": 0.0,
        "blend_rotation": 0.0,
        "override": 100.0,
        "speed_percent": 100.0,
        "acceleration_percent": 100.0,
        "orientation_mode": "variable",
        "circle_orientation": "base",
        "held_work": False,
    },
    errors={"timeout": 1, "division_by_zero": 2, "out_of_range": 3, "unreachable": 4},
)
