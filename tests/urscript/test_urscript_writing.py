"""URScript as a target: statements of other languages in its words, numbers that read back, guarded stops, proofs."""

from __future__ import annotations

import math
import re

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes import rigid
from rpl.project import ReadProgram, read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from rpl.writing.target import WriteContext

spelling = pytest.importorskip("rpl.postprocessors.urscript.spelling")


def read(text: str, name: str = "main.rpl") -> ReadProgram:
    diagnostics = Diagnostics()
    program = read_sources([source_from_text(name, text)], "rpl", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return program


def written(text: str, robot: str | None = None) -> tuple[str, Diagnostics]:
    """The script of an RPL program and what was reported."""
    diagnostics = Diagnostics()
    translation = translate_program(read(text), "urscript", robot, None, diagnostics)
    (file,) = translation.files
    return file.data.decode("ascii"), diagnostics


def body(lines: str, declarations: str = "", robot: str | None = None) -> list[str]:
    """The lines that a program's statements become, without data and helpers."""
    text, _ = written(f"{declarations}\nPROCEDURE main()\n    -- here\n{lines}\nEND PROCEDURE\n", robot)
    inside = text.split("# here\n")[-1].rstrip().splitlines()[:-1]
    return [line.removeprefix("  ") for line in inside if line.strip()]


DATA = """
VAR i: INT = 0
VAR x: REAL = 0
VAR on: BOOL = FALSE
VAR t: STRING = ""
VAR spot: POSE = {x: 100, y: 0, z: 50, a: 0, b: 0, c: 0}
VAR home: JOINTS = {j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0}
VAR row: ARRAY[3] OF INT = {1, 2, 3}
"""


@pytest.mark.parametrize(
    ("source", "target"),
    [
        ("i = i + 1", ["i = i + 1"]),
        ("x = 0.5", ["x = 0.5"]),
        ("x = sin(x)", ["x = sin(d2r(x))"]),
        ("x = atan2(x, 2.0)", ["x = r2d(atan2(x, 2.0))"]),
        ("x = abs(x)", ["x = norm(x)"]),
        ("i = i DIV 4", ["i = rpl_div(i, 4)"]),
        ("i = i MOD 4", ["i = rpl_mod(i, 4)"]),
        ("on = (i = 1) OR (i = 2)", ["on = i == 1 or i == 2"]),
        ("on = NOT on AND (i > 2)", ["on = not on and i > 2"]),
        ("row[1] = row[i]", ["row[0] = row[i - 1]"]),
        ("spot.x = 120", ["spot[0] = 0.12"]),
        ("spot.y = x", ["spot[1] = x / 1000.0"]),
        ("x = spot.z", ["x = rpl_decimals(spot[2] * 1000.0, 100000.0)"]),
        ("spot.a = 90", ["spot = rpl_turned(spot, 2, 90)"]),
        ("home.j2 = -45", ["home[1] = -0.785398163397"]),
        ("WAIT 0.5 s", ["sleep(0.5)"]),
        ("WAIT UNTIL di[3]", ["while not get_standard_digital_in(2):", "  sync()", "end"]),
        ("WAIT UNTIL NOT di[3]", ["while get_standard_digital_in(2):", "  sync()", "end"]),
        ("SET do[8] TO TRUE", ["set_standard_digital_out(7, True)"]),
        ("SET do[9] TO i = 1", ["set_configurable_digital_out(0, i == 1)"]),
        ("SET do[18] TO FALSE", ["set_tool_digital_out(1, False)"]),
        ("x = ai[3]", ["x = get_tool_analog_in(0)"]),
        ("SET do[i] TO TRUE", ["rpl_set_digital_out(i, True)"]),
        ('MESSAGE "ready"', ['textmsg("ready")']),
        ("HALT", ["halt"]),
    ],
)
def test_statements_in_urscript(source: str, target: list[str]) -> None:
    assert body(f"    {source}", DATA) == target


@pytest.mark.parametrize(
    ("source", "target"),
    [
        ("MOVE TO home", ["movej(home, a=6.9813, v=2.0944)"]),
        ("MOVE LINEAR TO spot SPEED 200 mm/s FINE", ["movel(spot, a=2, v=0.2)"]),
        ("MOVE LINEAR TO spot SPEED 200 mm/s BLEND 15 mm", ["movel(spot, a=2, v=0.2, r=0.015)"]),
    ],
)
def test_moves_in_urscript(source: str, target: list[str]) -> None:
    assert body(f"    {source}", DATA, "ur10e") == target


def test_loops_in_urscript() -> None:
    lines = body("    FOR i = 1 TO 3\n        x = x + 1\n    END FOR", DATA)
    assert lines == ["i = 1", "while i <= 3:", "  x = x + 1", "  i = i + 1", "end"]


ROTATIONS = [(0, 0, 0), (180, 0, 180), (90, 0, 0), (0, 90, 0), (10, -20, 30), (180, 0, 0), (0, 0, 180), (1e-7, 0, 0)]


@pytest.mark.parametrize("angles", ROTATIONS)
def test_rotation_vectors_turn_like_their_angles(angles: tuple[float, float, float]) -> None:
    wanted = rigid.rotation_of_zyx(*map(float, angles))
    vector = spelling.rotation_vector(wanted)
    turn = math.sqrt(sum(part * part for part in vector))
    sine = math.sin(turn / 2) / turn if turn else 0.5
    again = rigid.Rotation((math.cos(turn / 2), *(part * sine for part in vector)))
    dot = abs(sum(p * q for p, q in zip(again.quaternion, wanted.quaternion, strict=True)))
    assert dot == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("value", [1.0, 0.001, 1e-5, 123.456, -0.3, 1e-12, 999999.0])
def test_lengths_read_back_and_never_become_zero(value: float) -> None:
    again = float(spelling.metres(value)) * 1000.0
    assert again != 0
    assert again == pytest.approx(value, abs=5e-7, rel=1e-2 if abs(value) < 1e-6 else 1e-9)


def test_texts_are_ascii_without_quotes() -> None:
    text, reports = written('PROCEDURE main()\n    MESSAGE "Größe \\"A\\""\nEND PROCEDURE\n')
    assert "textmsg(\"Grosse 'A'\")" in text
    assert [item.code.name for item in reports if item.severity == Severity.WARNING] == ["urscript-text"]


def test_what_cannot_be_said_stops_the_program() -> None:
    text, reports = written("PROCEDURE main()\n    SET do[147] TO TRUE\nEND PROCEDURE\n")
    assert re.search(r"# SET do\[147\] TO TRUE\n\s+halt\n", text)
    assert [item.code.name for item in reports.of(Severity.LOSS)] == ["urscript-guarded-stop"]


SWAP = """
VAR one: INT = 3
VAR other: INT = 5
PROCEDURE main()
    swap(one, other)
    SET do[1] TO one = 5
    SET do[2] TO other = 3
END PROCEDURE
PROCEDURE swap(REFERENCE a: INT, REFERENCE b: INT)
    VAR kept: INT
    kept = a
    a = b
    b = kept
END PROCEDURE
"""


def test_reference_parameters_come_back_by_variables() -> None:
    diagnostics, program = Diagnostics(), read(SWAP)
    translation = translate_program(program, "urscript", None, None, diagnostics)
    (file,) = translation.files
    assert not diagnostics.has_losses
    back = read_sources([source_from_bytes(file.path, file.data)], "urscript", Diagnostics())
    assert prove_programs(program.program, back.program).agrees


def test_records_of_a_routine_keep_the_ledger_whole() -> None:
    """Writing marks every node: a program made by hand, with a comment-only statement, passes the ledger."""
    routine = ir.Routine("main", body=(ir.Nothing(), ir.Halt("exit")))
    program = ir.Program((ir.Module("main", "urscript", routines=(routine,)),))
    (file,) = registry.target("urscript").write(program, WriteContext(Diagnostics()))
    assert file.data.decode() == "def main():\n  halt\nend\n"
