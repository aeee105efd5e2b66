"""Programs compute the same numbers after the passes, by an evaluator of their own."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.passes import rigid
from rpl.passes.legalise.data.defaults import starting_values
from rpl.passes.legalise.data.numbers import numbers
from rpl.passes.legalise.places.postures.configurations import configurations
from rpl.passes.legalise.records.aggregates import aggregates
from rpl.passes.legalise.records.geometry import geometry
from rpl.passes.legalise.statements.enums import enums_to_constants
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
    "p.trans:=[500,80,340]; f:=DefFrame(p1,p,RelTool(p1,30,40,50));",
    "p.trans:=[400,80,340]; f:=DefFrame(p1,p,Offs(p1,30,40,50)\\Origin:=3);",
    "p.trans:=[400,80,340]; g:=DefFrame(p1,Offs(p1,0,0,9),p\\Origin:=2);",
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


KRL = """DEF t()
DECL E6POS p
DECL FRAME f,g
DECL INT i,k
DECL REAL r
DECL COLOR c
DECL PART q
p=XP1
f={X 10,Y 20,Z 30,A 30,B 0,C 0}
g={X 1,Y 2,Z 3,A 10,B 20,C 30}
i=7
k=0
r=1.5
c=#GREEN
q={KIND 1,SIZE {LONG 2,WIDE 3}}
%s
END
DEFFCT REAL twice(v:IN)
DECL REAL v
RETURN v*2
ENDFCT
====
DEFDAT t
ENUM COLOR RED,GREEN,BLUE
STRUC SIZE REAL LONG,WIDE
STRUC PART INT KIND,SIZE SIZE
DECL E6POS XP1={X 400,Y 50,Z 300,A 90,B 20,C 180,S 2,T 35,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}
DECL INT row[3]
row[1]=4
row[2]=5
row[3]=6
ENDDAT
"""

KRL_PROGRAMS = [
    "k=i/2\nr=i/2.0\nk=r*i\nr=twice(i)/4",
    "p.z=p.z+100\np.a=p.a+10\nr=p.b+p.c",
    "p.a=10\np.b=20\np.c=30\nf.c=5\nf.a=r",
    "g=f:g\nf=INV_POS(g):f\nf.x=f.y+p.x",
    "f=p\np=g\nf=f:p",
    "f={X 1,Y r,Z 3,A i,B 0,C 90}\ng={Z 5}\np={X 9,A 45}",
    "q={KIND 5}\nq.SIZE={WIDE 9}\nr=q.SIZE.LONG+q.SIZE.WIDE",
    "IF c==#GREEN THEN\n k=1\nENDIF\nSWITCH c\n CASE #RED\n  i=1\n CASE #GREEN,#BLUE\n  i=2\nENDSWITCH",
    "FOR i=1 TO 3\n k=k+row[i]*i\nENDFOR\nk=row[2.4]+k",
]


@pytest.mark.parametrize("text", KRL_PROGRAMS)
def test_the_same_numbers_from_two_number_types(text: str) -> None:
    program = read(KRL % text, "krl")
    surroundings = context(program, "krl")
    done = program
    for one in (configurations, numbers, enums_to_constants, aggregates, geometry):
        done = one(done, surroundings)
    before, after = results(program), results(done)
    different = {
        key: (value, after.get(key)) for key, value in before.items() if key != "c" and not close(value, after[key])
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
