"""Texts in V+: functions by programs that come along, $DECODE, arguments by value."""

from __future__ import annotations

import pytest
from vplus_helpers import program_of

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program


def translated(text: str, name: str, dialect: str) -> tuple[str, set[str]]:
    """The V+ text, and the outputs that its run switches on."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(name, text)], dialect, diagnostics)
    files = translate_program(read, "vplus", None, None, diagnostics).files
    assert not [item.as_text() for item in diagnostics if item.severity.word in ("error", "loss")]
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "vplus", Diagnostics())
    result = run_program(back.program)
    assert result.status == "finished", result.fault
    return files[0].data.decode("ascii"), {str(name) for _, name, value in result.outputs if value}


@pytest.mark.parametrize(
    "condition",
    [
        'StrFind("a1b2",1,STR_DIGIT)=2',
        'StrMatch("robot arm",1,"arm")=7',
        'StrMatch("robot",1,"x")=6',
        'StrToVal("12.5",n) AND n=12.5',
        'NOT StrToVal("no",n)',
        'ValToStr(TRUE)="TRUE"',
    ],
)
def test_functions_of_texts_come_along(condition: str) -> None:
    text = f"MODULE m\nVAR num n;\nPROC main()\nIF {condition} Set doGood;\nENDPROC\nENDMODULE\n"
    _, on = translated(text, "m.mod", "rapid")
    assert on == {"1"}


def test_decode_is_one_step_again() -> None:
    steps = '$t = "12,,34"\n$a = $DECODE($t, ",", 0)\n$b = $DECODE($t, ",", 1)'
    check = '\nIF ($a == "12") AND ($b == ",,") AND ($t == "34") THEN\nSIGNAL 1\nEND'
    text, on = translated(program_of(steps + check), "p.v2", "vplus")
    assert '$a = $DECODE($t, ",", 0)' in text and '$b = $DECODE($t, ",", 1)' in text
    assert on == {"1"}


def test_brackets_pass_a_value() -> None:
    more = ".PROGRAM change(x)\nx = x+1\n.END\n"
    text, on = translated(
        program_of("n = 1\nCALL change((n))\nCALL change(n)\nIF n == 2 THEN\nSIGNAL 1\nEND", more), "p.v2", "vplus"
    )
    assert "CALL change((n))" in text and on == {"1"}


@pytest.mark.parametrize(
    "condition",
    # M: VAL reads what a program may write as a number, with ^B, ^H and ^ for other bases.
    ['VAL("^HFF") == 255', 'VAL("^B101") == 5', 'VAL("^17") == 15', "VAL($t) == 31", 'VAL("-2.5") == -2.5'],
)
def test_numbers_to_other_bases_in_texts(condition: str) -> None:
    _, on = translated(program_of(f'$t = "^H1F"\nIF {condition} THEN\nSIGNAL 1\nEND'), "p.v2", "vplus")
    assert on == {"1"}


def test_val_stops_behind_the_number() -> None:
    text = program_of('$a = "12 mm"\nIF (VAL($a) == 12) AND (VAL("-2.5kg") == -2.5) THEN\nSIGNAL 1\nEND')
    _, on = translated(text, "p.v2", "vplus")
    assert on == {"1"}
