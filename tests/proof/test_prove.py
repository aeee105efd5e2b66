"""Programs in their languages: what `prove` calls equal, and what it refutes, at which line."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import ProofResult, prove_programs
from rpl.source import source_from_text

ROBOT = "kuka_kr6r900sixx"
PATHS = {"krl": "pick.src", "rapid": "pick.mod", "rpl": "pick.rpl"}

KRL = """DEF pick()
DECL INT i
$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}
$TOOL={X 0,Y 0,Z 50,A 0,B 0,C 0}
$VEL.CP=0.5
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
$OUT[1]=TRUE
LIN_REL {X 50,Y 0,Z 0,A 0,B 0,C 0}
MsgNotify("at part")
$OUT[2]=TRUE
WAIT SEC 0.5
FOR i=1 TO 2
  LIN_REL {X 0,Y 20,Z 0,A 0,B 0,C 0}
  $OUT[3]=NOT $OUT[3]
ENDFOR
PTP {A1 10,A2 -90,A3 90,A4 0,A5 45,A6 0}
$OUT[1]=FALSE
END
"""
RAPID = """MODULE pick
  PERS tooldata grip:=[TRUE,[[0,0,50],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  VAR num i;
  PROC main()
    MoveAbsJ [[0,-90,90,0,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,grip;
    SetDO do1,1;
    MoveL Offs(CRobT(\\Tool:=grip),50,0,0),v500,fine,grip;
    TPWrite "at part";
    SetDO do2,1;
    WaitTime 0.5;
    FOR i FROM 1 TO 2 DO
      MoveL Offs(CRobT(\\Tool:=grip),0,20,0),v500,fine,grip;
      IF DOutput(do3)=1 THEN
        SetDO do3,0;
      ELSE
        SetDO do3,1;
      ENDIF
    ENDFOR
    MoveAbsJ [[10,-90,90,0,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,grip;
    SetDO do1,0;
  ENDPROC
ENDMODULE
"""


def prove_texts(a: str, b: str, language_a: str = "krl", language_b: str = "krl") -> ProofResult:
    programs = []
    for text, language in ((a, language_a), (b, language_b)):
        diagnostics = Diagnostics()
        read = read_sources([source_from_text(PATHS[language], text)], language, diagnostics)
        assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
        programs.append(read.program)
    return prove_programs(programs[0], programs[1], ROBOT)


def test_a_program_equals_itself_at_every_level() -> None:
    result = prove_texts(KRL, KRL)
    assert result.agrees, result.as_text()
    assert (result.level, result.max_path_mm, result.difference) == ("time", 0.0, None)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("DECL INT i", "DECL INT i ; counts\n; a remark"),
        ("  LIN_REL {X 0,Y 20,Z 0,A 0,B 0,C 0}", "  LIN_REL {Y 20}"),
        ("FOR i=1 TO 2\n", "FOR i=5 TO 6\n"),
        ("$OUT[2]=TRUE\nWAIT", "IF TRUE THEN\n$OUT[2]=TRUE\nENDIF\nWAIT"),
        ("WAIT SEC 0.5", "WAIT SEC 0.25+0.25"),
        ("WAIT SEC 0.5", "WAIT SEC 0.5\n$OUT[2]=TRUE"),
        ("$OUT[1]=FALSE\nEND", "$OUT[1]=FALSE\nRETURN\nEND"),
    ],
)
def test_other_words_for_the_same(old: str, new: str) -> None:
    assert old in KRL
    result = prove_texts(KRL, KRL.replace(old, new))
    assert result.agrees, result.as_text()


@pytest.mark.parametrize(
    ("old", "new", "kind", "line"),
    [
        ("LIN_REL {X 50,Y 0", "LIN_REL {X 51,Y 0", "path", 8),
        ("LIN_REL {X 50,Y 0,Z 0,A 0", "LIN_REL {X 50,Y 0,Z 0,A 1", "path", 8),
        ("Z 50,A 0,B 0,C 0}", "Z 51,A 0,B 0,C 0}", "path", 6),
        ("PTP {A1 10", "PTP {A1 10.1", "path", 16),
        ("$OUT[2]=TRUE\n", "", "order", 10),
        ("$OUT[2]=TRUE", "$OUT[4]=TRUE", "output", 10),
        ("$OUT[1]=FALSE", "$OUT[1]=TRUE", "order", 17),
        ('"at part"', '"at Part"', "message", 9),
        ("WAIT SEC 0.5", "WAIT SEC 0.6", "wait", 11),
        ("FOR i=1 TO 2", "FOR i=1 TO 3", "output", 17),
        ("$OUT[1]=FALSE", "$OUT[1]=FALSE\nHALT", "end", None),
    ],
)
def test_one_change_is_refuted_at_its_line(old: str, new: str, kind: str, line: int | None) -> None:
    assert old in KRL
    result = prove_texts(KRL, KRL.replace(old, new, 1))
    assert not result.agrees
    assert result.difference is not None
    assert result.difference.kind == kind, result.as_text()
    if line is not None:
        assert result.difference.a.place.line == line, result.as_text()
        assert result.difference.a.place.text


def test_two_languages_say_the_same() -> None:
    result = prove_texts(KRL, RAPID, "krl", "rapid")
    assert result.agrees, result.as_text()
    assert (result.level, result.verdict) == ("geometry", "alike")
    assert [one.kind for one in result.open] == ["joint-speed", "load", "load-centre"]
    assert result.max_path_mm < 0.01


def test_two_languages_and_one_millimetre() -> None:
    result = prove_texts(KRL, RAPID.replace("grip),50,0,0)", "grip),51,0,0)"), "krl", "rapid")
    assert not result.agrees
    assert result.difference is not None
    assert (result.difference.a.place.line, result.difference.b.place.line) == (8, 7)


def test_the_same_fault_decides_nothing() -> None:
    far = KRL.replace("LIN_REL {X 50,", "LIN_REL {X 5000,")
    result = prove_texts(far, far)
    assert result.verdict == "undecided" and "fault" in result.reason, result.as_text()
    assert "pick.src:8" in result.headline()
    other = prove_texts(far, KRL)
    assert not other.agrees
    assert other.difference is not None


def test_waiting_for_ever_is_said() -> None:
    blocked = KRL.replace("WAIT SEC 0.5", "WAIT FOR $IN[1]")
    result = prove_texts(blocked, blocked)
    assert result.verdict == "undecided" and "never comes" in result.reason, result.as_text()
