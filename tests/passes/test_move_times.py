"""The least time of a move (V+ DURATION) in languages that have no such setting."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 MOVES a
 BREAK
 TIMER 1 = 0
 {setting}
 MOVES b
 BREAK
 t = TIMER(1)
 IF (t > 1.98) AND (t < 2.6) THEN
 SIGNAL 1
 END
 TIMER 1 = 0
 MOVES a
 BREAK
 IF TIMER(1) < 1 THEN
 SIGNAL 2
 END
.END
.LOCATIONS
a 330 50 260 0 180 0
b 330 150 260 0 180 0
.END
"""
ARM = "adept_viper_s650"


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript"])
@pytest.mark.parametrize(
    "setting", ["DURATION 2", "DURATION time", "SPEED 200 MMPS\nDURATION 2", "SPEED 50 MMPS\nDURATION 1"]
)
def test_a_move_takes_its_time(setting: str, target: str) -> None:
    text = PROGRAM.format(setting=setting).replace(".PROGRAM main()\n", ".PROGRAM main()\n time = 2\n")
    source = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, ARM, None, found)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    runs = [
        run_program(source.program, ARM, None, "main"),
        run_program(back.program, ARM, None, translation.renamed.get("main", "main")),
    ]
    assert [run.status for run in runs] == ["finished"] * 2
    assert [len(run.outputs) for run in runs] == [2, 2]
    assert ("move-time-by-speed" in [item.code.name for item in found]) == (
        target in ("krl", "inform") or "MMPS" in setting
    )
