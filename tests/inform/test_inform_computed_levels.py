"""A positioning level in a variable (PL=B000) in languages that have no levels."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

JOB = """/JOB
//NAME LEVELS
//POS
///NPOS 0,0,0,3,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 0,0,0,0,0,0,0,0
P0000=500.000,-200.000,300.000,180.0000,0.0000,0.0000
P0001=500.000,200.000,300.000,180.0000,0.0000,0.0000
P0002=500.000,200.000,100.000,180.0000,0.0000,0.0000
//INST
///DATE 2024/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
SET B000 0
WHILE B000<5
MOVL P000 V=500.0 PL=0
MOVL P001 V=500.0 PL=B000
MOVL P002 V=500.0 PL=0
ADD B000 2
ENDWHILE
END
"""
ARM = "motoman_gp7"


def times(program: ir.Program) -> list[float]:
    result = run_program(program, ARM, controller="plain")
    assert result.status == "finished", result.fault
    return [float(str(event.data["duration"])) for event in result.trace if event.kind == "move"]


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript"])
def test_the_corner_is_as_large_as_the_level_says(target: str) -> None:
    """A stop, then corners of 25 and 100 mm."""
    found = Diagnostics()
    source = read_sources([source_from_text("LEVELS.JBI", JOB)], "inform", Diagnostics())
    own = times(source.program)
    translation = translate_program(source, target, ARM, None, found)
    files = [source_from_bytes(one.path, one.data) for one in translation.files]
    theirs = times(read_sources(files, target, Diagnostics()).program)
    slower = 500.0 / 2300.0 - 500.0 / 5000.0 if target == "krl" else 0.0  # inline forms begin and end at 2.3 m/s2
    room = 0.06 if slower else 0.02  # in a corner the ramps of two moves overlap
    assert theirs[1:] == pytest.approx([one + slower for one in own[1:]], abs=room)
    assert len({own[1], own[4], own[7]}) == 3
    assert "level-at-run-as-distance" in [item.code.name for item in found]
    assert not found.of(Severity.LOSS)
