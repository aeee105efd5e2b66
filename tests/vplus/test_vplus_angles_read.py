"""Angles read of a place: of two that turn about one axis, one is nothing and the other has all of the turn."""

from __future__ import annotations

import pytest
from vplus_helpers import outputs, run

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

# A, B, C of a frame in KRL, and what is read of its product with a turn that leaves the noise of a calculation.
READ = [
    ((30, 90, 0), (30, 90, 0)),
    ((30, -90, 0), (30, -90, 0)),
    ((70, 90, 40), (30, 90, 0)),
    ((70, -90, 40), (110, -90, 0)),
    ((-120, 35, 50), (-120, 35, 50)),
]


@pytest.mark.parametrize(("given", "wanted"), READ)
def test_angles_of_a_written_program(given: tuple[int, ...], wanted: tuple[int, ...]) -> None:
    a, b, c = given
    checks = "\n".join(
        f"IF ABS(f.{axis}-({value}))<0.01 THEN\n$OUT[{n}]=TRUE\nENDIF"
        for n, (axis, value) in enumerate(zip("ABC", wanted, strict=True), 1)
    )
    text = (
        "DEF m( )\nDECL FRAME f,g,h\nDECL REAL u\n"
        f"u=17\ng={{X 500,Y 70,Z 300,A 17,B 0,C 0}}\nh={{X 3,Y 1,Z 7,A {a},B {b},C {c}}}\n"
        f"g.A=u\nf=g:h\nf=INV_POS(g):f\n{checks}\nEND\n"
    )
    read = read_sources([source_from_text("m.src", text)], "krl", Diagnostics())
    files = translate_program(read, "vplus", None, None, Diagnostics()).files
    shown = files[0].data.decode()
    assert "CALL rpl.angle(" in shown
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "vplus", Diagnostics())
    for program in (read.program, back.program):
        result = run_program(program, None)
        assert [value for _, _, value in result.outputs] == [True] * 3, (result.outputs, shown)


ZYZ = [((0, 0, 30), (0, 0, 30)), ((20, 0, 30), (0, 0, 50)), ((20, 180, 30), (0, 180, 10)), ((20, 90, 30), (20, 90, 30))]


@pytest.mark.parametrize(("given", "wanted"), ZYZ)
def test_a_location_taken_apart(given: tuple[int, ...], wanted: tuple[int, ...]) -> None:
    """Yaw is nothing where the pitch is 0 or 180, as the controller shows it, also behind a calculation."""
    y, p, r = given
    checks = "\n".join(
        f"IF ABS(v[{n + 2}]-({value})) < 0.01 THEN\nSIGNAL {n}\nEND" for n, value in enumerate(wanted, 1)
    )
    steps = (
        f"u = 17\nSET g = TRANS(500,70,300,u,0,0)\nSET f = INVERSE(g):(g:TRANS(3,1,7,{y},{p},{r}))\n"
        f"DECOMPOSE v[0] = f\n{checks}"
    )
    assert [value for _, value in outputs(run(steps))] == [True] * 3
