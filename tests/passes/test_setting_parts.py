"""A component of the tool or frame in use that is set alone moves the robot differently, in every language."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.emulator.model import load_robot
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = load_robot("kuka_kr6r900sixx")
PROGRAM = """DEF CELL( )
DECL FRAME LONG
INT N
LONG={X 0,Y 0,Z 120,A 0,B 0,C 0}
N=2
$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}
$TOOL=LONG
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
$TOOL.Z=LONG.Z/4
$BASE.X=N*10
LIN {X 460,Y 50,Z 700,A 0,B 150,C 0}
END
"""


@pytest.mark.parametrize("target", ["rapid", "urscript", "vplus", "inform", "krl", "rpl"])
def test_the_robot_ends_where_the_changed_tool_and_frame_say(target: str) -> None:
    source = read_sources([source_from_text("cell.src", PROGRAM)], "krl", Diagnostics())
    own = run_program(source.program, KUKA)
    diagnostics = Diagnostics()
    made = translate_program(source, target, KUKA.name, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    again = read_sources([source_from_bytes(f.path, f.data) for f in made.files], target, Diagnostics())
    entry = made.renamed.get("CELL", "CELL")
    result = run_program(again.program, KUKA, entry=entry if target != "urscript" else None)
    assert result.status == own.status == "finished", result.fault
    assert result.joints is not None and own.joints is not None
    here, there = KUKA.forward(own.joints), KUKA.forward(result.joints)
    assert here == pytest.approx(there, abs=0.01)


COMPUTED = """PROCEDURE main()
    set_tool(60)
    MOVE TO {x: 450, y: 50, z: 350, a: 0, b: 180, c: 0}
    set_base(20)
    MOVE LINEAR TO {x: 450, y: 50, z: 350, a: 0, b: 180, c: 0}
END PROCEDURE
PROCEDURE set_tool(length: REAL)
    $tool = {x: 0, y: 0, z: length, a: 0, b: 0, c: 0}
END PROCEDURE
PROCEDURE set_base(height: REAL)
    $base = {x: 0, y: 0, z: height, a: 0, b: 0, c: 0}
END PROCEDURE
"""


@pytest.mark.parametrize("target", ["rapid", "urscript", "vplus", "inform", "krl", "tp"])
def test_a_tool_with_a_computed_component_is_set_as_a_whole(target: str) -> None:
    source = read_sources([source_from_text("cell.rpl", COMPUTED)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    made = translate_program(source, target, KUKA.name, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    again = read_sources([source_from_bytes(f.path, f.data) for f in made.files], target, Diagnostics())
    entry = made.renamed.get("main", "main")
    entry = entry_name(again.program, entry) or entry
    result = prove_programs(source.program, again.program, KUKA.name, entry="main", to_entry=entry)
    assert result.agrees, result.as_text()
