"""The tool with which a job sees the arm that a job beside has called: its own, as no move came before on its way."""

from __future__ import annotations

import pytest
from inform_helpers import job

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text

HOME = "///TOOL 2\n///POSTYPE ROBOT\n///RECTAN\n///RCONF 1,0,0,0,0,0\nC00000=400,-100,400,180,0,0\n"
POINT = "///TOOL 2\n///POSTYPE BASE\n///RECTAN\nP00004=0,30,90,0,0,0\n"
MAIN = """SETTOOL TL#(2) P004
MOVJ C00000 VJ=50.00 PL=0
PSTART JOB:WATCH SUB1
PWAIT SUB1
GETE D001 P010 (3)
DOUT OT#(1) ON IF D001>{low}000 ANDEXP D001<{high}000"""


@pytest.mark.parametrize("names", [("TEST", "WATCH", "SNAP"), ("SNAP", "WATCH", "TEST"), ("WATCH", "SNAP", "TEST")])
def test_a_job_called_beside_the_moves(names: tuple[str, ...]) -> None:
    """M: with the tool of its own points; whichever job of the project is read first."""
    texts = {
        "TEST": job(MAIN.format(low=399, high=401), HOME + POINT),
        "WATCH": job("CALL JOB:SNAP", "", "WATCH").replace("///GROUP1 RB1\n", ""),
        "SNAP": job("GETS PX010 $PX001", POINT, "SNAP").replace("///GROUP1 RB1\n", ""),
    }
    read = read_sources([source_from_text(f"{name}.JBI", texts[name]) for name in names], "inform", Diagnostics())
    result = run_program(read.program, "motoman_gp7", None, "TEST")
    assert result.status == "finished", result.fault
    assert [value for _, _, value in result.outputs] == [True]
