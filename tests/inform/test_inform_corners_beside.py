"""Corners next to moves that the program goes on beside, or that a search watches, in other languages: they run there,
and what is done beside a move is done at the same moments."""

import pytest
from inform_helpers import job

from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.project import read_sources
from rpl.proof.wiring import with_signal_names
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

POINTS = """
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=450.000,0.000,350.000,180.0000,0.0000,0.0000
C00001=450.000,100.000,350.000,180.0000,0.0000,0.0000
C00002=450.000,200.000,300.000,180.0000,0.0000,0.0000
"""
TARGETS = ("krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl")


def both(body: str, target: str, *others: str) -> tuple[RunResult, RunResult, Diagnostics]:
    """How the job runs, and how its translation does; what the translation told."""
    texts = [job(body, POINTS), *others]
    read = read_sources([source_from_text(f"J{n}.JBI", text) for n, text in enumerate(texts)], "inform", Diagnostics())
    arm, told = load_robot("motoman_gp7"), Diagnostics()
    translation = translate_program(read, target, "motoman_gp7", None, told)
    sources = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = with_signal_names(read_sources(sources, target, Diagnostics()).program, translation.program)
    begins = back.entry or translation.renamed.get("TEST", "TEST")
    runs = [run_program(p, arm, None, e, 60.0, controller="plain") for p, e in ((read.program, "TEST"), (back, begins))]
    return runs[0], runs[1], told


def changes(result: RunResult) -> list[tuple[float, object]]:
    return [(time, value) for time, _, value in result.outputs]


@pytest.mark.parametrize("target", ["rapid", "vplus", "inform", "rpl"])  # the others wait for the move
@pytest.mark.parametrize("size", ["", " PL=2", " PL=0", " CR=10.0"])
def test_what_is_done_beside_a_move_with_a_corner(target: str, size: str) -> None:
    body = f"""
MOVL C00000 V=200.0 PL=0
MOVL C00001 V=200.0{size} NWAIT
DOUT OT#(3) ON
TIMER T=0.10
DOUT OT#(3) OFF
MOVL C00002 V=100.0 PL=0
"""
    source, there, _ = both(body, target)
    assert (source.status, there.status) == ("finished", "finished")
    for (at, value), (then, same) in zip(changes(source), changes(there), strict=True):
        assert (then, same) == (pytest.approx(at, abs=0.1), value)


SEARCH = "MOVL C00002 V=100.0 PL=0 UNTIL IN#(2)=ON\n"
BESIDE = "MOVL C00002 V=100.0 PL=0 NWAIT\nDOUT OT#(3) ON\nCWAIT\n"
START, CORNER = "MOVL C00000 V=200.0 PL=0\n", "MOVL C00001 V=200.0 PL=2\n"


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize(
    "body",
    [
        START + CORNER + SEARCH,
        START + CORNER + "DOUT OT#(3) ON\n" + SEARCH,
        START + "CLEAR B001 1\nIFTHENEXP B001=0\n" + CORNER + "ENDIF\n" + SEARCH,
        START
        + "CLEAR B001 1\n"
        + f"WHILEEXP B001<2\nIFTHENEXP B001=1\n{SEARCH}ELSE\n{CORNER}ENDIF\nINC B001\nENDWHILE\n".replace("\n\n", "\n"),
        START + CORNER + BESIDE,
        START + CORNER + "CALL JOB:SUB\n",
    ],
)
def test_a_corner_before_a_search_or_a_move_beside(body: str, target: str) -> None:
    """A task of its own drives such a move in URScript: the robot stops at the corner, which is told."""
    source, there, told = both(body, target, job(SEARCH, POINTS, "SUB"))
    assert (source.status, there.status) == ("finished", "finished")
    stops = [item.origin.line for item in told if item.code.name == "corner-stops-before-task"]
    assert len(stops) == (1 if target == "urscript" and BESIDE not in body else 0)


def test_a_stop_before_a_search_needs_nothing() -> None:
    _, there, told = both(START + SEARCH + CORNER + START, "urscript")
    assert there.status == "finished"
    assert not any(item.code.name == "corner-stops-before-task" for item in told)
