"""No program keeps a run going for ever or fills the memory: what goes on without end is ended at its place."""

from __future__ import annotations

from dataclasses import replace

import pytest
from helpers import krl, rapid, read

from rpl.runtime.limits import DEFAULTS, MOST_CHARACTERS, MOST_WAITING
from rpl.simulation import Simulation, run_program

LOW = replace(DEFAULTS, steps=20_000, events=5_000)
BUMP = "DEF BUMP(N:OUT)\nINT N\nN=N+1\nEND\nDEF AGAIN()\nAGAIN()\nEND\nDEF FLIP()\n$FLAG[1]=FALSE\n$FLAG[1]=TRUE\nEND\n"
# KRL bodies that never end, with declarations, and the fault that ends them at one of these lines of the file.
ENDLESS = [
    ("LOOP\nN=1\nENDLOOP", "no-time", (3, 4, 5)),
    ("LOOP\nN=1\nBUMP(N)\nENDLOOP", "no-time", range(3, 12)),
    ("LOOP\n$OUT[1]=TRUE\n$OUT[1]=FALSE\nENDLOOP", "no-time", (3, 4, 5, 6)),
    ('LOOP\nMsgNotify("again")\nENDLOOP', "no-time", (3, 4, 5)),
    ("A:\nGOTO A", "no-time", (3, 4)),
    ("LOOP\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\nENDLOOP", "no-time", (3, 4, 5)),
    ("AGAIN()", "too-deep", range(3, 12)),
    ("N=3\nLOOP\nN=N*N\nENDLOOP", "overflow", (5,)),
    ("LOOP\nPULSE($OUT[1],TRUE,3000)\nENDLOOP", "internal-limit", (4,)),
    ("LOOP\nTRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE\nENDLOOP", "internal-limit", (4,)),
    ("LOOP\nWAIT SEC 0.0000001\nENDLOOP", "max-events", (3, 4, 5)),
]


@pytest.mark.parametrize(("body", "code", "lines"), ENDLESS)
@pytest.mark.parametrize("robot", [None, "kuka_kr6r900sixx"])
def test_an_endless_run_ends_with_its_place(body: str, code: str, lines: range, robot: str | None) -> None:
    limits = replace(LOW, steps=200_000) if code == "internal-limit" else LOW
    result = krl(body, "DECL INT N", BUMP, robot=robot, limits=limits)
    assert result.fault is not None and result.fault.code == code
    assert result.status == ("limit" if code.startswith("max-") else "fault")
    assert result.fault.origin.file and result.fault.origin.line in lines
    assert len(result.trace) < 2 * MOST_WAITING


def test_an_error_that_is_tried_again_for_ever_is_no_loop_without_end() -> None:
    result = rapid("n:=1/n;\nERROR\nRETRY;", "VAR num n;", limits=LOW)
    assert result.fault is not None and result.fault.code == "no-time" and "1/n" not in result.fault.message


PAIR = """TASK one ENTRY first
TASK two ENTRY second BACKGROUND
MODULE pair
    GLOBAL VAR asked: BOOL = FALSE
    GLOBAL VAR given: BOOL = FALSE
    PROCEDURE first()
        LOOP
            asked = TRUE
            WAIT UNTIL given
            given = FALSE
        END LOOP
    END PROCEDURE
    PROCEDURE second()
        LOOP
            WAIT UNTIL asked
            asked = FALSE
            given = TRUE
        END LOOP
    END PROCEDURE
END MODULE
"""


def test_two_tasks_that_wake_each_other_are_ended() -> None:
    result = run_program(read("rpl", PAIR), limits=LOW)
    assert result.fault is not None and result.fault.code in ("no-time", "max-events")
    assert result.fault.origin.line in range(7, 19)


def test_texts_do_not_grow_without_end() -> None:
    body = 's = "ab"\nLOOP\ns = s & s\nEND LOOP\n'
    text = f"MODULE m\nVAR s: STRING\nPROCEDURE main()\n{body}END PROCEDURE\nEND MODULE\n"
    result = run_program(read("rpl", text))
    assert result.fault is not None and result.fault.code == "overflow" and str(MOST_CHARACTERS) in result.fault.message


def test_numbers_of_one_kind_go_on_as_real_ones() -> None:
    result = rapid("FOR i FROM 1 TO 25 DO\nn:=n*i;\nENDFOR\nTPWrite NumToStr(n/1E24,2);", "VAR num n:=1;")
    assert result.status == "finished" and result.messages == ("15.51",)


def test_a_loop_without_time_is_caught_with_breakpoints_too() -> None:
    simulation = Simulation(read("krl", "DEF PROG( )\nLOOP\n$OUT[1]=TRUE\nENDLOOP\nEND\n"), limits=LOW)
    simulation.breakpoints.add(("p0.src", 5))
    simulation.run()
    assert simulation.end_fault is not None and simulation.end_fault.code == "no-time"


def test_a_program_that_calculates_long_is_run_with_a_higher_limit() -> None:
    body = "FOR N=1 TO 30000\nENDFOR\n$OUT[1]=TRUE"
    refused = krl(body, "DECL INT N", limits=LOW)
    assert refused.fault is not None and "20,000 steps" in refused.fault.message
    assert krl(body, "DECL INT N", limits=replace(LOW, steps=100_000)).status == "finished"


def test_a_polling_loop_that_calls_a_routine_lets_time_pass() -> None:
    cell = "[[input]]\ntime=5\nsignal='$IN[1]'\nvalue=true\n"
    for more in ("", "N=1\n", "N=1\nN=2\n", "N=1\nN=2\nN=3\n"):  # wherever the call stands when time is up
        result = krl(f"WHILE NOT $IN[1]\n{more}BUMP(N)\nENDWHILE\n$OUT[1]=TRUE", "DECL INT N\nN=0", BUMP, cell=cell)
        assert result.status == "finished" and result.outputs[0][0] == pytest.approx(5.0, abs=0.11)
