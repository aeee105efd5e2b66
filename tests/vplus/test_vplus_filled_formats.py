"""Formats with fillings come along as functions of the program, formats that V+ has are written as its own."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
PROGRAM = """VAR s: STRING[40]
VAR n: INT = 13
PROCEDURE main()
    s = format("FORM|", n)
    SET do[1] TO s = "TEXT|"
END PROCEDURE
"""


@pytest.mark.parametrize(
    ("form", "text", "alone"),
    [("%03d", "013", False), ("%-5d", "13   ", False), ("%5d", "   13", True), ("%d", "13", True)],
)
def test_formats_mean_the_same(form: str, text: str, alone: bool) -> None:
    diagnostics = Diagnostics()
    program = PROGRAM.replace("FORM", form).replace("TEXT", text)
    read = read_sources([source_from_text("p.rpl", program)], "rpl", diagnostics)
    written = translate_program(read, "vplus", ROBOT, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    sources = [source_from_bytes(file.path, file.data) for file in written.files]
    assert (sources[0].text.count(".PROGRAM") == 1) == alone
    back = read_sources(sources, "vplus", diagnostics)
    assert [value for _, _, value in run_program(back.program, ROBOT, None, "main").outputs] == [True]
