"""Programs compute the same numbers after the passes, by an evaluator of their own."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.passes import rigid
from rpl.passes.legalise.aggregates import aggregates
from rpl.passes.legalise.configurations import configurations
from rpl.passes.legalise.defaults import starting_values
from rpl.passes.legalise.geometry import geometry
from rpl.passes.legalise.numbers import numbers
from rpl.passes.values import pose_of

from .evaluate import results
from .helpers import context, read

RAPID = """MODULE t
  RECORD size
    num long;
    pos at;
  ENDRECORD
  CONST robtarget p1:=[[400,50,300],[0.5,0.5,-0.5,0.5],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num row{3}:=[4,5,6];
  FUNC pos turned(pos v, orient o)
    VAR pose f;
    f.rot:=o;
    RETURN PoseVect(f,v);
  ENDFUNC
  FUNC num fact(num n)
    IF n<2 RETURN 1;
    RETURN n*fact(n-1);
  ENDFUNC
  PROC t()
    VAR robtarget p;
    VAR pose f:=[[10,20,30],[0.9659258,0,0,0.2588190]];
    VAR pose g;
    VAR pos v:=[1,2,3];
    VAR pos w:=[3,-1,0.5];
    VAR orient o:=[0.8,0,0.6,0];
    VAR num n;
    VAR num m;
    VAR bool b;
    VAR size s;
    p:=p1;
    %s
  ENDPROC
ENDMODULE
"""

PROGRAMS = [
    "p:=Offs(p1,1,2,3); p:=RelTool(p,10,0,5\\Rx:=10\\Ry:=20\\Rz:=30);",
    "g:=PoseMult(f,PoseInv(f)); g:=PoseMult(g,[v,o]);",
    "v:=v+w*2-[1,1,n]; n:=VectMagn(v); m:=Distance(v,w)+DotProd(v,w);",
    "v:=v*w; w:=[v.y,v.x,v.z*2]; v:=-w;",
    "v:=turned(v,o); n:=v.x; v:=PoseVect(f,PoseVect(PoseInv(f),v));",
    "o:=o*OrientZYX(10,20,30); n:=EulerZYX(\\Z,o); m:=EulerZYX(\\Y,o)+EulerZYX(\\X,o);",
    "n:=p.rot.q1; m:=o.q3+p1.rot.q4; p.rot:=[0.5,0.5,0.5,n];",
    "p.rot:=OrientZYX(EulerZYX(\\Z,p.rot)+30,EulerZYX(\\Y,p.rot),EulerZYX(\\X,p.rot));",
    "p.trans:=[p.trans.z,p.trans.x,p.trans.y]; p:=[v,o,p.robconf,p.extax];",
    "s:=[2,[1,n,3]]; s:=[s.at.x,[s.long,s.at.z,s.at.y]]; n:=s.long*10+s.at.x;",
    "b:=v=w; WHILE VectMagn(v)<100 DO v:=v*2; n:=n+1; ENDWHILE",
    "WHILE PoseVect(f,v)<>w AND n<5 DO v:=v+[1,0,0]; n:=n+1; ENDWHILE",
    "FOR i FROM 1 TO 3 DO n:=n+row{i}*i; m:=m+row{4-i}/2; ENDFOR",
    "n:=fact(5); m:=n DIV 7; n:=n MOD 7; m:=m+Round(2.5)+Trunc(-2.7)+Round(-0.5);",
    "m:=2.6; n:=row{Round(m)}; m:=Round(m*3.14159\\Dec:=2)+Trunc(-2.789\\Dec:=1);",
    "m:=Min(n,3)+Max(m,0.5)+Abs(-7); TEST m CASE 7.5: n:=1; DEFAULT: n:=2; ENDTEST",
    "m:=ASin(0.5)+ATan(2)+Pow(m,2)+Pow(1.5,3);",
    "n:=7; m:=n/2; m:=m+(n+1)/(n-4); n:=-7 DIV 2; m:=m*10+(-7 MOD 3);",
]


def converted(text: str) -> tuple[dict[str, Any], dict[str, Any]]:
    program = read(RAPID % text, "rapid")
    surroundings = context(program, "rapid")
    capabilities = surroundings.capabilities
    surroundings.capabilities = replace(capabilities, functions=capabilities.functions - {"round"})
    done = program
    for one in (configurations, numbers, starting_values, aggregates, geometry):
        done = one(done, surroundings)
    return results(program), results(done)


def close(one: Any, other: Any) -> bool:
    if isinstance(one, rigid.Vector | rigid.Rotation | rigid.Pose):
        first, second = pose_of(one), pose_of(other)
        return first is not None and second is not None and close(first.matrix, second.matrix)
    if isinstance(one, dict):
        return all(close(value, other[key]) for key, value in one.items())
    if isinstance(one, list | tuple):
        return all(close(a, b) for a, b in zip(one, other, strict=True))
    if isinstance(one, str | bool):
        return bool(one == other)
    return abs(one - other) < 1e-6


@pytest.mark.parametrize("text", PROGRAMS)
def test_the_same_numbers(text: str) -> None:
    before, after = converted(text)
    different = {
        key: (value, after.get(key))
        for key, value in before.items()
        if key not in after or not close(value, after[key])
    }
    assert not different


ANGLE = st.sampled_from([0, 30, -45, 90, 180, -90, 123.4, -179])


@settings(max_examples=60, deadline=None)
@given(st.tuples(ANGLE, ANGLE, ANGLE), st.tuples(ANGLE, ANGLE, ANGLE))
def test_rotations_in_any_posture(one: tuple[float, ...], other: tuple[float, ...]) -> None:
    first, second = (",".join(map(str, angles)) for angles in (one, other))
    text = f"o:=OrientZYX({first}); f.rot:=o*OrientZYX({second}); v:=PoseVect(f,v); o:=[o.q1,o.q2,o.q3,o.q4];"
    before, after = converted(text)
    assert all(close(value, after[key]) for key, value in before.items())
