"""Corners measured in percent or by speed, as targets with zones or modal blends measure them."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.settings.corners.corners import corners

TEN, FIFTY = ir.RealLiteral(10.0), ir.RealLiteral(50.0)
HUNDRED_MM_S = ir.Speed(path=ir.Quantity(ir.RealLiteral(100.0), "mm/s"))


@dataclass(frozen=True)
class Case:
    kind: str
    blend: ir.Blend
    krl: ir.Blend
    rapid: ir.Blend


CASES = {
    "percent of a joint move": Case(
        "joint", ir.BlendPercent(FIFTY), ir.BlendPercent(FIFTY), ir.BlendDistance(ir.RealLiteral(200.0))
    ),
    "percent with its distance": Case(
        "linear",
        ir.BlendPercent(FIFTY, ir.BlendDistance(TEN)),
        ir.BlendDistance(TEN),
        ir.BlendDistance(TEN),
    ),
    "no percent": Case("linear", ir.BlendPercent(ir.RealLiteral(0.0)), ir.BlendStop(), ir.BlendStop()),
    "percent of a path move": Case(
        "linear",
        ir.BlendPercent(FIFTY),
        ir.BlendDistance(ir.RealLiteral(200.0)),
        ir.BlendDistance(ir.RealLiteral(200.0)),
    ),
    "where the braking begins": Case(
        "linear",
        ir.BlendSpeed(ir.IntLiteral(100)),
        ir.BlendSpeed(ir.IntLiteral(100)),
        ir.BlendDistance(ir.RealLiteral(1.0)),  # 100^2 / (2 * 5000)
    ),
    "where the braking of a joint move begins": Case(
        "joint",
        ir.BlendSpeed(ir.IntLiteral(100)),
        ir.BlendPercent(ir.RealLiteral(20.0)),
        ir.BlendDistance(ir.RealLiteral(80.0)),
    ),
    "a modal size": Case(
        "linear",
        ir.BlendSpeed(ir.System("blend_speed")),
        ir.BlendSpeed(ir.System("blend_speed")),
        ir.BlendSpeed(ir.System("blend_speed")),
    ),
}


@pytest.mark.parametrize("target", ["krl", "rapid"])
@pytest.mark.parametrize("name", CASES)
def test_corner(name: str, target: str) -> None:
    case = CASES[name]
    move = ir.Move(case.kind, ir.Name("p"), blend=case.blend, speed=HUNDRED_MM_S)
    program = ir.Program((ir.Module("m", "vplus", (), (ir.Routine("main", body=(move,)),)),))
    context = Context("vplus", target, registry.target(target).capabilities(), Diagnostics())
    (done,) = [node for node in walk(corners(program, context)) if isinstance(node, ir.Move)]
    assert done.blend == getattr(case, target)
