"""A shift (SFTON) beyond the job that began it; what is told of tools, frames and searches."""

import pytest
from inform_helpers import job, outputs, read, run

POINTS = """
///TOOL 0
///POSTYPE BASE
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=500.000,0.000,400.000,180.0000,0.0000,0.0000
C00001=500.000,100.000,400.000,180.0000,0.0000,0.0000
P00001=0.000,0.000,50.000,0.0000,0.0000,0.0000
"""
HEIGHT = """
MOVJ C00000 VJ=50.00 PL=0
GETS PX002 $PX001
GETE D000 P002 (3)
DOUT OT#(1) ON IF D000=450000
DOUT OT#(2) ON IF D000=400000
"""
ON, OFF = [("OT#(1)", True)], [("OT#(2)", True)]
BEGIN = "GETARG LB000 IARG#(1)\nJUMP *OUT IF LB000=0\nSFTON P001\n*OUT"


@pytest.mark.parametrize(
    ("caller", "called", "shown"),
    [
        ("CALL JOB:SUB", "SFTON P001", ON),
        ("CALL JOB:SUB", "SFTON P001\nRET", ON),
        ("SFTON P001\nCALL JOB:SUB", "SFTOF", OFF),
        ("SFTON P001\nCALL JOB:SUB", "NOP", ON),
        ("CALL JOB:SUB ARGF 1", BEGIN, ON),
        ("CALL JOB:SUB ARGF 0", BEGIN, OFF),
        ("SET B001 1\nCALL JOB:SUB IF B001=1", "SFTON P001", ON),
        ("SET B001 0\nCALL JOB:SUB IF B001=1", "SFTON P001", OFF),
        ("CALL JOB:SUB\nSFTOF", "SFTON P001", OFF),
        ("SET B000 0\nWHILEEXP B000<2\nINC B000\nCALL JOB:SUB\nENDWHILE", "SFTON P001", ON),
    ],
)
def test_a_shift_lasts_beyond_the_job_that_began_it(caller: str, called: str, shown: list[tuple[str, bool]]) -> None:
    """M: until SFTOF."""
    result = run(job(f"{caller}\n{HEIGHT}", POINTS), job(called, POINTS, "SUB"))
    assert (result.status, outputs(result)) == ("finished", shown)


def test_a_shift_passes_through_jobs_in_jobs_and_jumps_to_jobs() -> None:
    inner, outer = job("SFTON P001", POINTS, "INNER"), job("CALL JOB:INNER", POINTS, "OUTER")
    assert outputs(run(job(f"CALL JOB:OUTER\n{HEIGHT}", POINTS), outer, inner)) == ON
    jumping = job("JUMP JOB:INNER", POINTS, "OUTER")
    assert outputs(run(job(f"CALL JOB:OUTER\n{HEIGHT}", POINTS), jumping, inner)) == ON


def told(body: str, name: str) -> list[str]:
    return [item.message for item in read(job(body, POINTS.replace("TOOL 0", "TOOL 1")))[1] if item.code.name == name]


def test_tools_that_the_project_sets_are_not_missing() -> None:
    move = "MOVL C00000 V=100.0"
    assert told(f"SETTOOL TL#(1) P001\n{move}", "inform-not-given") == []
    assert told(move, "inform-not-given") == [
        "tool TL#(1) is set at the controller, not in a job; taken as identity here"
    ]
    assert told("CNVRT PX002 PX001 UF#(2)", "inform-not-given")[-1].startswith("user frame UF#(2) is set at")
    set_frame = "MFRAME UF#(2) PX001 BF\nCNVRT PX002 PX001 UF#(2)"
    assert not any("UF" in message for message in told(set_frame, "inform-not-given"))


@pytest.mark.parametrize(
    ("limits", "words"), [("T=1.00", "T="), ("DIS=5.0", "DIS="), ("T=1.00 DIS=5.0", "T= and DIS=")]
)
def test_limits_of_a_search_are_told(limits: str, words: str) -> None:
    (message,) = told(f"MOVL C00001 V=50.0 SRCH RIN#(1)=ON {limits}", "inform-search-limits")
    assert message.startswith(f"{words} at SRCH is left out")
    assert told("MOVL C00001 V=50.0 SRCH RIN#(1)=ON", "inform-search-limits") == []
