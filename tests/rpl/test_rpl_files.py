"""Programs of several files: what a name means does not depend on the file or the order in which it is declared."""

from __future__ import annotations

import re

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text
from rpl.writing.target import WriteContext

ROBOT = "kuka_kr6r900sixx"
FRAMES = """
GLOBAL FRAME table = {x: 420, y: 0, z: 180}
GLOBAL FRAME fixture = {x: 60, y: 40, z: 20, a: 90, b: 0, c: 0} ON table
GLOBAL FRAME bore = {x: 50, y: -20, z: 30, a: 0, b: 180, c: 0} ON fixture
"""
BACKWARDS = "\n".join(reversed(FRAMES.strip().splitlines()))
HIDDEN = FRAMES.replace("GLOBAL FRAME table", "FRAME table").replace("GLOBAL FRAME fixture", "FRAME fixture")

# What one module declares, what `main` of another one says, and the messages that come of it.
CASES = {
    "hanging frame": (FRAMES, "p = bore\nMESSAGE text(p)", ["500 90 230"]),
    "declared before what it hangs on": (BACKWARDS, "MESSAGE text(bore)", ["500 90 230"]),
    "what it hangs on is not seen here": (HIDDEN, "MESSAGE text(bore)", ["500 90 230"]),
    "another variable has its name here": (FRAMES, "VAR table: INT = 7\nMESSAGE text(bore)", ["500 90 230"]),
    "own variable of the frame's name": (
        FRAMES,
        "VAR bore: POSE = {x: 1, y: 2, z: 3}\nMESSAGE text(bore)",
        ["1 2 3"],
    ),
    "what it hangs on moves": (FRAMES, "fixture.z = 25\ntable.x = 400\nMESSAGE text(bore)", ["480 90 235"]),
    "the offset is set": (FRAMES, "bore = {x: 1, y: 2, z: 3}\nMESSAGE text(bore)", ["478 41 203"]),
    "first value": (FRAMES + "\nGLOBAL VAR above: POSE = bore", "MESSAGE text(above)", ["500 90 230"]),
    "hangs on a place of a record": (
        "GLOBAL RECORD part (at: POSE)\nGLOBAL VAR parts: ARRAY[2] OF part\nGLOBAL VAR k: INT = 2\n"
        "GLOBAL FRAME hole = {x: 5, y: 0, z: 0} ON parts[k].at",
        "parts[1].at = {x: 10, y: 20, z: 30}\nparts[2].at = {x: 40, y: 50, z: 60}\nMESSAGE text(hole)\nk = 1\n"
        "MESSAGE text(hole)",
        ["45 50 60", "15 20 30"],
    ),
    "constant": ("GLOBAL CONST n: INT = 3\nGLOBAL VAR list: ARRAY[n] OF INT", "MESSAGE length(list)", ["3"]),
    "enumeration": (
        "GLOBAL ENUM state (idle, busy)\nGLOBAL VAR now: state",
        "now = #busy\nSWITCH now\nCASE #idle\nMESSAGE 0\nCASE #busy\nMESSAGE 1\nEND SWITCH",
        ["1"],
    ),
    "type by another name": (
        "GLOBAL ALIAS place: POSE",
        "VAR q: place\nq = {x: 1, y: 2, z: 3}\nMESSAGE q.y",
        ["2"],
    ),
    "gripper": ("GRIPPER hand = do[7]", "CLOSE hand\nMESSAGE do[7]", ["TRUE"]),
    "signal as argument": (
        "GLOBAL SIGNAL lamp = do[9]\nGLOBAL PROCEDURE lit(s: SIGNAL digital_out)\nSET s TO ON\nEND PROCEDURE",
        "lit(lamp)\nMESSAGE do[9]",
        ["TRUE"],
    ),
    "tool": (
        "GLOBAL CONST probe: POSE = {x: 0, y: 0, z: 100}",
        "$tool = probe\nMESSAGE $tool.z",
        ["100"],
    ),
}


