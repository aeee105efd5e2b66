"""V+ DELAY holds the robot, not the program: run, and written in languages whose waits hold the program."""

from __future__ import annotations

from functools import cache

import pytest

from rpl.diagnostics import Diagnostics
from rpl.ir.rules import Rules
from rpl.passes.scope import rules_of
from rpl.project import ReadProgram, read_sources
from rpl.registry import target_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "adept_viper_s650"
HEAD = "SPEED 50 ALWAYS\nMOVE TRANS(400,0,240,0,180,0)\nBREAK\nTIMER 1 = 0\n"
UP = "MOVES TRANS(400,0,300,0,180,0)"


def _read(main: str, others: str = "") -> ReadProgram:
    text = f".PROGRAM main()\nAUTO REAL t0, t1, t2\n{main}\n.END\n{others}"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.v2", text)], "vplus", diagnostics)
    assert not diagnostics.has_errors
    return read


def _on(outputs: object) -> set[str]:
    assert isinstance(outputs, list | tuple)
    state = {str(name).rpartition(".")[2].strip("]"): value for _, name, value in outputs}
    return {name for name, value in state.items() if value}


# Program, others beside it: each switches outputs 1 and 2 where its times are as they are on the controller.
RUN = {
    "timer": (
        f"{HEAD}DELAY 0.6\nt1 = TIMER(1)\nBREAK\nt2 = TIMER(1)\n"
        "IF t1 < 0.05 THEN\nSIGNAL 1\nEND\nIF ABS(t2-0.6) < 0.05 THEN\nSIGNAL 2\nEND",
        "",
    ),
    "next move": (
        f"{HEAD}DELAY 0.6\nt1 = TIMER(1)\n{UP}\nt2 = TIMER(1)\n"
        "BREAK\nIF t1 < 0.05 THEN\nSIGNAL 1\nEND\nIF ABS(t2-0.6) < 0.05 THEN\nSIGNAL 2\nEND",
        "",
    ),
    "two pauses": (
        f"{HEAD}DELAY 0.4\nDELAY 0.3\nt1 = TIMER(1)\nBREAK\nt2 = TIMER(1)\n"
        "IF ABS(t1-0.4) < 0.05 THEN\nSIGNAL 1\nEND\nIF ABS(t2-0.7) < 0.05 THEN\nSIGNAL 2\nEND",
        "",
    ),
    "behind a move": (
        f"{HEAD}{UP}\nDELAY 0.5\nIF ABS(DZ(HERE)-300) < 0.1 THEN\nSIGNAL 1\nEND\nTIMER 1 = 0\nBREAK\n"
        "IF ABS(TIMER(1)-0.5) < 0.05 THEN\nSIGNAL 2\nEND",
        "",
    ),
    "its time changes": (
        f"{HEAD}t0 = 0.5\nDELAY t0\nt0 = 3\nIF TIMER(1) < 0.05 THEN\nSIGNAL 1\nEND\nBREAK\n"
        "IF ABS(TIMER(1)-0.5) < 0.05 THEN\nSIGNAL 2\nEND",
        "",
    ),
    "in a loop": (
        f"{HEAD}FOR i = 1 TO 2\nDELAY 0.3\nt1 = TIMER(1)\nEND\nBREAK\nt2 = TIMER(1)\n"
        "IF ABS(t1-0.3) < 0.05 THEN\nSIGNAL 1\nEND\nIF ABS(t2-0.6) < 0.05 THEN\nSIGNAL 2\nEND",
        "",
    ),
}


@cache
@pytest.mark.parametrize("what", RUN)
@pytest.mark.parametrize("target", ["own", *target_names()])
def test_the_robot_pauses_and_the_program_goes_on(what: str, target: str) -> None:
    read = _read(*RUN[what])
    program = read.program
    if target != "own":
        diagnostics = Diagnostics()
        files = translate_program(read, target, ARM, None, diagnostics).files
        if target != "vplus":
            assert "pause-first" not in {item.code.name for item in diagnostics}
        program = read_sources([source_from_bytes(one.path, one.data) for one in files], target, Diagnostics()).program
    result = run_program(program, ARM, controller="plain")
    assert result.status == "finished", result.fault
    assert len(_on(result.outputs)) == 2, result.outputs


TOLD = [
    (f"DELAY 0.5\nWAIT SIG(1001)\n{UP}", "", "pause-first"),
    (f"CALL pause()\nSIGNAL 3\n{UP}", ".PROGRAM pause()\nDELAY 0.5\n.END\n", "pause-at-end"),
    (f"DELAY 0.5\nCALL quick()\n{UP}", ".PROGRAM quick()\nSIGNAL 3\n.END\n", "pause-first"),
    ("DELAY 0.5\nSIGNAL 3", "", None),
    (f"IF SIG(1001) THEN\nDELAY 0.5\nEND\n{UP}", "", None),
    (f"IF SIG(1001) THEN\nDELAY 0.5\nEND\nSIGNAL 3\n{UP}", "", "pause-at-end"),
    (f"DELAY 0.5\nWAIT SIG(1001)\nt1 = TIMER(1)\n{UP}", "", "pause-timed"),
]


@pytest.mark.parametrize(("main", "others", "code"), TOLD)
def test_a_step_that_would_come_later_is_told(main: str, others: str, code: str | None) -> None:
    diagnostics = Diagnostics()
    translate_program(_read(main, others), "krl", ARM, None, diagnostics)
    assert {item.code.name for item in diagnostics} & {"pause-first", "pause-at-end", "pause-timed"} == (
        {code} if code else set()
    )


def test_a_brake_ends_it() -> None:
    main = f"{HEAD}DELAY 5\nSIGNAL 2\nBRAKE\nBREAK\nIF TIMER(1) < 0.1 THEN\nSIGNAL 1\nEND"
    assert len(_on(run_program(_read(main).program, ARM, controller="plain").outputs)) == 2


def test_it_is_one_rule_of_the_language() -> None:
    """M: that DELAY is a motion, which queues."""
    queueing = [name for name in target_names() if rules_of(name).advance.waits_queue]
    assert queueing == ["vplus"] and not Rules("any", rules_of("krl").advance).advance.waits_queue
