"""A move whose end the program waits for has no corner, also where it calculates something in between."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 SET a = TRANS(330,50,260,0,180,0)
 APPRO a, 60
 MOVES a
 {between}
 BREAK
 d = DISTANCE(HERE,a)
 IF d < 0.1 THEN
 SIGNAL 1
 END
.END
"""


@pytest.mark.parametrize("between", ["", "n = 3", "ok = DISTANCE(DEST,a) < 0.1", "IF n > 2 THEN\nn = 4\nEND"])
def test_the_robot_stands_there(between: str) -> None:
    text = PROGRAM.format(between=between).replace(".PROGRAM main()\n", ".PROGRAM main()\n n = 1\n")
    source = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    translation = translate_program(source, "inform", "adept_viper_s650", None, Diagnostics())
    job = next(file.data.decode() for file in translation.files if "MAIN" in file.path)
    straight = [line for line in job.splitlines() if line.startswith("MOVL")]
    assert straight and straight[-1].endswith("PL=0")
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "inform", Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and len(result.outputs) == 1
