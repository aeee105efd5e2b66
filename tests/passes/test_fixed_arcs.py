"""Arcs on which the tool stays as it is to the arc: languages without them get the end orientation worked out."""

from __future__ import annotations

import math
import operator

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.legalise.source.ways.arcsplit import is_short, split_points
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

OPERATIONS = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    ">": operator.gt,
}
PROGRAM = """def main():
  movej([0, -1.8, -1.9, -1.0, 1.57, 0.8], a=1.4, v=1.05)
  movel(pose_trans(get_actual_tcp_pose(), p[0, 0, 0.02, 0, 0, 0]), v=0.1{blend})
  here = get_actual_tcp_pose()
  movec(pose_trans(here, p[{via}]), pose_trans(here, p[{end}, 0, 0, 0.3]), a=0.8, v=0.1, r=0, mode=1)
  movel(pose_trans(get_actual_tcp_pose(), p[0.02, 0, 0, 0, 0, 0]), v=0.1)
end
"""
ARCS = [
    ("0.03, 0.03, 0, 0, 0, 0", "0.06, 0, 0"),
    ("0.01, 0.03, 0.01, 0, 0, 0", "0.02, 0.04, 0.03"),
    ("0.04, 0.04, 0, 0, 0, 0", "0.01, 0.03, 0"),
]
ROUNDS = [  # end and point on the way: a third, half and three quarters of a circle; the last by a crest
    ("0.0134, 0.0234, 0, 0, 0, 0", "0.0434, 0.0268, 0"),
    ("0.03, 0.03, 0, 0, 0, 0", "0.06, 0, 0"),
    ("0.06, 0, 0, 0, 0, 0", "0.03, -0.03, 0"),
    ("0.03, 0, -0.03, 0, 0, 0", "0.06, 0, 0"),
]


def _translated(text: str, target: str) -> tuple[object, object, Diagnostics]:
    read = read_sources([source_from_text("p.script", text)], "urscript", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, "ur5e", None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = prove_programs(read.program, back.program, "ur5e", entry="main", to_entry=entry_name(back.program))
    return result.agrees, result.as_text(), diagnostics


CASES = [
    *((target, via, end) for target in ("tp", "vplus") for via, end in ARCS),
    *((target, via, end) for target in ("inform", "krl") for via, end in (*ARCS, *ROUNDS)),
    ("rapid", "0.03, 0.005, 0, 0, 0, 0", "0.06, 0, 0"),  # further round, the quadrant that CRobT tells no longer holds
]


@pytest.mark.parametrize(("target", "via", "end"), CASES)
def test_the_tool_turns_with_the_arc(target: str, via: str, end: str) -> None:
    equal, text, diagnostics = _translated(PROGRAM.format(blend="", via=via, end=end), target)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert equal, text


def test_a_start_that_is_passed_is_named() -> None:
    via, end = ARCS[0]
    text = PROGRAM.format(blend=", r=0.01", via=via, end=end)
    _, _, diagnostics = _translated(text, "tp")
    assert "constant-orientation-lost" in {item.code.name for item in diagnostics}


def test_the_shortest_way_is_named_and_halved() -> None:
    via, end = ARCS[0]
    _, _, diagnostics = _translated(PROGRAM.format(blend="", via=via, end=end), "inform")
    assert "arc-in-halves" in {item.code.name for item in diagnostics}


@pytest.mark.parametrize("degrees", [(10.0, 40.0), (20.0, 200.0), (170.0, 180.0), (100.0, 355.0)])
def test_the_points_of_the_halves(degrees: tuple[float, float]) -> None:
    """The program's own steps, worked out: all three points are on the circle, in order, the middle in the middle."""
    places = {"start": 0.0, "via": degrees[0], "end": degrees[1]}
    values: dict[str, float] = {}
    for name, at in places.items():
        turn = math.radians(at)
        values |= {f"{name}.x": 3 + 50 * math.cos(turn), f"{name}.y": 50 * math.sin(turn), f"{name}.z": 7.0}
    measured, points = split_points(("start", "via", "end"), ("before", "middle", "behind"), ("a", "b", "c", "s"))
    _work_out(measured, values)
    assert bool(_value(is_short(("a", "b", "c", "s")), values)) == (degrees[1] < 168.0)
    _work_out(points, values)
    at = [
        math.degrees(math.atan2(values[f"{name}.y"], values[f"{name}.x"] - 3)) % 360.0
        for name in ("before", "middle", "behind")
    ]
    radii = [math.hypot(values[f"{name}.x"] - 3, values[f"{name}.y"]) for name in ("before", "middle", "behind")]
    assert radii == pytest.approx([50.0] * 3)
    assert at[1] == pytest.approx(degrees[1] / 2.0)
    assert 0.0 < at[0] < at[1] < at[2] < degrees[1]


def _work_out(body: ir.Body, values: dict[str, float]) -> None:
    for one in body:
        assert isinstance(one, ir.Assign)
        values[_key(one.target)] = _value(one.value, values)


def _key(place: ir.Expression) -> str:
    if isinstance(place, ir.Field):
        return f"{_key(place.base)}.{place.name}"
    assert isinstance(place, ir.Name)
    return place.id


def _value(value: ir.Expression, values: dict[str, float]) -> float:
    match value:
        case ir.RealLiteral(value=number):
            return number
        case ir.Binary(op=op, left=left, right=right):
            return float(OPERATIONS[op](_value(left, values), _value(right, values)))
        case ir.Builtin(function="distance", arguments=(ir.Field(base=one), ir.Field(base=other))):
            ends = ([values[f"{_key(place)}.{axis}"] for axis in "xyz"] for place in (one, other))
            return math.dist(*ends)
    return values[_key(value)]
