"""The sign of a number, and turned offsets in the tool, in every target."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """PROCEDURE main()
    VAR x: REAL = -4.0
    VAR a: POSE
    VAR turn: REAL = 30.0
    SET do[1] TO sign(x) = -1 AND sign(-x) = 1 AND sign(0.0) = 0
    a = {x: 420, y: -80, z: 320, a: 0, b: 180, c: 0}
    MOVE TO a
    MOVE LINEAR TO tool_offset(a, 0, 0, -20, 10, -15, turn)
END PROCEDURE
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus", "inform", "tp"])
def test_signs_and_turns(target: str) -> None:
    read = read_sources([source_from_text("p.rpl", PROGRAM)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, "kuka_kr6r900sixx", None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = entry_name(back.program, written.renamed.get("main", "main"))
    result = prove_programs(read.program, back.program, "kuka_kr6r900sixx", entry="main", to_entry=entry)
    assert result.equal, result.as_text()
