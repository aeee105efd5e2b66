"""The verdict says what the runs did not come to; exploring compares in further cells and takes the worst verdict."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.explore import Budget
from rpl.proof.prove import prove_programs
from rpl.proof.verdict import ProofResult
from rpl.source import source_from_bytes


def rapid(*lines: str) -> ir.Program:
    text = "\n".join(("MODULE Job", "PROC main()", *lines, "ENDPROC", "ENDMODULE", ""))
    return read_sources([source_from_bytes("job.mod", text.encode())], "rapid", Diagnostics()).program


def krl(*lines: str) -> ir.Program:
    text = "\n".join(("DEF JOB( )", *lines, "END", ""))
    return read_sources([source_from_bytes("job.src", text.encode())], "krl", Diagnostics()).program


def proved(a: ir.Program, b: ir.Program, explore: bool = True, cell: str = "") -> ProofResult:
    return prove_programs(a, b, None, None, parse_cell(cell), budget=Budget() if explore else None)


BRANCH = ("Set do9;", "IF di1=1 THEN", "Set do1;", "ENDIF")


def test_the_first_line_names_what_was_not_reached() -> None:
    result = proved(rapid(*BRANCH), rapid(*BRANCH), explore=False)
    assert result.verdict == "equal"
    assert result.headline().endswith("; not reached: 1 statement of A (line 5) and 1 statement of B (line 5)")
    assert "A: not reached: line 5: the condition in line 4 was never TRUE" in result.as_text().splitlines()
    reach = result.as_json()["reach"]
    assert isinstance(reach, dict) and reach["explored"] is None
    assert (reach["a"]["statements"], reach["a"]["reached"], len(reach["b"]["unreached"])) == (3, 2, 1)


def test_nothing_is_said_where_everything_was_reached() -> None:
    assert "not reached" not in proved(rapid("Set do1;"), rapid("Set do1;"), explore=False).as_text()


def test_exploring_reaches_and_says_in_how_many_cells() -> None:
    result = proved(rapid(*BRANCH), rapid(*BRANCH))
    assert result.verdict == "equal" and "not reached" not in result.as_text()
    assert result.explored is not None and result.explored.cells == 1
    assert "explored: " in result.as_text()


@pytest.mark.parametrize(
    "changed",
    [
        ("Set do9;", "IF di1=1 THEN", "Set do2;", "ENDIF"),
        ("Set do9;", "IF di2=1 THEN", "Set do1;", "ENDIF"),
        ("Set do9;", "IF di1=1 AND di2=0 THEN", "Set do1;", "ENDIF"),
        ("Set do9;", "IF di1=1 THEN", "Set do1;", "Set do3;", "ENDIF"),
        ("Set do9;", "IF di1=1 THEN", "ENDIF"),
    ],
)
def test_a_change_behind_an_input_is_refuted_by_exploring_only(changed: tuple[str, ...]) -> None:
    assert proved(rapid(*BRANCH), rapid(*changed), explore=False).verdict == "equal"
    result = proved(rapid(*BRANCH), rapid(*changed))
    assert result.verdict == "different"
    assert any("found by exploring" in note for note in result.notes)


def test_a_limit_that_is_one_off() -> None:
    first = ("Set do9;", "IF giPart>5 THEN", "Set do1;", "ENDIF")
    for other in ("giPart>=5", "giPart>6", "giPart<>0 AND giPart>5 AND giPart<>6"):
        second = ("Set do9;", f"IF {other} THEN", "Set do1;", "ENDIF")
        assert proved(rapid(*first), rapid(*second)).verdict == "different", other


def test_a_time_limit_that_nobody_met() -> None:
    first = ("VAR bool late;", "WaitDI di1,1\\MaxTime:=2\\TimeFlag:=late;", "IF late THEN", "Set do1;", "ENDIF")
    second = tuple(line.replace("MaxTime:=2", "MaxTime:=3") for line in first)
    on = '[[input]]\ntime = 0.0\nsignal = "di1"\nvalue = true\n'
    assert proved(rapid(*first, "Set do9;"), rapid(*second, "Set do9;"), cell=on).verdict != "equal"
    assert proved(rapid(*first, "Set do9;"), rapid(*first, "Set do9;"), cell=on).verdict == "equal"


def test_a_wait_for_a_signal_that_comes_in_no_cell_but_is_found() -> None:
    first = ("WaitDI di1,1;", "Set do1;")
    assert proved(rapid(*first), rapid(*first), explore=False).verdict == "undecided"
    assert proved(rapid(*first), rapid(*first)).verdict == "equal"
    assert proved(rapid(*first), rapid("WaitDI di1,1;", "Set do2;")).verdict == "different"


def test_a_missing_wait_shows_where_the_signal_stays_away() -> None:
    on = '[[input]]\ntime = 0.0\nsignal = "di1"\nvalue = true\n'
    assert proved(rapid("WaitDI di1,1;", "Set do1;"), rapid("Set do1;"), explore=False, cell=on).verdict == "equal"
    assert proved(rapid("WaitDI di1,1;", "Set do1;"), rapid("Set do1;"), cell=on).verdict == "different"


def test_across_languages() -> None:
    first = krl("$OUT[9]=TRUE", "IF $IN[1] THEN", "  $OUT[1]=TRUE", "ENDIF")
    assert proved(first, rapid(*BRANCH)).verdict == "equal"
    assert proved(first, rapid("Set do9;", "IF di2=1 THEN", "Set do1;", "ENDIF")).verdict == "different"


def test_a_fault_of_both_in_a_found_cell_is_no_doubt() -> None:
    lines = ("VAR num n;", "Set do9;", "n:=100/(giParts-3);", "Set do1;")
    assert proved(rapid(*lines), rapid(*lines)).verdict == "equal"
