"""Formats that V+ cannot fill as they say are named."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """VAR s: STRING[40]
VAR n: INT = 13
PROCEDURE main()
    s = format("FORM|", n)
END PROCEDURE
"""


@pytest.mark.parametrize(("form", "named"), [("%03d", True), ("%-5d", True), ("%5d", False), ("%d", False)])
def test_filling_is_named(form: str, named: bool) -> None:
    read = read_sources([source_from_text("p.rpl", PROGRAM.replace("FORM", form))], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(read, "vplus", "kuka_kr6r900sixx", None, diagnostics)
    assert any(item.code.name == "vplus-format-filling" for item in diagnostics) == named
