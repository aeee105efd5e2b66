"""Values that a controller keeps are given to both programs by meaning: under the name, the number and the element that
the translation gave them. One that the other program does not keep is named in the verdict."""

from __future__ import annotations

import math

import pytest

from rpl import ir
from rpl.cell import Cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.explore import Budget
from rpl.proof.prove import prove_programs
from rpl.proof.verdict import ProofResult
from rpl.proof.wiring import in_words_of, kept_names
from rpl.source import source_from_bytes


def rapid(*lines: str, data: tuple[str, ...] = ("PERS num mode:=1;",)) -> ir.Program:
    text = "\n".join(("MODULE Job", *data, "PROC main()", *lines, "ENDPROC", "ENDMODULE", ""))
    return read_sources([source_from_bytes("job.mod", text.encode())], "rapid", Diagnostics()).program


def krl(*lines: str, data: str = "") -> ir.Program:
    text = "\n".join(("DEF JOB( )", *lines, "END", ""))
    given = f"DEFDAT JOB\n{data}\nENDDAT\n"
    sources = [source_from_bytes("job.src", text.encode()), source_from_bytes("job.dat", given.encode())]
    return read_sources(sources, "krl", Diagnostics()).program


def vplus(*lines: str, reals: str = "") -> ir.Program:
    text = "\n".join((".PROGRAM job()", *lines, ".END", ".REALS", reals, ".END", ""))
    return read_sources([source_from_bytes("job.v2", text.encode())], "vplus", Diagnostics()).program


def proved(a: ir.Program, b: ir.Program, **kept: str) -> ProofResult:
    return prove_programs(a, b, budget=Budget(seconds=math.inf), kept=kept)


LOOKS = rapid("Set do9;", "IF mode=4 Set do1;")
SAME = ("$OUT[9]=TRUE", "IF MODE_2==4 THEN", "  $OUT[1]=TRUE", "ENDIF")
OTHER = ("$OUT[9]=TRUE", "IF MODE_2==4 THEN", "  $OUT[2]=TRUE", "ENDIF")
DATA = "DECL REAL MODE_2=1"
UNMATCHED = "; kept by one only and not changed: mode of A; mode_2 of B"


def test_a_kept_value_with_another_name_is_given_to_both() -> None:
    result = proved(LOOKS, krl(*SAME, data=DATA), mode="MODE_2")
    assert result.verdict == "equal" and "kept by one only" not in result.headline()
    assert result.explored is not None and result.explored.cells > 0
    assert proved(LOOKS, krl(*OTHER, data=DATA), mode="MODE_2").verdict == "different"


def test_one_that_is_not_matched_is_named() -> None:
    result = proved(LOOKS, krl(*OTHER, data=DATA))
    assert result.headline().endswith(UNMATCHED)
    explored = result.as_json()["reach"]["explored"]  # type: ignore[index]
    assert [[name.lower() for name in explored["unmatched"][side]] for side in "ab"] == [["mode"], ["mode_2"]]


def test_one_that_the_other_program_sets_before_it_looks_is_named() -> None:
    """It is not kept there: each start begins with the same value."""
    result = proved(LOOKS, krl("MODE_2=1", *SAME, data=DATA), mode="MODE_2")
    assert result.verdict == "equal"
    assert result.headline().lower().endswith("kept by one only and not changed: mode of a")


def test_within_one_language_what_sets_it_first_is_a_difference() -> None:
    assert proved(LOOKS, rapid("Set do9;", "mode:=1;", "IF mode=4 Set do1;")).verdict == "different"


CHOICE = "ENUM WAY_T LEFT,RIGHT\nDECL WAY_T WAYS[2]\nWAYS[1]=#LEFT\nWAYS[2]=#LEFT"
CHOOSES = ("SWITCH WAYS[2]", "CASE #LEFT", "$OUT[1]=TRUE", "CASE #RIGHT", "$OUT[2]=TRUE", "ENDSWITCH")


@pytest.mark.parametrize(("right", "verdict"), [(2, "equal"), (1, "different")])
def test_a_member_of_an_enumeration_is_the_number_that_the_other_program_has_for_it(right: int, verdict: str) -> None:
    outputs = ("IF ways[2] == left THEN", "SIGNAL 1", "END", f"IF ways[2] == {right} THEN", "SIGNAL 2", "END")
    numbers = vplus(*outputs, reals="left 1\nright 2\nways[1] 1\nways[2] 1")
    assert proved(krl(*CHOOSES, data=CHOICE), numbers).verdict == verdict


def test_an_element_keeps_its_number_where_the_other_array_only_begins_earlier() -> None:
    """A V+ array has the element 0; a KRL array begins at 1."""
    a, b = krl(*CHOOSES, data=CHOICE), vplus("x = ways[1]", reals="ways[1] 1\nways[2] 1\nright 2")
    assert in_words_of(Cell(variables={"ways[2]": "right"}), a, b).variables == {"ways[2]": 2}


def test_names_and_numbers_of_a_translation() -> None:
    written = krl(data="DECL REAL MODE_2=1\nDECL REAL R5=1\nDECL REAL D004=1\nDECL REAL B[9]\nB[7]=1")
    registers = {("R", 5): "speed", ("D", 4): "count", ("B", 7): "jobs[1]", ("F", 1): "flag"}
    found = kept_names({"mode": "MODE_2", "main": "MAIN"}, registers, written)
    assert found == {"mode": "MODE_2", "speed": "R5", "count": "D004", "jobs[1]": "B[7]"}
