"""Percentages for speeding up and slowing down in another language: written where it has them, else reported."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

VPLUS = """.PROGRAM main()
  SET a = TRANS(300,-200,500,0,180,0)
  SET b = TRANS(300,200,500,0,180,0)
  {first}
  MOVES a
  BREAK
  {second}
  MOVES b
.END
"""
RAPID = """MODULE main
PROC main()
  {first}
  MoveL [[300,-200,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;
  {second}
  MoveL [[300,200,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;
ENDPROC
ENDMODULE
"""
INFORM = """/JOB
//NAME MAIN
//POS
///NPOS 0,0,0,2,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 0,0,0,0,0,0,0,0
P000=300.000,-200.000,500.000,180.0000,0.0000,0.0000
P001=300.000,200.000,500.000,180.0000,0.0000,0.0000
//INST
///DATE 2020/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
MOVL P000 V=200.0 PL=0 {first}
MOVL P001 V=200.0 PL=0 {second}
END
"""
TEXTS = {"vplus": ("main.v2", VPLUS), "rapid": ("main.mod", RAPID), "inform": ("MAIN.JBI", INFORM)}


def translated(source: str, target: str, first: str, second: str) -> tuple[str, set[str]]:
    """The text without line ends, and the codes of what was reported."""
    name, text = TEXTS[source]
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(name, text.format(first=first, second=second))], source, diagnostics)
    result = translate_program(read, target, "abb_irb140", diagnostics=diagnostics)
    lines = [line.strip() for file in result.files for line in file.data.decode("utf-8", "replace").splitlines()]
    return "\n".join(lines), {item.code.name for item in diagnostics}


CASES = [
    # source, first setting, second, target, lines that are there, is a loss reported
    ("vplus", "ACCEL 50, 80", "", "inform", ["ACC=50 DEC=80"], False),
    ("vplus", "ACCEL 50", "ACCEL , 40", "inform", ["PL=0 ACC=50\n", "ACC=50 DEC=40"], False),
    ("vplus", "ACCEL 50, 50", "ACCEL 100, 100", "rapid", ["AccSet 50,100;", "AccSet 100,100;"], False),
    ("vplus", "ACCEL 50, 50", "", "tp", ["ACC50"], False),
    ("vplus", "ACCEL 50, 80", "", "tp", ["ACC50"], True),
    ("vplus", "ACCEL 50", "", "rapid", ["AccSet 50,100;"], True),
    ("vplus", "ACCEL 50, 50", "", "krl", ["$ACC.CP=2.5"], False),
    ("vplus", "ACCEL , 50", "", "urscript", ["movel("], True),
    ("rapid", "AccSet 50,100;", "AccSet 100,100;", "vplus", ["ACCEL 50, 50", "ACCEL 100, 100"], False),
    ("rapid", "AccSet 50,100;", "AccSet 100,100;", "inform", ["ACC=50 DEC=50"], False),
    ("rapid", "AccSet 50,100;", "AccSet 100,100;", "tp", ["FINE ACC50"], False),
    ("inform", "ACC=50 DEC=80", "", "vplus", ["ACCEL 50, 80", "ACCEL 100, 100"], False),
    ("inform", "ACC=50", "DEC=40", "vplus", ["ACCEL 50, 100", "ACCEL 100, 40"], False),
    ("inform", "ACC=50 DEC=50", "", "tp", ["FINE ACC50"], False),
    ("inform", "ACC=50 DEC=80", "", "rapid", ["AccSet 50,100;"], True),
    ("inform", "ACC=50 DEC=80", "", "inform", ["ACC=50 DEC=80"], False),
]


@pytest.mark.parametrize(("source", "first", "second", "target", "lines", "lost"), CASES)
def test_percentages_are_carried_or_reported(
    source: str, first: str, second: str, target: str, lines: list[str], lost: bool
) -> None:
    text, codes = translated(source, target, first, second)
    assert all(line in text for line in lines), text
    assert ("deceleration-of-acceleration" in codes) == lost


def test_a_ramp_is_no_deceleration() -> None:
    """RAPID's \\FinePointRamp is how fast the deceleration changes: no percentage of another language."""
    for target in ("vplus", "inform", "tp", "krl"):
        text, codes = translated("rapid", target, "AccSet 100,100\\FinePointRamp:=40;", "")
        assert "dropped-setting" in codes
        assert "40" not in text.replace("400", "")
    same, codes = translated("rapid", "rapid", "AccSet 100,60\\FinePointRamp:=40;", "AccSet 80,80;")
    assert "AccSet 100,60\\FinePointRamp:=40;" in same and "AccSet 80,80;" in same and "dropped-setting" not in codes
