"""A move without a frame behind one with a frame, for targets whose frame is modal: the world is set again."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
PROGRAM = """VAR shift: POSE
VAR p: POSE
PROCEDURE main()
    p = {x: 500, y: 50, z: 400, a: 0, b: 180, c: 0}
    shift = {x: 0, y: 0, z: 25, a: 0, b: 0, c: 0}
    MOVE TO p
    MOVE LINEAR TO p SPEED 200 mm/s FRAME shift
    shift = $null_frame
    MOVE LINEAR TO p SPEED 200 mm/s
    MOVE LINEAR TO offset(p, 20, 0, 0) SPEED 200 mm/s TOOL shift
    MOVE LINEAR TO offset(p, 0, 20, 0) SPEED 200 mm/s
END PROCEDURE
"""


@pytest.mark.parametrize("target", ["krl", "vplus"])
def test_the_frame_of_one_move_is_not_the_next_one_s(target: str) -> None:
    read = read_sources([source_from_text("p.rpl", PROGRAM)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = prove_programs(read.program, back.program, KUKA, entry="main", to_entry=entry_name(back.program))
    assert result.agrees, result.as_text()
