"""Jobs that run beside the program are no entries: what the program sets at its start is not set again in them."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

VPLUS = """.PROGRAM main()
TOOL TRANS(0,0,60)
boxes = 0
REACT 1010, box
SET f = FRAME(TRANS(350,-100,120),TRANS(x+450,-100,120),TRANS(350,0,120),TRANS(350,-100,120))
MOVES f:TRANS(50,25,100,0,180,0)
BREAK
IGNORE 1010
.END
.PROGRAM box()
boxes = boxes+1
REACT 1010, box
.END
"""


def test_only_the_program_starts_the_tasks() -> None:
    read = read_sources([source_from_text("main.v2", VPLUS)], "vplus", Diagnostics())
    files = translate_program(read, "inform", "adept_viper_s650", None, Diagnostics()).files
    jobs = {one.path.rpartition("/")[2]: one.data.decode() for one in files if one.path.endswith(".JBI")}
    beside = [name for name in jobs if name.startswith("RPL_INTERRUPT_")]
    assert beside and f"PSTART JOB:{beside[0].removesuffix('.JBI')}" in jobs["MAIN.JBI"]
    assert [name for name, text in jobs.items() if "PSTART" in text] == ["MAIN.JBI"]
