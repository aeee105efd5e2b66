"""The tool and frame of one move beside a tool that is set: they stay with the move, and questions mean the set one."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
PROGRAM = """VAR nozzle: TOOL = {held: TRUE, frame: {x: 0, y: 0, z: 90, a: 0, b: 0, c: 0},
                      load: {mass: 1.2, cog: {x: 0, y: 0, z: 40}}}
VAR bench: WORKOBJECT = {held: FALSE, fixed: TRUE, unit: "",
                           user_frame: {x: 400, y: 0, z: 200, a: 0, b: 0, c: 0},
                           object_frame: {x: 50, y: -100, z: 0, a: 0, b: 0, c: 0}}
VAR p: POSE
VAR v: VECTOR
VAR t: TARGET
PROCEDURE main()
    SETTING
    p = {x: 450, y: 50, z: 350, a: 0, b: 180, c: 0}
    MOVE TO p
    MOVE LINEAR TO {x: 0, y: 50, z: 100, a: 0, b: 180, c: 0} SPEED 200 mm/s TOOL nozzle FRAME bench
    v = current_position()
    SET do[1] TO abs(v.x - 450) < 0.1 AND abs(v.y + 50) < 0.1 AND abs(v.z - 340) < 0.1
    t = current_target(nozzle, bench)
    SET do[2] TO abs(t.x) < 0.1 AND abs(t.z - 100) < 0.1
    MOVE LINEAR TO p
    v = current_position()
    SET do[3] TO abs(v.x - 450) < 0.1 AND abs(v.y - 50) < 0.1 AND abs(v.z - 350) < 0.1
    t = current_target(nozzle)
    SET do[4] TO abs(t.z - 310) < 0.1
    other()
    t = current_target()
    SET do[5] TO abs(t.z - 340) < 0.1
    MOVE LINEAR TO p
END PROCEDURE
PROCEDURE other()
    MOVE LINEAR TO {x: 0, y: 50, z: 100, a: 0, b: 180, c: 0} SPEED 200 mm/s TOOL nozzle FRAME bench
END PROCEDURE
PROCEDURE set_tool(length: REAL)
    $tool = {x: 0, y: 0, z: length, a: 0, b: 0, c: 0}
END PROCEDURE
"""
SETTINGS = {"constant": "$tool = {x: 0, y: 0, z: 50, a: 0, b: 0, c: 0}", "computed": "set_tool(50)"}


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus", "inform", "tp"])
def test_the_tool_of_one_move_is_not_the_one_that_is_set(target: str, setting: str) -> None:
    text = PROGRAM.replace("SETTING", SETTINGS[setting])
    read = read_sources([source_from_text("p.rpl", text)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = written.renamed.get("main", "main")
    result = prove_programs(read.program, back.program, KUKA, entry="main", to_entry=entry_name(back.program, entry))
    assert result.agrees, result.as_text()
