"""Structured values in the form of the target."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.records.aggregates import aggregates
from rpl.passes.legalise.records.geometry import geometry
from rpl.passes.typing import normalise

from .helpers import context, lines, read, show, show_statement, variable

RAPID = """MODULE t
  RECORD size
    num long;
    num wide;
  ENDRECORD
  RECORD part
    num kind;
    size outer;
    pos at;
  ENDRECORD
  CONST num two:=2;
  VAR part first:=[1,[two,3],[0,0,two*5]];
  VAR num row{3}:=[1,2,3];
  VAR size grid{2,2}:=[[[1,2],[3,4]],[[5,6],[7,8]]];
  PROC use(part p)
  ENDPROC
  PROC t()
    VAR part p;
    VAR size s;
    VAR num n;
    VAR num other{3};
    VAR robtarget goal;
    VAR pos v;
%s
  ENDPROC
ENDMODULE
"""

TO_KRL = {
    "s:=[1,two];": ["s := {long 1, wide 2}"],
    "s:=[1,n];": ["s.long := 1", "s.wide := n"],
    "s:=[s.wide,s.long];": ["tmp.long := s.wide", "tmp.wide := s.long", "s := tmp"],
    "p:=[1,[2,3],[n,0,0]];": ["p.kind := 1", "p.outer := {long 2, wide 3}", *(f"p.at.{c}" for c in ())],
    "p:=[1,[n,3],[0,0,0]];": ["p.kind := 1", "p.outer.long := n", "p.outer.wide := 3"],
    "use [1,[2,n],[0,0,0]];": ["tmp.kind := 1", "tmp.outer.long := 2", "tmp.outer.wide := n"],
    "other:=row;": ["for element = 1 to 3", "  other[element] := row[element]"],
    "other:=[n,2,3];": ["other[1] := n", "other[2] := 2", "other[3] := 3"],
    "grid{1,2}:=[1,2];": ["grid[1, 2] := {long 1, wide 2}"],
    "goal:=[[1,2,n],[1,0,0,0],goal.robconf,goal.extax];": [
        "goal.trans := {x 1, y 2, z n}",
        "goal.rot := {q1 1, q2 0, q3 0, q4 0}",
    ],
    "goal:=[[1,2,goal.trans.x],[1,0,0,0],goal.robconf,goal.extax];": [
        *("tmp := goal", "tmp.trans := {x 1, y 2, z goal.trans.x}", "tmp.rot := {q1 1, q2 0, q3 0, q4 0}"),
        "goal := tmp",
    ],
}


@pytest.mark.parametrize("text", TO_KRL)
def test_named_constant_aggregates(text: str) -> None:
    program = read(RAPID % text, "rapid")
    done = aggregates(program, context(program, "rapid"))
    assert lines(done)[: len(TO_KRL[text])] == TO_KRL[text]
    found = Diagnostics()
    normalise(done, found)
    assert not found.has_errors, [item.as_text() for item in found]


def test_initial_values_by_name_and_by_element() -> None:
    program = read(RAPID % "n:=1;", "rapid")
    done = aggregates(program, context(program, "rapid"))
    first = variable(done, "first").initial
    assert show(first or ir.Name("-")) == "{kind 1, outer {long 2, wide 3}, at {x 0, y 0, z 10}}"
    assert variable(done, "row").initial is None
    data = [
        line for d in done.modules[0].declarations if isinstance(d, ir.Initialise) for line in show_statement(d.assign)
    ]
    assert data[:4] == ["row[1] := 1", "row[2] := 2", "row[3] := 3", "grid[1, 1] := {long 1, wide 2}"]
    assert data[-1] == "grid[2, 2] := {long 7, wide 8}"


def test_local_arrays_get_their_values_at_the_start() -> None:
    text = "MODULE t\nPROC t()\nVAR num k{2}:=[5,6];\nk{1}:=0;\nENDPROC\nENDMODULE\n"
    program = read(text, "rapid")
    assert lines(aggregates(program, context(program, "rapid"))) == ["k[1] := 5", "k[2] := 6", "k[1] := 0"]


def test_with_geometry_a_computed_target_is_numbers() -> None:
    program = read(RAPID % "goal:=[[1,2,n],OrientZYX(n,0,180),goal.robconf,goal.extax];", "rapid")
    surroundings = context(program, "rapid")
    from rpl.passes.legalise.places.postures.configurations import configurations

    done = geometry(aggregates(configurations(program, surroundings), surroundings), surroundings)
    parts = [("x", "1"), ("y", "2"), ("z", "n"), ("a", "n"), ("b", "0"), ("c", "180")]
    assert lines(done) == [f"goal.{name} := {value}" for name, value in parts]


KRL = """DEF t()
DECL PART p
DECL SIZE s
DECL INT n
DECL E6POS q
DECL FRAME f
DECL E6AXIS j
%s
END
====
DEFDAT t
STRUC SIZE REAL LONG,WIDE
STRUC PART INT KIND,SIZE OUTER,BOOL GOOD
DECL PART first={KIND 1}
DECL SIZE both={WIDE 2,LONG 1}
ENDDAT
"""

TO_RAPID = {
    "s={WIDE 2,LONG 1}": ["s := {LONG 1, WIDE 2}"],
    "s={WIDE 2}": ["s.WIDE := 2"],
    "s={WIDE n,LONG 1}": ["s := {LONG 1, WIDE n}"],
    "p={KIND 2,OUTER {LONG 3}}": ["p.KIND := 2", "p.OUTER.LONG := 3"],
    "q={Z 5,A 10}": ["q.z := 5", "q.a := 10"],
    "f={X 1,Y 2,Z 3,A 0,B 0,C 0}": ["f := {x 1, y 2, z 3, a 0, b 0, c 0}"],
    "j={A3 45}": ["j.j3 := 45"],
    "PTP {A3 45}": ["joint {j3 45}"],
}


@pytest.mark.parametrize("text", TO_RAPID)
def test_complete_aggregates_in_order(text: str) -> None:
    program = read(KRL % text, "krl")
    done = aggregates(program, context(program, "krl"))
    assert lines(done) == TO_RAPID[text]
    assert aggregates(done, context(program, "krl")) == done


def test_what_an_initial_value_leaves_out_gets_its_default() -> None:
    program = read(KRL % "n=1", "krl")
    done = aggregates(program, context(program, "krl"))
    texts = {name: show(variable(done, name).initial or ir.Name("-")) for name in ("first", "both")}
    assert texts == {"first": "{KIND 1, OUTER {LONG 0.0, WIDE 0.0}, GOOD False}", "both": "{LONG 1, WIDE 2}"}
