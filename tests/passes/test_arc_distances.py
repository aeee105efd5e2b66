"""Actions at a place on the way of an arc, in languages that measure straight from its end or its start."""

from __future__ import annotations

import pytest
from refusing import refused

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr16_2"
# name -> reference and distance along the arc, whose start is at 0 deg and which goes on for so many degrees; where
CASES = {
    "from the start": ("start", "100", 180, 47.746),
    "from the end": ("end", "-188.496", 180, 90.0),
    "just before the end": ("end", "-10", 180, 175.225),
    "short arc": ("end", "-60", 60, 31.352),
    "more than half": ("start", "100", 270, 47.746),
    "more than half, from the end": ("end", "-100", 270, 222.254),
    "far from the end": ("end", "-450", 270, 55.141),
    "far from the start": ("start", "450", 270, 214.859),
}
PROGRAM = """VAR seen: VECTOR
VAR size: REAL = 120.0
VAR far: REAL
$base = pose {{x: 1000, y: 0, z: 450, a: 90, b: 0, c: 0}}
far = {distance}
go(size)
IF abs(seen.x - 120.0 * cos({at})) < 3.0 AND abs(seen.y - 120.0 * sin({at})) < 3.0 THEN SET do[1] TO ON
$base = $null_frame

PROCEDURE go({parameter}: REAL)
    MOVE TO pose {{x: {r}, y: 0, z: 150, a: 0, b: 180, c: 0}}
    TRIGGER AT {reference} DISTANCE {given} DO note()
    MOVE CIRCULAR VIA {via} TO {end} SPEED 60 mm/s
END PROCEDURE

PROCEDURE note()
    seen = current_position()
END PROCEDURE
"""
PLACE = "pose {{x: {r} * cos({angle}), y: {r} * sin({angle}), z: 150, a: 0, b: 180, c: 0}}"


def program(case: str, parameter: str, given: str) -> str:
    """parameter: `r` where the points of the arc are computed from it."""
    reference, distance, angle, at = CASES[case]
    words = {"r": "r" if parameter == "r" else "120.0", "parameter": parameter}
    for name, place in (("via", angle / 2), ("end", angle)):
        words[name] = PLACE.format(r=words["r"], angle=place)
    given = given.format(distance=distance)
    return PROGRAM.format(reference=reference, distance=distance, at=at, given=given, **words)


@pytest.mark.parametrize("target", ["vplus", "urscript"])
@pytest.mark.parametrize("case", CASES)
def test_the_place_is_found(case: str, target: str) -> None:
    text = program(case, "unused", "{distance} mm")
    source = read_sources([source_from_text("main.rpl", text)], "rpl", Diagnostics())
    assert len(run_program(source.program, ARM, None, "main").outputs) == 1
    found = Diagnostics()
    translation = translate_program(source, target, ARM, None, found)
    assert not found.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    result = run_program(back.program, ARM, None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and len(result.outputs) == 1


@pytest.mark.parametrize("target", ["vplus", "urscript", "inform"])
@pytest.mark.parametrize(("parameter", "given"), [("r", "{distance} mm"), ("unused", "(far) mm")])
def test_a_place_that_the_run_decides_is_refused(parameter: str, given: str, target: str) -> None:
    text = program("from the end", parameter, given)
    line = text.splitlines().index(next(one for one in text.splitlines() if "TRIGGER" in one)) + 1
    assert refused(text, "rpl", target, ARM) == [("path-event-computed-on-arc", line)]
