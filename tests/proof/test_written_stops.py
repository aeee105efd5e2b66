"""An error that nobody handles ends a run in a fault; a language without error handlers gets a message and a stop
written for it (rpl/passes/legalise/errors.py). That stop is the fault, and nothing else is."""

from __future__ import annotations

import math

import pytest

from rpl import ir
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.ir.errornames import unhandled_text
from rpl.project import read_sources
from rpl.proof.explore import Budget
from rpl.proof.prove import prove_programs
from rpl.proof.verdict import ProofResult
from rpl.source import source_from_bytes


def rapid(*lines: str, more: tuple[str, ...] = ()) -> ir.Program:
    text = "\n".join(("MODULE Job", "PROC main()", *lines, "ENDPROC", *more, "ENDMODULE", ""))
    return read_sources([source_from_bytes("job.mod", text.encode())], "rapid", Diagnostics()).program


def krl(*lines: str) -> ir.Program:
    text = "\n".join(("DEF JOB( )", *lines, "END", ""))
    return read_sources([source_from_bytes("job.src", text.encode())], "krl", Diagnostics()).program


def proved(a: ir.Program, b: ir.Program, cell: str = "", explore: bool = False) -> ProofResult:
    return prove_programs(a, b, None, None, parse_cell(cell), budget=Budget(seconds=math.inf) if explore else None)


FAILS = rapid("VAR num n:=0;", "Set do1;", "n:=1/n;", "Set do2;")
STOPS = ("$OUT[1]=TRUE", f'MsgQuit("{unhandled_text("main")}")', "HALT")
PLACE = " at job.mod:5: n:=1/n;"


@pytest.mark.parametrize("turned", [False, True])
def test_the_written_stop_is_the_unhandled_fault_and_decides_nothing(turned: bool) -> None:
    a, b = (krl(*STOPS), FAILS) if turned else (FAILS, krl(*STOPS))
    result = proved(a, b)
    assert result.verdict == "undecided" and result.difference is None
    who = "A" if turned else "B"
    start = (
        f"both runs stop with an unhandled fault (division-by-zero){PLACE}, {who} by the stop that is written for it"
    )
    assert result.reason.startswith(start) and result.reason in result.notes


def test_an_error_that_another_routine_hands_on_ends_in_the_outermost_one() -> None:
    more = ("PROC Deep()", "VAR num n:=0;", "n:=1/n;", "ENDPROC")
    assert proved(rapid("Set do1;", "Deep;", more=more), krl(*STOPS)).verdict == "undecided"
    deep = ("$OUT[1]=TRUE", f'MsgQuit("{unhandled_text("Deep")}")', "HALT")
    assert proved(rapid("Set do1;", "Deep;", more=more), krl(*deep)).verdict == "different"


@pytest.mark.parametrize(
    "lines",
    [
        STOPS[:2],  # says so and goes on to its end
        (*STOPS[:2], "$OUT[3]=TRUE", "HALT"),
        (*STOPS[:2], "WAIT SEC 1", "HALT"),
        STOPS[1:],  # too early
        ("$OUT[1]=TRUE", "$OUT[2]=TRUE", *STOPS[1:]),  # too late
        ("$OUT[1]=TRUE", "HALT"),
        ("$OUT[1]=TRUE", 'MsgQuit("Error in main")', "HALT"),
        ("$OUT[1]=TRUE", 'MsgQuit("Error in job is not handled")', "HALT"),
    ],
)
def test_nothing_else_is_the_fault(lines: tuple[str, ...]) -> None:
    assert proved(FAILS, krl(*lines)).verdict == "different"


def test_what_no_handler_could_take_is_no_unhandled_error() -> None:
    """A variable without a value stops a KRL program; it is no error that a translation passes on."""
    text = unhandled_text("job")
    unset = krl("INT N", "$OUT[1]=TRUE", "N=N+1")
    assert proved(unset, rapid("Set do1;", f'TPWrite "{text}";', "EXIT;")).verdict == "different"


def test_a_stop_that_the_source_itself_makes_is_none_of_the_fault() -> None:
    """Both programs say and stop the same: that is an end like any other."""
    ours = rapid("Set do1;", f'TPWrite "{unhandled_text("main")}";', "EXIT;")
    assert proved(ours, krl(*STOPS)).verdict == "equal"


def test_exploring_names_the_runs_that_stop_so() -> None:
    ours = rapid("Set do1;", "IF di1=1 RAISE 7;", "Set do2;")
    theirs = krl("$OUT[1]=TRUE", "IF $IN[1] THEN", *STOPS[1:], "ENDIF", "$OUT[2]=TRUE")
    result = proved(ours, theirs, explore=True)
    assert result.verdict == "equal"
    assert any("both runs stop with an unhandled fault" in note for note in result.notes)
