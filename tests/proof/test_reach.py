"""Statement coverage of runs: what was reached, what was not and why, folded into lines and merged over runs."""

from __future__ import annotations

import copy

from rpl import ir
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.reach import Reach, reach_of
from rpl.simulation import Simulation, run_program
from rpl.source import source_from_bytes


def program_of(*lines: str, more: tuple[str, ...] = ()) -> ir.Program:
    """A RAPID module whose `main` begins in line 3."""
    text = "\n".join(("MODULE Job", "PROC main()", *lines, "ENDPROC", *more, "ENDMODULE", ""))
    return read_sources([source_from_bytes("job.mod", text.encode())], "rapid", Diagnostics()).program


def reach(program: ir.Program, *cells: str) -> Reach:
    surroundings = [parse_cell(text) for text in cells or ("",)]
    return reach_of(program, [run_program(program, None, cell, max_time_s=60).reached for cell in surroundings])


def missing(program: ir.Program, *cells: str) -> dict[int, str]:
    return {one.place.line: one.reason for one in reach(program, *cells).unreached}


def test_comments_and_declarations_are_no_statements() -> None:
    found = reach(program_of("! a remark", "VAR num n;", "n:=1;", "Set do1;"))
    assert (found.statements, found.reached, found.unreached) == (2, 2, ())
    assert found.share == 1.0 and found.named() == ""


def test_a_branch_that_is_not_taken_is_named_with_its_condition() -> None:
    program = program_of("IF di1=1 THEN", "Set do1;", "ELSE", "Set do2;", "ENDIF", "Set do3;")
    assert missing(program) == {4: "the condition in line 3 was never TRUE"}
    on = '[[input]]\ntime = 0\nsignal = "di1"\nvalue = true\n'
    assert missing(program, on) == {6: "the condition in line 3 was never FALSE"}
    assert missing(program, "", on) == {}, "two runs together"


def test_a_constant_condition_is_told_as_such() -> None:
    assert missing(program_of("IF 1>2 THEN", "Set do1;", "ENDIF")) == {4: "the condition in line 3 is always FALSE"}


def test_a_routine_that_nobody_calls() -> None:
    found = missing(program_of("Set do1;", more=("PROC other()", "Set do2;", "Set do3;", "ENDPROC")))
    assert found == {6: "no statement calls other", 7: "no statement calls other"}


def test_a_routine_whose_call_was_not_reached() -> None:
    program = program_of("IF di1=1 THEN", "other;", "ENDIF", more=("PROC other()", "Set do2;", "ENDPROC"))
    assert missing(program)[8] == "other was not called"


def test_behind_a_loop_without_end() -> None:
    told = "behind the loop without end in line 3"
    assert missing(program_of("WHILE TRUE DO", "WaitTime 1;", "ENDWHILE", "Set do1;")) == {6: told}


def test_behind_a_wait_that_never_ends() -> None:
    assert missing(program_of("WaitDI di1,1;", "Set do1;")) == {4: "behind the wait in line 3, which did not end"}


def test_an_error_handler_without_an_error() -> None:
    found = missing(program_of("Set do1;", "ERROR", "Set do2;", "RETURN;"))
    assert set(found.values()) == {"no error came that this handler takes"} and set(found) == {5, 6}


def test_behind_a_statement_that_leaves() -> None:
    assert missing(program_of("RETURN;", "Set do1;")) == {4: "behind line 3, which goes elsewhere"}


def test_an_interrupt_that_never_comes() -> None:
    trap = ("TRAP tr", "Set do2;", "ENDTRAP")
    program = program_of("VAR intnum i1;", "CONNECT i1 WITH tr;", "ISignalDI di1,1,i1;", "WaitTime 1;", more=trap)
    assert missing(program) == {9: "tr was not called"}
    assert missing(program, '[[input]]\ntime = 0.5\nsignal = "di1"\nvalue = true\n') == {}


def test_text_and_json_fold_lines() -> None:
    found = reach(program_of("IF di1=1 THEN", "Set do1;", "Set do2;", "Set do3;", "ENDIF"))
    assert found.as_text().splitlines() == [
        "1 of 4 statements were reached (25 %)",
        "not reached: lines 4-6: the condition in line 3 was never TRUE",
    ]
    assert found.named() == "3 statements (lines 4-6)"
    document = found.as_json()
    assert (document["statements"], document["reached"], document["share"]) == (4, 1, 0.25)
    first = document["unreached"][0]  # type: ignore[index]
    assert first == {
        "file": "job.mod",
        "line": 4,
        "text": "Set do1;",
        "reason": "the condition in line 3 was never TRUE",
        "impossible": False,
    }


def test_reaches_of_several_runs_are_merged() -> None:
    program = program_of("IF di1=1 THEN", "Set do1;", "ELSE", "Set do2;", "ENDIF")
    on = '[[input]]\ntime = 0\nsignal = "di1"\nvalue = true\n'
    both = reach(program).merged(reach(program, on))
    assert (both.statements, both.reached, both.unreached) == (3, 3, ())


def test_a_snapshot_reaches_for_itself() -> None:
    program = program_of("Set do1;", "WaitTime 1;", "Set do2;")
    simulation = Simulation(program, None)
    simulation.run_until(0.5)
    twin = copy.deepcopy(simulation)
    twin.run()
    assert reach_of(program, [twin.result().reached]).share == 1.0
    assert [one.place.line for one in reach_of(program, [simulation.result().reached]).unreached] == [5]


def test_many_nested_blocks_are_no_problem() -> None:
    depth = 60
    lines = [*(f"IF di{n}=1 THEN" for n in range(1, depth + 1)), "Set do1;", *("ENDIF",) * depth]
    assert len(missing(program_of(*lines))) == depth
