"""Templates of statements: what is read and reported is the same with them and without."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_runs import NUMBERS, whole

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.project import ReadProgram, read_program
from rpl.reading import templates
from rpl.source import Origin, Source, source_from_text

ROWS = st.lists(st.lists(NUMBERS, min_size=7, max_size=7), min_size=3, max_size=12)
POINT = "[[{},{},{}],[{},{},{},0.5],[{},0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
# Statements of which most read by templates, with those beside them that must not: what a number or a name decides.
LINES = (
    "MoveL {point},v100,z10,tool0;",
    "MoveJ {point},v200\\V:=150,fine,tool1\\WObj:=wobj2;",
    "MoveL p{at},v100,z10,tool0;",
    "MoveL p{at},s{at},z10,tool0;",
    "MoveL Offs(p1,0,0,{at}),v100,z10,tool0;",
    "MoveC p1,{point},v100,z1,tool0; ! remark {at}",
    "SetDO do{at},1;",
    "r{at} {at};",
    "n1:={at};",
    "b1:=di{at}=1;",
    "TriggL {point},v100,t1,z10,tool0;",
    "SearchL \\Sup,di{at},p2,{point},v100,tool0;",
    "MoveL {point},v100,z10,tool0",
    "MoveL [[1E3,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v{at},z10,tool0;",
    "MoveL {point},v100,z10,tool0 ENDIF;",
    'Say"p1 {at}";',
    "MoveAbsJ [[{at}-1,2,3,4,5,6],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,z10,tool0;",
)
DATA = (
    "CONST robtarget p{at}:={point};",
    "LOCAL VAR robtarget q{at}:={point};",
    "CONST num k{at}:={at};",
    "PERS num a{at}{{3}}:=[1,{at},-2];",
    "CONST bool c{at}:={at}=1;",
    "CONST speeddata s{at}:=[{at},500,5000,1000];",
    "VAR rec3 x{at}:=[{at},[1,2]];",
)


def program(rows: list[list[str]], lines: list[str], data: list[str]) -> Source:
    points = [(str(at), POINT.format(*row)) for at, row in enumerate(rows)]
    written = [[line.format(at=at, point=point) for at, point in points for line in kinds] for kinds in (data, lines)]
    head = [
        "MODULE long",
        "PERS tooldata tool1:=[TRUE,[[0,0,1],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];",
        "VAR num n1;",
    ]
    routines = ["ENDPROC", "PROC r1(num x1)", "ENDPROC", "PROC r2(VAR num x1)", "ENDPROC", "ENDMODULE", ""]
    text = [*head, "RECORD rec3", "num x1;", "pos p3;", "ENDRECORD", *written[0], "PROC main()", *written[1], *routines]
    return source_from_text("long.mod", "\r\n".join(text))


def read(source: Source, most: int = 20_000) -> tuple[ReadProgram, list[tuple[str, int, int, str]]]:
    """What is read, and what is told; `most` of -1: without templates."""
    diagnostics = Diagnostics()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(templates, "_MOST", most)
        found = read_program([source], diagnostics=diagnostics)
    return found, [(item.code.name, item.origin.start, item.origin.end, item.message) for item in diagnostics]


@given(
    ROWS,
    st.lists(st.sampled_from(LINES), min_size=1, max_size=6),
    st.lists(st.sampled_from(DATA), max_size=4, unique=True),
)
@settings(max_examples=80, deadline=None)
def test_templates_give_what_reading_line_by_line_gives(
    rows: list[list[str]], lines: list[str], data: list[str]
) -> None:
    source = program(rows, lines, data)
    (fast, told), (slow, told_slowly) = read(source), read(source, -1)
    assert whole(fast.lowered) == whole(slow.lowered)
    assert whole(fast.reduced) == whole(slow.reduced)
    assert told == told_slowly
    assert fast.files == slow.files


def test_lists_of_points_and_moves_to_them_are_read_by_templates(monkeypatch: pytest.MonkeyPatch) -> None:
    alone: list[str] = []
    usual = templates.Templates.usual

    def read_alone(reader: templates.Templates, text: str, origin: Origin) -> object:
        alone.append(text)
        return usual(reader, text, origin)

    monkeypatch.setattr(templates.Templates, "usual", read_alone)
    rows = [[f"{at}.5", f"-{at}.0", "7.25", "0.5", "0.5", "0.5", "-1"] for at in range(40)]
    found = read(program(rows, ["MoveL p{at},v100,z10,tool0;"], ["CONST robtarget p{at}:={point};"]))[0]
    assert len(alone) < 40  # of 80, and those around them
    moves = [node for node in walk(*found.reduced.modules) if isinstance(node, ir.Move)]
    assert [node.target for node in moves] == [ir.Name(f"p{at}") for at in range(40)]
    assert [(move.origin.line, move.origin.text) for move in moves[-1:]] == [(88, "MoveL p39,v100,z10,tool0;")]
