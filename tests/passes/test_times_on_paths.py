"""Actions a time before or behind the end of a move, where the speed or the way is known at run only."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "fanuc_lrmate200id"
MAIN = """/PROG  MAIN
/MN
   1:  UFRAME_NUM=0 ;
   2:  UTOOL_NUM=0 ;
   3:  R[16]=100 ;
   4:  R[24]=0 ;
   5:J P[1] 100% FINE ;
   6:  DO[1]=ON ;
{lines}
/POS
P[1]{{
   GP1:
	UF : 0, UT : 0,	CONFIG : 'N U T, 0, 0, 0',
	X = 420.000 mm,	Y = 0.000 mm,	Z = 0.000 mm,
	W = 180.000 deg,	P = 0.000 deg,	R = 0.000 deg
}};
P[2]{{
   GP1:
	UF : 0, UT : 0,	CONFIG : 'N U T, 0, 0, 0',
	X = 420.000 mm,	Y = 100.000 mm,	Z = 0.000 mm,
	W = 180.000 deg,	P = 0.000 deg,	R = 0.000 deg
}};
/END
"""


def ran(lines: str, target: str) -> RunResult:
    numbered = "\n".join(f"   7:{line} ;" for line in lines.split("\n"))
    read = read_sources([source_from_text("MAIN.LS", MAIN.format(lines=numbered))], "tp", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, ARM, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    start = entry_name(read.program, "MAIN") or ""
    return run_program(
        back.program, ARM, None, back.program.entry or written.renamed.get(start, start), controller="plain"
    )


def moments(lines: str, target: str) -> dict[int, float]:
    """When each output was switched on, in s, counted from when the robot stood at P[1]."""
    found: dict[int, float] = {}
    for event in ran(lines, target).trace:
        if event.kind == "output" and event.port is not None and event.data.get("value"):
            found.setdefault(int(event.port[1] or 0), event.t)
    return {number: moment - found[1] for number, moment in found.items()}


@pytest.mark.parametrize("target", ["inform", "krl", "urscript", "vplus"])
@pytest.mark.parametrize("speed", ["R[16]mm/sec", "100mm/sec"])
def test_behind_the_end_is_not_before_it(speed: str, target: str) -> None:
    lines = f"  OVERRIDE=50%\nL P[2] {speed} FINE TA .30sec,DO[2]=ON\n  DO[3]=ON\n  WAIT    .50(sec)"
    found = moments(lines, target)
    assert found[3] > 1.99
    # KRL's controller shifts no action beyond the end of its move (Expert Programming, 8.1), which is told.
    assert found[2] - found[3] == pytest.approx(0.0 if target == "krl" else 0.3, abs=0.05)


def test_a_time_before_the_end_of_a_move_of_the_axes() -> None:
    """In KRL; INFORM and URScript refuse actions on the way of joint moves."""
    found = moments("J P[2] 10% FINE TB .20sec,DO[2]=ON\n  DO[3]=ON", "krl")
    assert found[3] - found[2] == pytest.approx(0.2, abs=0.05)
