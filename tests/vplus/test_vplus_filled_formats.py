"""Formats that V+ has are written as its own; of those with other fillings the statement is refused."""

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
    ("form", "text"), [("%03d", None), ("%-5d", None), ("%+d", None), ("% d", None), ("%5d", "   13"), ("%d", "13")]
)
def test_formats_mean_the_same(form: str, text: str | None) -> None:
    diagnostics = Diagnostics()
    program = PROGRAM.replace("FORM", form).replace("TEXT", text or "")
    read = read_sources([source_from_text("p.rpl", program)], "rpl", diagnostics)
    written = translate_program(read, "vplus", ROBOT, None, diagnostics)
    lost = [(item.code.name, item.origin.line) for item in diagnostics.of(Severity.LOSS)]
    assert lost == ([] if text else [("vplus-guarded-stop", 4)])
    if text:
        back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "vplus", diagnostics)
        assert [value for _, _, value in run_program(back.program, ROBOT, None, "main").outputs] == [True]


def test_a_form_that_the_run_decides_is_refused() -> None:
    diagnostics = Diagnostics()
    program = PROGRAM.replace('"FORM|"', "t").replace("VAR n", "VAR t: STRING[40]\nVAR n")
    read = read_sources([source_from_text("p.rpl", program)], "rpl", diagnostics)
    written = translate_program(read, "vplus", ROBOT, None, diagnostics)
    assert "a text whose form the run decides" in "\n".join(one.as_text() for one in diagnostics.of(Severity.LOSS))
    assert "PAUSE" in source_from_bytes(written.files[0].path, written.files[0].data).text
