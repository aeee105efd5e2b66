"""Exploring: inputs, kept values and answers are driven so that programs go every way that can be gone."""

from __future__ import annotations

import math

import pytest

from rpl import ir
from rpl.cell import Cell, parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.explore import Budget, Exploration, explore
from rpl.proof.reach import Reach, reach_of
from rpl.proof.watched import side_of
from rpl.proof.wiring import in_words_of
from rpl.simulation import run_program
from rpl.source import source_from_bytes


def read(text: str, language: str, name: str) -> ir.Program:
    diagnostics = Diagnostics()
    program = read_sources([source_from_bytes(name, text.encode())], language, diagnostics).program
    assert not diagnostics.has_errors
    return program


def rapid(*lines: str, data: tuple[str, ...] = (), more: tuple[str, ...] = ()) -> ir.Program:
    text = "\n".join(("MODULE Job", *data, "PROC main()", *lines, "ENDPROC", *more, "ENDMODULE", ""))
    return read(text, "rapid", "job.mod")


def krl(*lines: str, data: str = "") -> ir.Program:
    text = "\n".join(("DEF JOB( )", *lines, "END", ""))
    sources = [source_from_bytes("job.src", text.encode())]
    if data:
        sources.append(source_from_bytes("job.dat", f"DEFDAT JOB\n{data}\nENDDAT\n".encode()))
    return read_sources(sources, "krl", Diagnostics()).program


def explored(program: ir.Program, cell: str = "", budget: Budget | None = None) -> tuple[Exploration, Reach]:
    found = explore([side_of(program)], parse_cell(cell), budget or Budget(seconds=math.inf))
    return found, reach_of(program, found.reached[0], None, found.remarks[0], found.one_way[0])


def missing(program: ir.Program, cell: str = "") -> list[int]:
    return [one.place.line for one in explored(program, cell)[1].unreached]


def pair(a: ir.Program, b: ir.Program, cell: Cell | None = None) -> Exploration:
    return explore([side_of(a), side_of(b, words=lambda cell: in_words_of(cell, a, b))], cell)


def outputs(program: ir.Program, cell: Cell) -> tuple[object, ...]:
    return tuple(value for _, _, value in run_program(program, None, cell).outputs)


def on(signal: str, time: float = 0.0) -> str:
    return f'[[input]]\ntime = {time}\nsignal = "{signal}"\nvalue = true\n'


# ---- ways that need an input


def test_a_branch_that_needs_an_input() -> None:
    assert missing(rapid("IF di1=1 THEN", "Set do1;", "ENDIF", "Set do2;")) == []


def test_a_branch_that_needs_an_input_to_go_away() -> None:
    found, reach = explored(rapid("IF di1=0 THEN", "Set do1;", "ENDIF"), on("di1"))
    assert reach.share == 1.0
    assert [one.value for one in found.cells[-1].inputs] == [False]


def test_both_ways_are_gone_also_where_only_one_has_statements() -> None:
    found, _ = explored(rapid("IF di1=0 Set do1;"))
    assert [[(one.signal, one.value) for one in cell.inputs] for cell in found.cells] == [[("di1", True)]]


def test_several_inputs_of_one_condition() -> None:
    assert missing(rapid("IF di1=1 AND di2=0 AND di3=1 THEN", "Set do1;", "ENDIF")) == []


def test_branches_in_branches() -> None:
    program = rapid("IF di1=1 THEN", "IF di2=1 THEN", "IF di3=1 THEN", "Set do1;", "ENDIF", "ENDIF", "ENDIF")
    assert missing(program) == []


def test_an_input_that_went_through_variables_and_functions() -> None:
    more = ("FUNC bool Ready()", "VAR bool b;", "b:=di4=1;", "RETURN b;", "ENDFUNC")
    program = rapid("VAR bool seen;", "seen:=Ready();", "WaitTime 0.5;", "IF seen THEN", "Set do1;", "ENDIF", more=more)
    assert missing(program) == []


def test_an_input_whose_number_is_computed() -> None:
    program = krl("INT N", "FOR N=1 TO 3", "  IF $IN[N+10] THEN", "    $OUT[N]=TRUE", "  ENDIF", "ENDFOR")
    assert missing(program) == []


