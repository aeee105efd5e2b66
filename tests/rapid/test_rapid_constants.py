"""Data that nothing assigns is CONST in RAPID; what a program, a search or a call may set stays PERS or VAR."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

KUKA = "kuka_kr6r900sixx"
DATA = """DEFDAT main
DECL AXIS START={A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
DECL E6POS XP={X 450,Y 0,Z 500,A 0,B 90,C 0}
DECL E6POS XQ={X 450,Y 50,Z 500,A 0,B 90,C 0}
DECL INT AMOUNT=2
DECL REAL WAY=2.5
DECL BOOL READY=FALSE
DECL FRAME TABLE={X 10,Y 0,Z 0,A 0,B 0,C 0}
ENDDAT
"""
ROUTINES = """
DEF READS(A:IN)
INT A
IF A>1 THEN
$OUT[3]=TRUE
ENDIF
END
DEF REFERS(A:OUT)
INT A
IF A>1 THEN
$OUT[3]=TRUE
ENDIF
END
DEF RAISES(P:OUT)
E6POS P
P.Z=P.Z+20
END
"""
# Lines of the program, and how each of its data is kept.
USUAL = {"START": "CONST jointtarget", "XP": "CONST robtarget", "AMOUNT": "CONST num", "WAY": "CONST num"}
CASES = [
    ("", {**USUAL, "XQ": "CONST robtarget", "READY": "CONST bool", "TABLE": "PERS pose"}),
    ("AMOUNT=AMOUNT+1", {**USUAL, "AMOUNT": "PERS num"}),
    ("READY=$IN[1]", {**USUAL, "READY": "PERS bool"}),
    ("FOR AMOUNT=1 TO 3\n$OUT[2]=NOT $OUT[2]\nENDFOR", {**USUAL, "AMOUNT": "PERS num"}),
    ("XQ=XP", {**USUAL, "XQ": "PERS robtarget"}),
    ("XQ.Z=520", {**USUAL, "XQ": "PERS robtarget"}),
    ("RAISES(XQ)", {**USUAL, "XQ": "PERS robtarget"}),
    ("READS(AMOUNT)", USUAL),
    ("REFERS(AMOUNT)", {**USUAL, "AMOUNT": "PERS num"}),  # INOUT takes no constant
]


@pytest.mark.parametrize(("lines", "kept"), CASES, ids=[lines.partition("\n")[0] or "nothing" for lines, _ in CASES])
def test_what_nothing_sets_is_constant(lines: str, kept: dict[str, str]) -> None:
    use = "IF (AMOUNT+WAY>4) AND NOT READY AND (TABLE.X>0) THEN\n$OUT[1]=TRUE\nENDIF"
    text = f"DEF main()\nPTP START\n$VEL.CP=0.25\nLIN XP\n{lines}\n{use}\nLIN XQ\n$OUT[4]=TRUE\nEND\n"
    journey = there_and_back({"main.src": text + ROUTINES, "main.dat": DATA}, "krl", "rapid", KUKA)
    assert not journey.losses
    declared = [line.strip().removeprefix("LOCAL ") for line in journey.text.splitlines()]
    for name, storage in kept.items():
        assert any(line.startswith(f"{storage} {name}:=") for line in declared), (name, journey.text)
    proof = journey.prove()
    assert proof.verdict in ("equal", "alike"), proof.as_text()


def test_what_a_search_tells_is_a_variable() -> None:
    text = """MODULE m
  PERSISTENT place: TARGET = {x: 600, y: 0, z: 300, a: 0, b: 90, c: 0}
  VAR seen: BOOL = false
  VAR never: BOOL = false
  VAR found: TARGET
  PROCEDURE main()
    MOVE TO {j1: 0, j2: -90, j3: 90, j4: 0, j5: 60, j6: 0}
    MOVE LINEAR TO place SPEED 100 mm/s FINE SEARCH di[1] INTO found HIT seen STOPPING stop
    IF seen AND NOT never THEN
      SET do[1] TO true
    END IF
  END PROCEDURE
END MODULE
"""
    journey = there_and_back({"m.rpl": text}, "rpl", "rapid", KUKA)
    assert "VAR bool seen:=FALSE;" in journey.text and "CONST bool never:=FALSE;" in journey.text, journey.text
    assert journey.prove().agrees
