"""A job that runs beside the moves and looks where the robot is, with another tool than that of the moves."""

from __future__ import annotations

import re

import pytest
from inform_helpers import job

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.record import signal_names
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "motoman_gp7"
POINTS = """///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=400.000,-100.000,400.000,180.0000,0.0000,0.0000
///TOOL 2
C00001=400.000,100.000,300.000,180.0000,0.0000,0.0000
///TOOL 0
P00004=0.000,30.000,90.000,0.0000,0.0000,0.0000
"""
MAIN = """SETTOOL TL#(2) P004
MOVJ C00000 VJ=50.00 PL=0
PSTART JOB:SNAP SUB1
MOVL C00001 V=100.0 PL=0 NWAIT
TIMER T=1.00
DOUT OT#(9) ON
CWAIT
PWAIT SUB1
GETE D000 P010 (2)
GETE D001 P010 (3)
DOUT OT#(1) ON IF D000>{y}000
DOUT OT#(2) ON IF D001>{z}000"""
SNAP = "WAIT OT#(9)=ON\nGETS PX010 $PX001"


# More than so much of y and z (mm)? The tool tip goes from (-130, 310) to (100, 300), the flange is 30 and 90 mm away.
LIMITS = {(20, 360): {"digital_out:2"}, (-80, 420): {"digital_out:1"}}


def switched_on(result: RunResult) -> set[str]:
    """The outputs that the run has set, each as `digital_out:3`."""
    found: set[str] = set()
    for event in result.trace:
        if event.kind == "output":
            kind, index, last, _ = event.port or (None, None, None, None)
            names = [str(name) for name in (event.data.get("signal"), *event.names) if name]
            found |= {key for key in signal_names(kind, names, index, last) if re.fullmatch(r"digital_out:\d+", key)}
    return found


@pytest.mark.parametrize("target", ["rapid", "vplus", "inform", "rpl"])
@pytest.mark.parametrize(("limits", "met"), LIMITS.items())
def test_a_place_seen_beside_the_moves(target: str, limits: tuple[int, int], met: set[str]) -> None:
    """M: the tool is the one of the last point that the job itself has, else the first one."""
    texts = {
        "TEST.JBI": job(MAIN.format(y=limits[0], z=limits[1]), POINTS),
        "SNAP.JBI": job(SNAP, "///TOOL 0", "SNAP").replace("///GROUP1 RB1\n", ""),
    }
    read = read_sources([source_from_text(name, text) for name, text in texts.items()], "inform", Diagnostics())
    diagnostics = Diagnostics()
    done = translate_program(read, target, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [one.as_text() for one in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    ours = run_program(read.program, ARM, None, "TEST")
    theirs = run_program(back.program, ARM, None, done.renamed.get("TEST", "TEST"))
    assert theirs.status == ours.status == "finished", theirs.fault
    assert switched_on(theirs) == switched_on(ours)
    assert switched_on(ours) == met | {"digital_out:9"}


def test_a_background_program_sets_nothing_of_the_task_that_moves() -> None:
    texts = {"TEST.JBI": job(MAIN.format(y=0, z=0), POINTS), "SNAP.JBI": job(SNAP, "///TOOL 0", "SNAP")}
    read = read_sources([source_from_text(name, text) for name, text in texts.items()], "inform", Diagnostics())
    files = {one.path: one.data.decode() for one in translate_program(read, "krl", ARM, None, Diagnostics()).files}
    assert "BAS(#INITMOV,0)" in files["TEST.src"] and "INITMOV" not in files["SNAP.src"]
    assert "$" not in files["SNAP.src"].replace("$OUT", "").replace("$NULLFRAME", "")
    assert "$TOOL_C" in "".join(files.values()) and "$BASE_C" in "".join(files.values())  # M: those of the main run
