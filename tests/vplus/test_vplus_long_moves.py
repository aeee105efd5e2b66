"""Moves to places whose text is longer than a line of V+: kept by a SET in front."""

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

FIXTURE = """{held: FALSE, fixed: TRUE, unit: "", user_frame: {x: 420, y: 0, z: 160, a: 0, b: 0, c: 0},
 object_frame: {x: 0, y: 0, z: 15, a: 0, b: 0, c: 0}}""".replace("\n", "")
PROGRAM = """ENTRY main
MODULE m
VAR conveyor_line: WORKOBJECT = FIXTURE
VAR lid_radius: REAL = 10
VAR lid_places: ARRAY[3] OF POSE
PROCEDURE main()
    VAR i: INT
    FOR i = 1 TO 3
        lid_places[i] = {x: 0, y: 40 * i - 80, z: 100, a: 0, b: 180, c: 0}
    END FOR
    conveyor_line.object_frame.z = 20
    i = 2
    lid_radius = 4 * lid_radius
    MOVE JOINT TO {j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0}
    MOVE LINEAR TO offset(lid_places[i], -40, 0, 0) WITH_IT
    MOVE CIRCULAR VIA offset(lid_places[i], -SIDE, SIDE, 0) TO offset(lid_places[i], 0, 40, 0) WITH_IT
    MOVE CIRCULAR VIA offset(lid_places[i], SIDE, SIDE, 0) TO offset(lid_places[i], 40, 0, 0) WITH_IT
END PROCEDURE
END MODULE
"""
PROGRAM = (
    PROGRAM.replace("FIXTURE", FIXTURE)
    .replace("SIDE", "lid_radius * 0.70710678")
    .replace("WITH_IT", "FRAME conveyor_line SPEED 100 mm/s FINE")
)


def test_an_arc_between_long_places() -> None:
    read = read_sources([source_from_text("p.rpl", PROGRAM)], "rpl", diagnostics := Diagnostics())
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    written = translate_program(read, "vplus", "kuka_kr6r900sixx", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    text = "".join(file.data.decode("ascii") for file in written.files)
    lines = text.splitlines()
    assert max(map(len, lines)) <= 120
    assert sum(line.strip().startswith("SET p") and "SHIFT" in line for line in lines) == 2, text
    assert sum(line.strip().startswith("MOVEC p") for line in lines) == 2, text
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "vplus", Diagnostics())
    result = prove_programs(read.program, back.program, "kuka_kr6r900sixx", entry="main", to_entry="main")
    assert result.agrees, result.as_text()
