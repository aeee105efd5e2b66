"""An interrupt by priority that watches a declared name of an input is a trap of that signal."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """SIGNAL spark = di[2]
VAR sparks: INT = 0
PROCEDURE main()
    DECLARE INTERRUPT 12 WHEN NOT spark DO spark_seen()
    INTERRUPT ON 12
    WAIT 1 s
    INTERRUPT OFF 12
END PROCEDURE
PROCEDURE spark_seen()
    sparks = sparks + 1
END PROCEDURE
"""


def test_an_alias_is_watched() -> None:
    read = read_sources([source_from_text("p.rpl", PROGRAM)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, "rapid", "kuka_kr6r900sixx", None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert any(b"ISignalDI spark,0," in file.data for file in written.files)