def test_a_group_of_inputs_and_each_case_of_its_value() -> None:
    lines = ("TEST giJob", "CASE 3:", "Set do1;", "CASE 7,8:", "Set do2;", "DEFAULT:", "Set do3;", "ENDTEST")
    assert missing(rapid(*lines)) == []


def test_bits_as_one_number() -> None:
    program = krl("SIGNAL PART $IN[9] TO $IN[12]", "IF PART==5 THEN", "  $OUT[1]=TRUE", "ENDIF")
    assert missing(program) == []


def test_an_analog_input_beside_its_limit() -> None:
    lines = ("IF aiForce>7.5 THEN", "Set do1;", "ELSEIF aiForce>2 THEN", "Set do2;", "ELSE", "Set do3;", "ENDIF")
    assert missing(rapid(*lines)) == []


# ---- waits


def test_a_wait_that_needs_a_signal_to_come() -> None:
    assert missing(rapid("Set do1;", "WaitDI di1,1;", "Set do2;")) == []


def test_a_handshake_that_comes_and_goes() -> None:
    assert missing(rapid("WaitDI di1,1;", "Set do1;", "WaitDI di1,0;", "Set do2;", "WaitDI di1,1;", "Set do3;")) == []


def test_the_time_out_of_a_wait() -> None:
    late = ("VAR bool late;", "WaitDI di1,1\\MaxTime:=2\\TimeFlag:=late;", "IF late THEN", "Set do1;", "ENDIF")
    found, reach = explored(rapid(*late), on("di1"))
    assert reach.share == 1.0 and len(found.cells) == 1


def test_an_error_that_a_time_limit_raises() -> None:
    lines = ("WaitDI di1,1\\MaxTime:=2;", "RETURN;", "ERROR", "Set do1;", "RETURN;")
    assert missing(rapid(*lines), on("di1", 1.0)) == []


def test_a_wait_that_is_met_at_once_is_also_made_to_wait() -> None:
    found, _ = explored(rapid("WaitDI di1,1;", "Set do1;"), on("di1"))
    assert any(run_program(rapid("WaitDI di1,1;"), None, cell).status == "deadlock" for cell in found.cells)


def test_a_loop_that_looks_again_and_again() -> None:
    assert missing(rapid("WHILE di1=0 DO", "WaitTime 0.1;", "ENDWHILE", "Set do1;")) == []


# ---- interrupts, errors, answers, kept values


def test_an_interrupt_on_a_signal() -> None:
    trap = ("TRAP tr", "Set do2;", "ENDTRAP")
    lines = ("VAR intnum i1;", "CONNECT i1 WITH tr;", "ISignalDI di1,1,i1;", "WaitTime 3;", "Set do1;")
    assert missing(rapid(*lines, more=trap)) == []


def test_an_error_that_an_input_causes() -> None:
    lines = ("VAR num n;", "n:=100/giParts;", "RETURN;", "ERROR", "Set do1;", "RETURN;")
    assert (
        missing(rapid(*lines)) == [] and missing(rapid(*lines), '[[input]]\ntime=0\nsignal="giParts"\nvalue=4\n') == []
    )


def test_the_answers_of_the_operator() -> None:
    lines = ("VAR num n;", 'TPReadFK n,"which?","A","B","C",stEmpty,stEmpty;', "TEST n")
    cases = ("CASE 1:", "Set do1;", "CASE 2:", "Set do2;", "CASE 3:", "Set do3;", "ENDTEST")
    assert missing(rapid(*lines, *cases)) == []


def test_a_kept_variable_that_the_program_only_reads() -> None:
    data = ("PERS num mode:=1;",)
    assert missing(rapid("IF mode=4 THEN", "Set do1;", "ENDIF", data=data)) == []
    assert missing(rapid("mode:=1;", "IF mode=4 THEN", "Set do1;", "ENDIF", data=data)) == [6], "set before"


