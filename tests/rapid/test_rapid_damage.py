"""Damage costs the damaged statement alone; nothing of a text is lost; nonsense never raises."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from rapid_helpers import read

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.reading.assemble import assemble
from rpl.source import source_from_bytes, source_from_text
from rpl.writing.ledger import blocks

PROGRAM = """%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%
MODULE Cell(SYSMODULE,, READONLY)
  ! remark
  PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],
    [1.2,[0,0,60], ! centre of gravity
     [1,0,0,0],0,0,0]];
  CONST robtarget pPick:=[[100,50,20],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num nCount:=0;
  VAR string sText:="a;b!c";
  VAR bool bDone;

  PROC main()
    VAR num n;
    nCount:=nCount+1;
    MoveL Offs(pPick,0,0,80),v1000,z20,tGrip\\WObj:=wobj0; ! over it
    Set do1;
    TPErase;
    n:=3;
    Stop;
    IF di1=1 AND n>2 THEN
      WaitTime 0.5;
      other n,"text";
    ELSE
      RETURN;
    ENDIF
    FOR i FROM 1 TO 3 DO
      Incr nCount;
    ENDFOR
    TEST n
    CASE 1,2:
      TPWrite "one";
    DEFAULT:
      Reset do1;
    ENDTEST
    IF bDone GOTO last;
    n:=n*2
      -1;
    other n,
      sText;
  last:
    other n,sText;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME RETRY;
    TRYNEXT;
  ENDPROC

  LOCAL PROC other(num a,string b)
    TPWrite b\\Num:=a;
  ENDPROC
ENDMODULE
"""
LINES = PROGRAM.splitlines()
# Lines that hold exactly one simple statement.
SIMPLE = [
    number
    for number, line in enumerate(LINES, 1)
    if line.startswith("    ") and line.split("!")[0].rstrip().endswith(";") and "1,0,0,0" not in line
    and "VAR" not in line and "-1;" not in line and "  sText;" not in line
]  # fmt: skip


def flat(program: ir.Program) -> Iterator[tuple[int, ir.Statement]]:
    """Line and simple statement, of all routines."""

    def walk(body: ir.Body) -> Iterator[tuple[int, ir.Statement]]:
        for statement in body:
            inner = blocks(statement)
            if inner and not isinstance(statement, ir.Move):
                for one in inner:
                    yield from walk(one)
            elif not isinstance(statement, ir.Nothing):
                yield statement.origin.line, statement

    for module in program.modules:
        for routine in module.routines:
            yield from walk(routine.body)
            for handler in routine.handlers:
                yield from walk(handler.body)


WHOLE = list(flat(read(PROGRAM)[0].program))


def test_the_whole_program_reads() -> None:
    result, diagnostics = read(PROGRAM)
    assert not diagnostics.items
    assert result.files[0].opaque == 0
    assert len(WHOLE) == 20


@settings(max_examples=300, deadline=None)
@given(st.sampled_from(SIMPLE), st.data())
def test_damage_costs_the_damaged_statement_alone(number: int, data: st.DataObject) -> None:
    line = LINES[number - 1]
    start = len(line) - len(line.lstrip())
    at = data.draw(st.integers(start, len(line) - 1))
    sign = data.draw(st.sampled_from(["", ";", ",", ":", ")", "(", "]", "x", "@", "#", '"', "!", "%", "\\", "}", "="]))
    cut = data.draw(st.integers(0, 1))
    assume(not ("IF" in line and sign == "!"))  # what is left of a compact IF may take the next line as its statement
    damaged = "\n".join((*LINES[: number - 1], line[:at] + sign + line[at + cut :], *LINES[number:]))
    result, _ = read(damaged)
    rest = [item for item in flat(result.program) if item[0] != number]
    assert rest == [item for item in WHOLE if item[0] != number]


@pytest.mark.parametrize("number", SIMPLE)
def test_a_missing_semicolon_costs_one_statement(number: int) -> None:
    line = LINES[number - 1]
    damaged = "\n".join(
        (*LINES[: number - 1], line.replace(";", "", 1) if '"a;' not in line else line, *LINES[number:])
    )
    result, diagnostics = read(damaged)
    rest = [item for item in flat(result.program) if item[0] != number]
    assert rest == [item for item in WHOLE if item[0] != number]
    assert len(diagnostics.items) == 1


def ledger_of(text: str) -> tuple[str, str]:
    """The text and what its claims rebuild."""
    from rpl.dialects.rapid.blocks import Blocks
    from rpl.dialects.rapid.parser import RapidParser
    from rpl.dialects.rapid.project import survey
    from rpl.dialects.rapid.splitter import split
    from rpl.dialects.rapid.statements import Statements

    source, diagnostics, parser = source_from_text("m.mod", text), Diagnostics(), RapidParser()
    project = survey([source], ())
    lowering = Statements(project, "m.mod", diagnostics)
    building = Blocks(project, diagnostics)
    assembly = assemble(source, "rapid", split(source, parser), parser, lowering.lower, building.build, diagnostics)
    assert not assembly.ledger.gaps()
    return source.text, assembly.ledger.rebuilt()


def test_the_text_is_rebuilt_from_its_claims() -> None:
    text, rebuilt = ledger_of(PROGRAM)
    assert rebuilt == text


def test_a_comment_at_a_break_between_damaged_statements_is_kept() -> None:
    text, rebuilt = ledger_of("1\n!" + PROGRAM)
    assert rebuilt == text


@settings(max_examples=200, deadline=None)
@given(st.data())
def test_every_text_is_accounted_for(data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(PROGRAM)))
    length = data.draw(st.integers(0, 60))
    extra = data.draw(st.text(alphabet='MODULE;"!%<>[](){}:=\\ \n\x00é1.', max_size=12))
    text, rebuilt = ledger_of(PROGRAM[:at] + extra + PROGRAM[at + length :])
    assert rebuilt == text


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=300))
def test_nonsense_is_refused_or_reported_but_never_raises(data: bytes) -> None:
    dialect = registry.dialect("rapid")
    source = source_from_bytes("x.mod", data)
    assert 0 <= dialect.recognise("x.mod", source.text) <= 100
    dialect.read([source], Diagnostics())


def test_an_encoded_module_is_refused_politely() -> None:
    data = bytes([0xFC, 1, 2, 3, 200, 7, 0, 255, 9, 14]) * 50
    diagnostics = Diagnostics()
    result = registry.dialect("rapid").read([source_from_bytes("a.mod", data)], diagnostics)
    assert [item.code.name for item in diagnostics] == ["encoded-module"]
    assert result.program.modules == ()


@pytest.mark.parametrize(
    "text",
    [
        "MODULE m\nPROC main()\nn:=" + "(" * 5000 + ";\nENDPROC\nENDMODULE",
        "MODULE m\nPROC main()\n" + "IF TRUE THEN\n" * 300 + "ENDPROC\nENDMODULE",
        "MODULE m\nVAR num a{9}:=[" + "1," * 200_000 + "1];\nENDMODULE",
        "MODULE m\nPROC main()",
        "MODULE m\nPROC a()\nPROC b()\nENDPROC\nENDMODULE",
        "ENDMODULE ENDPROC ELSE CASE 1: DEFAULT: ERROR",
        'MODULE m\nVAR string s:="never closed;\nVAR num n;\nENDMODULE',
    ],
)
def test_strange_texts_end_with_a_report_at_most(text: str) -> None:
    result, diagnostics = read(text)
    assert result.files[0].statements > 0
    assert all(item.origin.line for item in diagnostics)
