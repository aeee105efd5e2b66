"""Outputs that a target cannot read back: a variable keeps the value of each that is read."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """DEF main( )
DECL INT i
DECL REAL v
%s
$OUT[1]=%s
END
DEF other( )
$ANOUT[1]=$ANOUT[1]+0.25
END
"""
CASES = {
    "before it is set": ("v=$ANOUT[1]", "v==0.0"),
    "set": ("$ANOUT[1]=0.5\nv=$ANOUT[1]", "v==0.5"),
    "set elsewhere": ("$ANOUT[1]=0.5\nother()", "$ANOUT[1]==0.75"),
    "in a loop": ("FOR i=1 TO 3\n$ANOUT[2]=$ANOUT[2]+0.25\nENDFOR", "$ANOUT[2]==0.75"),
}


def read(text: str) -> ReadProgram:
    return read_sources([source_from_text("main.src", text)], "krl", Diagnostics())


def digital(program: ReadProgram, entry: str) -> list[object]:
    outputs = run_program(program.program, entry=entry).outputs
    return [value for _, name, value in outputs if name in ("$OUT[1]", "1")]


@pytest.mark.parametrize("name", CASES)
def test_what_is_read_back(name: str) -> None:
    own = read(PROGRAM % CASES[name])
    assert digital(own, "main") == [True]
    diagnostics = Diagnostics()
    written = translate_program(own, "vplus", None, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "vplus", Diagnostics())
    assert digital(back, "main") == [True]


def test_an_output_that_is_only_set_has_no_variable() -> None:
    written = translate_program(read(PROGRAM % ("$ANOUT[2]=0.5", "TRUE")), "vplus", None, None, Diagnostics())
    text = "".join(file.data.decode() for file in written.files)
    assert "AIO.OUT 2 = 0.5" in text and "analog_out_2" not in text


def test_a_computed_number_is_refused() -> None:
    diagnostics = Diagnostics()
    translate_program(
        read(PROGRAM % ("IF $IN[1] THEN\ni=1\nELSE\ni=2\nENDIF\n$ANOUT[i]=0.5\nv=$ANOUT[2]", "TRUE")),
        "vplus",
        None,
        None,
        diagnostics,
    )
    assert any("analog" in item.message for item in diagnostics.of(Severity.LOSS))
