"""What benchmarks/output_measures.py counts: lines without layout, and names that nobody gave."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))

from output_measures import programs
from output_names import helper_names
from output_text import lines_of, normal

SAME = [
    ("  LIN  xPick ;down", "LIN XPICK", "krl"),
    ("$VEL.CP = 0.20", "$VEL.CP=0.2", "krl"),
    ("  12:  R[1:box count]=R[1]+1.0  ;", "   3:  R[1]=R[1]+1 ;", "tp"),
    ("MOVL C00001 V=200.0  //PICK", "MOVL C00001 V=200.00", "inform"),
    ("MoveL pPick, v200,fine,\n  tGun; ! down", "MoveL pPick,v200,fine,tGun;", "rapid"),
    ("movel(pick,  v=0.50) # down", "movel(pick, v=0.5)", "urscript"),
]
FILES = {"krl": "a.src", "tp": "a.ls", "inform": "a.jbi", "rapid": "a.mod", "urscript": "a.script"}
BEFORE = {"tp": "/MN\n", "inform": "//INST\n"}


@pytest.mark.parametrize("one, other, language", SAME)
def test_layout_comments_and_names_beside_numbers_make_no_other_line(one: str, other: str, language: str) -> None:
    found = [lines_of(language, FILES[language], BEFORE.get(language, "") + text) for text in (one, other)]
    assert found[0] is not None
    assert found[0] == found[1]
    assert len(found[0].code) == 1


def test_texts_and_other_numbers_make_another_line() -> None:
    assert normal('TPWrite "No  Box";') != normal('TPWrite "no box";')
    assert normal("R[1:a]=1") != normal("R[2:a]=1")
    assert normal("movel(Pick)", case_sensitive=True) != normal("movel(pick)", case_sensitive=True)


def test_what_stands_in_comments_data_and_side_files_is_no_code() -> None:
    text = "&ACCESS RVP\nDEF a()\nDECL INT n\n;FOLD LIN p\nLIN p\n;ENDFOLD\nEND\n"
    found = lines_of("krl", "a.src", text)
    assert found is not None
    assert (found.code, found.data) == (("def a()", "lin p", "end"), ("decl int n",))
    assert lines_of("krl", "registers.csv", text) is None
    listed = lines_of("krl", "a.dat", "DEFDAT a\nTOOL_DATA[1]={X 0}\nENDDAT\n")
    assert listed is not None
    assert (listed.code, listed.data) == ((), ("tool_data[1]={x 0}",))


def test_names_of_the_source_are_no_helpers() -> None:
    text = "DEF main()\nDECL INT boxes,last\nboxes=0\nFOR last=1 TO 3\nboxes=boxes+last\nENDFOR\nEND\n"
    read = read_sources([source_from_text("main.src", text)], "krl", Diagnostics())
    for target in ("rapid", "tp", "urscript"):
        there = translate_program(read, target)
        sources = [source_from_text(file.path, file.data.decode("latin-1")) for file in there.files]
        again = read_sources(sources, target, Diagnostics())
        assert not {"boxes", "main"} & {name.lower() for name in helper_names(read, there, again, target)}
        assert set(helper_names(read_sources([], "krl", Diagnostics()), there, again, target))


def test_a_project_is_one_program_and_a_data_list_is_none(tmp_path: Path) -> None:
    (tmp_path / "whole").mkdir()
    for name in ("whole/expected.toml", "whole/a.src", "b.src", "b.dat", "c.mod", "notes.txt"):
        (tmp_path / name).write_text("")
    assert [path.name for path in programs([tmp_path])] == ["whole", "b.src", "c.mod"]
