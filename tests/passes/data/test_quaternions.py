"""Poses with angles as nested positions and quaternions."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.records.quaternions import to_quaternions
from rpl.passes.typing import normalise

from .helpers import context, lines, read, show, variable

FRAME = """DEF t()
DECL E6POS p
DECL FRAME f,g
DECL E6AXIS j
DECL REAL n
%s
END
DEF go(h:IN)
DECL FRAME h
END
====
DEFDAT t
DECL E6POS XP1={X 1,Y 2,Z 3,A 180,B 0,C 180,S 2,T 35,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}
DECL E6AXIS XHOME={A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0,E1 0}
DECL FRAME part={X 1,Y 2,Z 3,A 0,B 0,C 0}
ENDDAT
"""

CASES = {
    "p.x=p.y+1": ["p.trans.x := (p.trans.y + 1)"],
    "p.a=n": ["p.rot := rotation_zyx(n, euler_y(p.rot), euler_x(p.rot))"],
    "p.b=n\np.a=1": ["p.rot := rotation_zyx(1, n, euler_x(p.rot))"],
    "p.a=n\np.b=p.a": [
        "p.rot := rotation_zyx(n, euler_y(p.rot), euler_x(p.rot))",
        "p.rot := rotation_zyx(euler_z(p.rot), euler_z(p.rot), euler_x(p.rot))",
    ],
    "n=p.a+f.c": ["n := (euler_z(p.rot) + euler_x(f.rot))"],
    "f={FRAME: X 1,Y 2,Z n,A 0,B 0,C 0}": ["f := {trans {x 1, y 2, z n}, rot {q1 1.0, q2 0.0, q3 0.0, q4 0.0}}"],
    "f={FRAME: X 1,Y 2,Z 3,A n,B 0,C 0}": ["f := {trans {x 1, y 2, z 3}, rot rotation_zyx(n, 0, 0)}"],
    "f=f:g": ["f := compose(f, g)"],
    "f=INV_POS(p):g": ["f := compose(inverse({trans p.trans, rot p.rot}), g)"],
    "f=p": ["f := {trans p.trans, rot p.rot}"],
    "p=f": ["p.trans := f.trans", "p.rot := f.rot"],
    "f=$NULLFRAME": ["f := {trans {x 0.0, y 0.0, z 0.0}, rot {q1 1.0, q2 0.0, q3 0.0, q4 0.0}}"],
    "p=f:XP1": [
        *("tmp := compose(f, {trans XP1.trans, rot XP1.rot})", "tmp2 := XP1"),
        *("tmp2.trans := tmp.trans", "tmp2.rot := tmp.rot", "p := tmp2"),
    ],
    "n=$POS_ACT.x": ["tmp := current_target()", "n := tmp.trans.x"],
    "j.a3=$AXIS_ACT.a1": ["tmp := current_joints()", "j.robax.j3 := tmp.robax.j1"],
    "go(p)": ["go({trans p.trans, rot p.rot})"],
    "PTP XHOME": ["joint XHOME"],
    "PTP {A3 45}": ["tmp := current_joints()", "tmp.robax.j3 := 45", "joint tmp"],
    "LIN {Z 100,A 5}": [
        *("tmp := current_target()", "tmp.trans.z := 100"),
        *("tmp.rot := rotation_zyx(5, euler_y(tmp.rot), euler_x(tmp.rot))", "linear tmp"),
    ],
    "LIN part": [
        *("tmp := current_target()", "tmp.trans := part.trans", "tmp.rot := part.rot", "linear tmp"),
    ],
}


@pytest.mark.parametrize("text", CASES)
def test_statements(text: str) -> None:
    program = read(FRAME % text, "krl")
    done = to_quaternions(program, context(program, "krl"))
    assert lines(done) == CASES[text]
    found = Diagnostics()
    normalise(done, found)
    assert not found.has_errors, [item.as_text() for item in found]


def test_declarations() -> None:
    program = read(FRAME % "p=XP1", "krl")
    done = to_quaternions(program, context(program, "krl"))
    unused = ", ".join(f"e{n} 9000000000.0" for n in range(1, 7))
    turn = "rot {q1 0.0, q2 0.0, q3 1.0, q4 0.0}"
    texts = {name: show(variable(done, name).initial or ir.Name("-")) for name in ("XP1", "XHOME", "part")}
    assert texts == {
        "XP1": f"{{trans {{x 1, y 2, z 3}}, {turn}, s 2, t 35, ext {{{unused}}}}}",
        "XHOME": f"{{robax {{j1 0, j2 -90, j3 90, j4 0, j5 0, j6 0}}, ext {{{unused}}}}}",
        "part": "{trans {x 1, y 2, z 3}, rot {q1 1.0, q2 0.0, q3 0.0, q4 0.0}}",
    }


def test_an_external_axis_that_moves_is_kept() -> None:
    program = read(FRAME % "j.e2=5", "krl")
    done = to_quaternions(program, context(program, "krl"))
    assert lines(done) == ["j.ext.e2 := 5"]
    assert "e1 9000000000.0, e2 0, e3" in show(variable(done, "XP1").initial or ir.Name("-"))


def test_the_pass_is_idempotent() -> None:
    program = read(FRAME % "\n".join(CASES), "krl")
    surroundings = context(program, "krl")
    once = to_quaternions(program, surroundings)
    assert to_quaternions(once, surroundings) == once