def test_an_element_of_a_kept_array_and_a_member_of_an_enumeration() -> None:
    data = "ENUM KIND LEFT,RIGHT,NONE\nDECL KIND WAYS[2]\nWAYS[1]=#LEFT\nWAYS[2]=#LEFT"
    lines = ("SWITCH WAYS[2]", "CASE #LEFT", "$OUT[1]=TRUE", "CASE #RIGHT", "$OUT[2]=TRUE", "DEFAULT", "$OUT[3]=TRUE")
    assert missing(krl(*lines, "ENDSWITCH", data=data)) == []


def test_random_numbers_have_other_seeds() -> None:
    ways = "  if random() > 0.5:\n    set_digital_out(1, True)\n  else:\n    set_digital_out(2, True)\n  end\n"
    assert missing(read(f"def job():\n{ways}end\n", "urscript", "job.script")) == []


# ---- what cannot be


def test_what_nothing_decides_is_told_as_such() -> None:
    _, reach = explored(rapid("VAR num n:=3;", "IF n>5 THEN", "Set do1;", "ENDIF", "WaitDI di1,1;"))
    assert [one.impossible for one in reach.unreached] == [True]
    reason = "the condition in line 4 was never TRUE; no input, kept value or answer is looked at before it"
    assert reach.unreached[0].reason == reason
    assert reach.share < 1.0 and reach.impossible == reach.statements - reach.reached


def test_what_other_cells_did_not_change_says_so() -> None:
    program = rapid("IF giA*giA=2 THEN", "Set do1;", "ENDIF")
    found, reach = explored(program)
    assert reach.unreached[0].reason.endswith(f"{found.tried} other cells did not change that")
    assert not reach.unreached[0].impossible


def test_it_is_bounded_and_the_same_each_time() -> None:
    lines = [line for n in range(1, 9) for line in (f"IF gi{n}*gi{n}=2 THEN", f"Set do{n};", "ENDIF")]
    first, _ = explored(rapid(*lines), budget=Budget(cells=15))
    again, _ = explored(rapid(*lines), budget=Budget(cells=15))
    assert (first.tried, first.ended) == (15, "cells")
    assert first.cells == again.cells


def test_a_changed_cell_ends_also_where_the_program_goes_round_for_ever() -> None:
    program = rapid("WaitDI di1,0;", "WaitTime 1;", "WHILE di1=1 DO", "WaitTime 0.01;", "ENDWHILE", "Set do1;")
    assert missing(program) == []


# ---- two programs


def test_what_the_second_program_looks_at_is_tried_on_both() -> None:
    first = rapid("IF di1=1 THEN", "Set do1;", "ENDIF")
    second = rapid("IF di1=1 AND di2=0 THEN", "Set do1;", "ENDIF")
    found = pair(first, second)
    assert any(outputs(first, cell) != outputs(second, cell) for cell in found.cells)


@pytest.mark.parametrize("number", [3, 4])
def test_inputs_meet_by_meaning_across_languages(number: int) -> None:
    first = krl("IF $IN[3] THEN", "  $OUT[1]=TRUE", "ENDIF")
    second = rapid(f"IF di{number}=1 THEN", "Set do1;", "ENDIF")
    found = pair(first, second)
    same = all(outputs(first, cell) == outputs(second, in_words_of(cell, first, second)) for cell in found.cells)
    assert same == (number == 3)
    assert {one.signal for cell in found.cells for one in cell.inputs} == {"$IN[3]", f"$IN[{number}]"}


def test_a_kept_value_is_tried_only_where_both_have_it() -> None:
    first = rapid("IF mode=4 Set do1;", data=("PERS num mode:=1;",))
    assert pair(first, rapid("Set do2;")).cells == ()
    found = pair(first, rapid("IF mode=4 Set do1;", data=("PERS num mode:=1;",)))
    assert {"mode": 4} in [cell.variables for cell in found.cells]


def test_no_input_changes_just_when_a_statement_of_either_program_looks() -> None:
    first = rapid("IF di1=0 Set do1;", "WaitTime 1;", "IF di1=1 Set do2;")
    second = rapid("IF di1=0 Set do1;", "WaitTime 1.01;", "IF di1=1 Set do2;")
    for cell in pair(first, second).cells:
        assert outputs(first, cell) == outputs(second, cell)
