"""Speeds and accelerations of moves in the measures of the target."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from rpl import ir
from rpl.passes.capabilities import Capabilities
from rpl.passes.legalise.settings.speeds import fit_speeds

from .executed import EVERYTHING, context, passed, read
from .helpers import routine

ARM = SimpleNamespace(name="arm", speeds=(120.0, 120.0, 200.0))
PERCENT = EVERYTHING
AXIS = replace(
    EVERYTHING, settings=replace(EVERYTHING.settings, speeds=frozenset(("axis", "path", "axis_acceleration")))
)
ALL = replace(
    EVERYTHING,
    settings=replace(
        EVERYTHING.settings, speeds=frozenset(("axis", "joint", "path", "axis_acceleration", "path_acceleration"))
    ),
)
HOME = "{j1: 0, j2: -90, j3: 90, j4: 0, j5: 0, j6: 0}"
HALF = ir.RealLiteral(50.0)
CASES = [
    ("AXIS SPEED 100", PERCENT, ARM, ir.Speed(joint=HALF), ["axis-speed-in-percent"]),
    ("AXIS SPEED 90", PERCENT, None, ir.Speed(joint=HALF), ["axis-speed-in-percent"]),
    ("AXIS SPEED 500", PERCENT, ARM, ir.Speed(joint=ir.RealLiteral(100.0)), ["axis-speed-in-percent"]),
    ("JOINT SPEED 25", AXIS, ARM, ir.Speed(axis=HALF), ["percent-as-axis-speed"]),
    ("JOINT SPEED 25", PERCENT, ARM, ir.Speed(joint=ir.IntLiteral(25)), []),
    ("AXIS SPEED 50", ALL, ARM, ir.Speed(axis=ir.IntLiteral(50)), []),
    ("JOINT SPEED 25 AXIS ACCELERATION 80", PERCENT, ARM, ir.Speed(joint=ir.IntLiteral(25)), ["dropped-setting"]),
    ("AXIS ACCELERATION 80", PERCENT, ARM, None, ["dropped-setting"]),
]


@pytest.mark.parametrize(("written", "target", "arm", "wanted", "codes"), CASES)
def test_table(written: str, target: Capabilities, arm: object, wanted: ir.Speed | None, codes: list[str]) -> None:
    before = read(f"MODULE m\nPROCEDURE main()\nMOVE TO {HOME} {written}\nEND PROCEDURE\nEND MODULE\n")
    given = context(before, target, robot=arm)
    move = routine(passed(before, (fit_speeds,), given), "main").body[0]
    assert isinstance(move, ir.Move)
    assert move.speed == wanted
    assert [item.code.name for item in given.diagnostics] == codes
