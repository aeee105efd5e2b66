"""Functions that few targets have, in terms of what they have."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """VAR x: REAL = 2.5
VAR name: STRING[40] = "cover"
PROCEDURE main()
    SET do[1] TO abs(log10(x) - 0.39794) < 0.001
    SET do[3] TO to_code("A") = 65
    SET do[2] TO text_capacity(name) = 40 AND text_length(name) = 5
END PROCEDURE
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus", "inform", "tp"])
def test_rare_functions(target: str) -> None:
    read = read_sources([source_from_text("p.rpl", PROGRAM)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, "kuka_kr6r900sixx", None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = entry_name(back.program, written.renamed.get("main", "main"))
    result = prove_programs(read.program, back.program, "kuka_kr6r900sixx", entry="main", to_entry=entry)
    assert result.equal, result.as_text()
