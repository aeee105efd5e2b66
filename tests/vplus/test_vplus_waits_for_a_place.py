"""A wait for a place on the way (`WAIT DISTANCE(HERE, DEST) < 50`) in languages that poll for it beside the move."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 MOVES a
 BREAK
 SPEED 50 MMPS
 MOVES b
 WAIT DISTANCE(HERE,DEST) < 50
 SIGNAL 1
 d = DISTANCE(HERE,b)
 BREAK
 IF (d > 40) AND (d < 50.01) THEN
 SIGNAL 2
 END
.END
.LOCATIONS
a 330 -50 260 0 180 0
b 330 50 260 0 180 0
.END
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "inform", "vplus", "rpl"])
def test_the_place_is_seen_on_the_way(target: str) -> None:
    source = read_sources([source_from_text("main.v2", PROGRAM)], "vplus", Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, "adept_viper_s650", None, found)
    assert not [item.as_text() for item in found.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and sum(bool(value) for _, _, value in result.outputs) >= 2
