"""Choices and waits whose value is too long for a line: parts of it are calculated in front."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

FRAME = """MODULE demo
  VAR num measured_left{3}:=[1,2,3];
  VAR num measured_right{3}:=[4,5,6];
  VAR num chosen_station{3}:=[3,1,2];
  PROC main()
    VAR num k:=1;
%s
  ENDPROC
ENDMODULE
"""
SUM = "measured_left{chosen_station{k}}+measured_right{chosen_station{k}}"
LONG = f"{SUM}+{SUM}+{SUM}"
CASES = {
    "choice": f"TEST {LONG}\nCASE 26:\nSetDO do2,1;\nCASE 27:\nSetDO do1,1;\nENDTEST",
    "wait": f"WaitTime ({LONG})/100;\nSetDO do1,1;",
}


@pytest.mark.parametrize("body", CASES.values(), ids=CASES.keys())
def test_a_long_value_is_calculated_in_front(body: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("demo.mod", FRAME % body)], "rapid", diagnostics)
    written = translate_program(read, "vplus", "abb_irb1200_5_90", None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    files = [source_from_bytes(one.path, one.data) for one in written.files]
    assert max(len(line) for file in files for line in file.text.splitlines()) <= 120
    result = run_program(read_sources(files, "vplus", Diagnostics()).program, "abb_irb1200_5_90")
    assert [(name, state) for _, name, state in result.outputs] == [("1", True)]
