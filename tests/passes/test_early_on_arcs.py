"""Actions a time before the end of an arc, in languages that look how far the tool is straight from its end."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr16_2"
# name -> angle of the arc in deg, radius in mm, speed in mm/s, time before the end in s, place of the action in deg
CASES = {
    "middle of half a circle": (180, 60, 60, "1.5708", 90.0),
    "most of half a circle": (180, 60, 60, "2.4", 42.5),
    "quarter": (90, 60, 40, "1.0", 51.8),
    "begins before the move": (90, 60, 60, "20", 0.0),
    "braking only": (180, 60, 240, "0.1", 170.0),
}
PROGRAM = """VAR seen: VECTOR
VAR size: REAL = {r}
VAR fast: REAL = {speed}
$base = pose {{x: 1000, y: 0, z: 450, a: 90, b: 0, c: 0}}
go(size)
IF abs(seen.x - {r} * cos({at})) < {near} AND abs(seen.y - {r} * sin({at})) < {near} THEN SET do[1] TO ON
$base = $null_frame
{change}
PROCEDURE go({parameter}: REAL)
    MOVE TO pose {{x: {start}, y: 0, z: 150, a: 0, b: 180, c: 0}}
    TRIGGER AT end DELAY -{time} s DO note()
    MOVE CIRCULAR VIA {via} TO {end} SPEED {given} mm/s
END PROCEDURE

PROCEDURE note()
    seen = current_position()
END PROCEDURE
"""
PLACE = "pose {{x: {r} * cos({angle}), y: {r} * sin({angle}), z: 150, a: 0, b: 180, c: 0}}"


@pytest.mark.parametrize("target", ["vplus", "urscript", "inform"])
@pytest.mark.parametrize("computed", ["", "places", "speed"])
@pytest.mark.parametrize("case", CASES)
def test_the_action_comes_in_time(case: str, computed: str, target: str) -> None:
    angle, radius, speed, time, at = CASES[case]
    size = "r" if computed == "places" else f"{radius}.0"
    words: dict[str, object] = {"r": radius, "speed": speed, "time": time, "at": at, "start": size, "near": 4.0}
    words |= {"parameter": "r" if computed == "places" else "unused", "change": ""}
    words["given"] = "(fast)" if computed == "speed" else str(speed)
    if computed == "speed":
        words["change"] = "fast = 1.0"
    for name, place in (("via", angle / 2), ("end", angle)):
        words[name] = PLACE.format(r=size, angle=place)
    source = read_sources([source_from_text("main.rpl", PROGRAM.format(**words))], "rpl", Diagnostics())
    if target != "urscript" and "braking" in case:
        pytest.skip("the arm brakes otherwise there, so that time is at another place")
    assert len(run_program(source.program, ARM, None, "main").outputs) == 1
    found = Diagnostics()
    translation = translate_program(source, target, ARM, None, found)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    result = run_program(back.program, ARM, None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and len(result.outputs) == 1, [item.as_text() for item in found]
