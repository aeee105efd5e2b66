"""The text in the brackets of a label (`LBL[10:next part]`): a remark in other languages, the label's text in TP."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """/PROG  LABELS
/ATTR
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:  LBL[1:next part] ;
   2:  WAIT DI[1]=ON ;
   3:  IF DI[2]=ON,JMP LBL[20] ;
   4:  DO[1]=ON ;
   5:  JMP LBL[1] ;
   6:  LBL[20:done] ;
   7:  DO[1]=OFF ;
   8:  IF DI[3]=ON,JMP LBL[30] ;
   9:  IF DI[4]=ON,JMP LBL[20] ;
  10:  DO[3]=OFF ;
  11:  LBL[30] ;
/POS
/END
"""
ROBOT = "fanuc_lrmate200id"


def _read() -> ReadProgram:
    return read_sources([source_from_text("labels.ls", PROGRAM)], "tp", Diagnostics())


def _written(read: ReadProgram, target: str) -> str:
    files = translate_program(read, target, ROBOT, None, Diagnostics()).files
    return "\n".join(one.data.decode("latin-1") for one in files if not one.path.endswith((".toml", ".VA")))


@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus", "inform", "val3"])
def test_other_languages_have_it_as_a_remark(target: str) -> None:
    text = _written(_read(), target)
    assert "next part" in text
    assert "done" in text


def test_a_label_of_another_language_keeps_its_remark_in_the_brackets() -> None:
    files = translate_program(_read(), "rapid", ROBOT, None, Diagnostics()).files
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "rapid", Diagnostics())
    lines = _written(back, "tp").splitlines()
    assert any("LBL[20:done]" in line for line in lines)
    assert not any("!done" in line for line in lines)


@pytest.mark.parametrize("target", ["krl", "vplus", "rapid"])
def test_the_text_of_a_loop_comes_back(target: str) -> None:
    files = [one for one in translate_program(_read(), target, ROBOT, None, Diagnostics()).files if _is_text(one.path)]
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], target, Diagnostics())
    lines = _written(back, "tp")
    assert ":next part]" in lines
    assert ":done]" in lines


def _is_text(path: str) -> bool:
    return not path.endswith(".toml")
