"""Moves from here in a loop (V+ DRIVE): the move of the pass before has ended when the place is asked for."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 AUTO j[6], k
 MOVE #PPOINT(0,-90,180,0,60,0)
 FOR k = 1 TO 3
 DRIVE k, 2, 100
 DRIVE 6, -1, 100
 END
 BREAK
 DECOMPOSE j[1] = #PHERE
 IF (ABS(j[1]-2) < 0.01) AND (ABS(j[2]+88) < 0.01) AND (ABS(j[3]-182) < 0.01) AND (ABS(j[6]+3) < 0.01) THEN
 SIGNAL 1
 END
.END
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus", "rpl"])
def test_every_pass_starts_from_the_end_of_the_one_before(target: str) -> None:
    source = read_sources([source_from_text("main.v2", PROGRAM)], "vplus", Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, "adept_viper_s650", None, found)
    assert not [item.as_text() for item in found.of(Severity.LOSS)]
    files = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(files, target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and len(result.outputs) == 1