def main_of(body: str) -> str:
    return f"""
MODULE cell
    PROCEDURE main()
        VAR p: POSE
        {body}
    END PROCEDURE

    FUNCTION text(READONLY q: POSE): STRING
        RETURN number_text(q.x, 0) & " " & number_text(q.y, 0) & " " & number_text(q.z, 0)
    END FUNCTION
END MODULE
"""


def body_of(body: str) -> str:
    """`main` with its declarations in front."""
    lines = body.splitlines()
    return "\n".join(sorted(lines, key=lambda line: not line.startswith("VAR ")))


def _without_turn(text: str) -> str:
    """Poses are written here without the angles that are 0."""
    return re.sub(r"(z: -?\d+)\}", r"\1, a: 0, b: 0, c: 0}", text)


def read(*texts: str) -> tuple[ir.Program, list[str]]:
    diagnostics = Diagnostics()
    sources = [source_from_text(f"file{at}.rpl", _without_turn(text)) for at, text in enumerate(texts)]
    program = read_sources(sources, "rpl", diagnostics).program
    return program, [item.code.name for item in diagnostics]


def messages(program: ir.Program) -> list[str]:
    result = run_program(program, ROBOT, None, "main", 10.0)
    assert result.status == "finished", result.fault
    return [str(event.data["text"]) for event in result.trace if event.kind == "message"]


@pytest.mark.parametrize("name", CASES)
def test_files_and_their_order_do_not_matter(name: str) -> None:
    declared, body, expected = CASES[name]
    there, here = f"MODULE places\n{declared}\nEND MODULE\n", main_of(body_of(body))
    for texts in [(there + here,), (here + there,), (there, here), (here, there)]:
        program, codes = read(*texts)
        assert codes == []
        assert messages(program) == expected
    written = registry.target("rpl").write(program, WriteContext(Diagnostics()))
    again, codes = read(*(file.data.decode() for file in written))
    assert codes == []
    assert messages(again) == expected


def test_a_file_without_modules() -> None:
    assert messages(read(FRAMES, main_of("MESSAGE text(bore)"))[0]) == ["500 90 230"]


def test_frames_of_one_name_are_told_apart() -> None:
    places = "MODULE a\nFRAME base = {x: 100, y: 0, z: 0}\nFRAME hole = {x: 1, y: 0, z: 0} ON base\n{}END MODULE\n"
    telling = "FUNCTION at_a(): POSE\nRETURN hole\nEND FUNCTION\n"
    other = "MODULE b\nGLOBAL VAR hole: POSE = {x: 5, y: 5, z: 5}\nEND MODULE\n"
    body = "MESSAGE text(hole)\np = at_a()\nMESSAGE text(p)"
    assert messages(read(places.replace("{}", telling) + other, main_of(body))[0]) == ["5 5 5", "101 0 0"]


def test_a_frame_of_a_routine_is_its_own() -> None:
    other = "PROCEDURE other()\nFRAME f = {x: 1, y: 0, z: 0} ON t\nMESSAGE text(f)\nEND PROCEDURE\n"
    text = main_of("FRAME f = {x: 2, y: 0, z: 0}\nother()\nMESSAGE text(f)")
    text = text.replace("END MODULE", f"{other}FRAME t = {{x: 100, y: 0, z: 0}}\nEND MODULE")
    assert messages(read(text)[0]) == ["101 0 0", "2 0 0"]


@pytest.mark.parametrize(
    ("frames", "body", "code"),
    [
        (
            "FRAME f = {x: 1, y: 0, z: 0} ON g\nFRAME g = {x: 1, y: 0, z: 0} ON f\n",
            "p = f",
            "frame-on-itself",
        ),
        ("FRAME f = {x: 1, y: 0, z: 0} ON f\n", "p = f", "frame-on-itself"),
        (
            "FRAME t = {x: 1, y: 0, z: 0}\nFRAME f = {x: 1, y: 0, z: 0} ON t\n"
            "PROCEDURE moved(REFERENCE q: POSE)\nq.x = 5\nEND PROCEDURE\n",
            "moved(f)",
            "hanging-frame-by-reference",
        ),
    ],
)
def test_what_is_reported(frames: str, body: str, code: str) -> None:
    assert read(main_of(body).replace("END MODULE", f"{frames}END MODULE"))[1] == [code]
