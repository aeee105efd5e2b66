"""Vectors, quaternions and nested targets as poses with angles."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.records.angles import to_angles
from rpl.passes.typing import normalise

from .helpers import context, lines, read, routine, show, variable

FRAME = """MODULE t
  CONST robtarget p1:=[[1,2,3],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST num size:=7;
  PERS tooldata grip:=[TRUE,[[0,0,120],[1,0,0,0]],[1.2,[0,0,60],[1,0,0,0],0,0,0]];
  CONST jointtarget home:=[[0,0,0,0,30,0],[9E9,5,9E9,9E9,9E9,9E9]];
  VAR pos v1:=[1,2,3];
  VAR pos corners{2}:=[[1,2,3],[4,5,6]];
  FUNC pos where(num k)
    RETURN [k,size,3];
  ENDFUNC
  PROC t()
    VAR robtarget p;
    VAR pose f;
    VAR pos v;
    VAR orient o;
    VAR num n;
    VAR jointtarget j;
    VAR tooldata tl;
%s
  ENDPROC
ENDMODULE
"""

CASES = {
    "p:=p1;": ["p := p1"],
    "p.trans.x:=p1.trans.y+1;": ["p.x := (p1.y + 1)"],
    "p.trans:=v;": ["p.x := v.x", "p.y := v.y", "p.z := v.z"],
    "v:=p.trans;": ["v.x := p.x", "v.y := p.y", "v.z := p.z"],
    "v:=[1,2,size];": ["v := {x 1, y 2, z 7.0, a 0.0, b 0.0, c 0.0}"],
    "v:=v+v1*2;": [f"v.{n} := (v.{n} + (v1.{n} * 2))" for n in "xyz"],
    "v:=[v.y,v.x,n];": [
        *("tmp := v.y", "tmp2 := v.x", "tmp3 := n"),
        *("v.x := tmp", "v.y := tmp2", "v.z := tmp3"),
    ],
    "v:=corners{1};": [f"v.{n} := corners[1].{n}" for n in "xyz"],
    "o:=OrientZYX(10,20,30);": ["o := {x 0.0, y 0.0, z 0.0, a 10.0, b 20.0, c 30.0}"],
    "o:=[0.5,0.5,0.5,0.5];": ["o := {x 0.0, y 0.0, z 0.0, a 90.0, b 0.0, c 90.0}"],
    "p.rot:=OrientZYX(n,0,180);": ["p.a := n", "p.b := 0", "p.c := 180"],
    "p.rot:=p.rot*o;": [
        "tmp := (rpl_frame(0.0, 0.0, 0.0, p.a, p.b, p.c) : o)",
        *("p.a := tmp.a", "p.b := tmp.b", "p.c := tmp.c"),
    ],
    r"n:=EulerZYX(\Z,p.rot);": ["n := p.a"],
    r"n:=EulerZYX(\X,o);": ["n := o.c"],
    "n:=Distance(p.trans,v);": ["n := rpl_length((p.x - v.x), (p.y - v.y), (p.z - v.z))"],
    "n:=VectMagn(v);": ["n := rpl_length(v.x, v.y, v.z)"],
    "n:=DotProd(v,v1);": ["n := (((v.x * v1.x) + (v.y * v1.y)) + (v.z * v1.z))"],
    "n:=p.rot.q1;": ["n := rpl_quaternion(1, p.a, p.b, p.c)"],
    "f:=[v,o];": [*(f"f.{n} := v.{n}" for n in "xyz"), *(f"f.{n} := o.{n}" for n in "abc")],
    "f:=[[1,2,3],[1,0,0,0]];": ["f := {x 1, y 2, z 3, a 0.0, b 0.0, c 0.0}"],
    "f:=PoseMult(PoseInv(f),f);": ["f := (inverse(f) : f)"],
    "v:=PoseVect(f,[0,0,n]);": [
        "tmp := rpl_transform(f, 0, 0, n)",
        *("v.x := tmp.x", "v.y := tmp.y", "v.z := tmp.z"),
    ],
    "v:=where(3);": ["tmp := where(3)", "v.x := tmp.x", "v.y := tmp.y", "v.z := tmp.z"],
    "p:=Offs(p1,0,0,n);": ["p := rpl_offset(p1, 0, 0, n)"],
    r"p:=RelTool(p1,0,0,n\Rz:=45);": ["p := rpl_tool_offset(p1, 0, 0, n, 0, 0, 45)"],
    "IF v=v1 n:=1;": ["if (((v.x = v1.x) and (v.y = v1.y)) and (v.z = v1.z))", "  n := 1"],
    "n:=grip.tframe.trans.z;": ["n := grip.frame.z"],
    "tl.tframe.trans.z:=5;": ["tl.frame.z := 5"],
    "n:=tl.tload.cog.z;": ["n := tl.load.cog.z"],
    "j.robax.rax_1:=n;": ["j.j1 := n"],
    "n:=j.extax.eax_a;": ["n := j.e1"],
    "j.robax:=home.robax;": [f"j.j{n} := home.j{n}" for n in range(1, 7)],
    "p:=CRobT();": ["p := $actual_pose"],
    "j:=CJointT();": ["j := $actual_joints"],
    r"p:=CRobT(\Tool:=grip);": ["p := rpl_current(grip.frame, $base)"],
}


@pytest.mark.parametrize("text", CASES)
def test_statements(text: str) -> None:
    program = read(FRAME % text, "rapid")
    done = to_angles(program, context(program, "rapid"))
    assert lines(done) == CASES[text]
    found = Diagnostics()
    normalise(done, found)
    assert not found.has_errors, [item.as_text() for item in found]


def test_declarations() -> None:
    program = read(FRAME % "p:=p1;tl:=grip;", "rapid")
    done = to_angles(program, context(program, "rapid"))
    texts = {
        name: show(variable(done, name).initial or ir.Name("-")) for name in ("p1", "home", "grip", "corners", "v")
    }
    assert texts == {
        "p1": "{x 1, y 2, z 3, a 180.0, b 0.0, c 180.0}",
        "home": "{j1 0, j2 0, j3 0, j4 0, j5 30, j6 0, e2 5}",
        "grip": "{held True, frame {x 0, y 0, z 120, a 0.0, b 0.0, c 0.0}, load {mass 1.2, "
        "cog {x 0, y 0, z 60, a 0.0, b 0.0, c 0.0}, axes {x 0.0, y 0.0, z 0.0, a 0.0, b 0.0, c 0.0}, "
        "ix 0, iy 0, iz 0}}",
        "corners": "{{x 1, y 2, z 3, a 0.0, b 0.0, c 0.0}, {x 4, y 5, z 6, a 0.0, b 0.0, c 0.0}}",
        "v": "{x 0.0, y 0.0, z 0.0, a 0.0, b 0.0, c 0.0}",
    }
    assert variable(done, "tl").type == ir.NamedType("rpl_tool")
    records = [one.name for one in done.modules[0].declarations if isinstance(one, ir.RecordDeclaration)]
    assert records == ["rpl_load", "rpl_tool"]
    assert routine(done, "where").returns == ir.PoseType()
    assert [show(s.value) for s in routine(done, "where").body if isinstance(s, ir.Return) and s.value] == [
        "rpl_frame(k, 7.0, 3, 0.0, 0.0, 0.0)"
    ]


def test_a_condition_that_needs_a_statement_is_computed_at_each_pass() -> None:
    program = read(FRAME % "WHILE n<3 DO n:=n+1; ENDWHILE WHILE PoseVect(f,v)=v DO n:=1; ENDWHILE", "rapid")
    done = to_angles(program, context(program, "rapid"))
    assert lines(done) == [
        *("while (n < 3)", "  n := (n + 1)", "loop", "  tmp := rpl_transform(f, v.x, v.y, v.z)"),
        "  if not (((tmp.x = v.x) and (tmp.y = v.y)) and (tmp.z = v.z))",
        *("    exit", "  n := 1"),
    ]


def test_a_quaternion_component_cannot_be_assigned() -> None:
    program = read(FRAME % "o.q1:=1;", "rapid")
    surroundings = context(program, "rapid")
    done = to_angles(program, surroundings)
    assert [item.code.name for item in surroundings.diagnostics] == ["quaternion-component"]
    assert isinstance(routine(done, "t").body[0], ir.Opaque)
