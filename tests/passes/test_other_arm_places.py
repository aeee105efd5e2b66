"""Places without flags on another arm: one that it does not reach is an error, one that only the run knows is told."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

URSCRIPT = """def p():
  global spot = p[{x}, -0.3, 0.3, 0, 3.14159, 0]
  global place = spot
  place[2] = place[2] + get_analog_in(0)
  movel({goal})
end
"""
VPLUS = """.PROGRAM p()
SET place = SHIFT(spot BY 0,0,AIO.IN(1))
MOVES {goal}
.END
.LOCATIONS
spot {x} 0 300 0 180 0
.END
"""


def told(text: str, name: str, dialect: str, robot: str, other: str, target: str = "rapid") -> dict[str, int]:
    """Codes and the line of each that speaks of places on the other arm."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(name, text)], dialect, diagnostics)
    translate_program(read, target, robot, other, diagnostics)
    names = ("unreachable-on-target-arm", "place-not-looked-at")
    return {item.code.name: item.origin.line for item in diagnostics if item.code.name in names}


@pytest.mark.parametrize(
    ("goal", "x", "found"),
    [
        ("spot", 1.0, {"unreachable-on-target-arm": 5}),
        ("spot", 0.4, {}),
        ("pose_trans(spot, p[0, 0, 0.1, 0, 0, 0])", 0.4, {}),
        ("pose_trans(spot, p[-0.9, 0, 0.1, 0, 0, 0])", 0.4, {"unreachable-on-target-arm": 5}),
        ("place", 0.4, {"place-not-looked-at": 5}),
    ],
)
def test_places_of_urscript(goal: str, x: float, found: dict[str, int]) -> None:
    text = URSCRIPT.format(goal=goal, x=x)
    assert told(text, "p.script", "urscript", "ur10e", "abb_irb1200_5_90") == found
    assert told(text, "p.script", "urscript", "ur10e", "ur10e") == {}


def test_a_smaller_arm_of_the_same_controller() -> None:
    text = URSCRIPT.format(goal="spot", x=1.0)
    assert told(text, "p.script", "urscript", "ur10e", "ur5e", "urscript") == {"unreachable-on-target-arm": 5}


@pytest.mark.parametrize(
    ("goal", "x", "found"),
    [
        ("spot", 850, {"unreachable-on-target-arm": 3}),
        ("spot", 350, {}),
        ("spot:TRANS(0,0,-20)", 350, {}),
        ("place", 350, {"place-not-looked-at": 3}),
    ],
)
def test_places_of_vplus(goal: str, x: int, found: dict[str, int]) -> None:
    text = VPLUS.format(goal=goal, x=x)
    assert told(text, "p.v2", "vplus", "adept_viper_s850", "fanuc_lrmate200id") == found
