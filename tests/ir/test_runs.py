"""Runs of moves: what is read, checked and reported is the same whether lines are taken at once or one by one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.project import ReadProgram, read_program
from rpl.reading import runs
from rpl.reading.ledger import Ledger
from rpl.source import Origin, Source, source_from_text

NUMBERS = st.one_of(
    st.sampled_from(("0", "-0", "0.0", "-0.0", "5", "-5", ".5", "7.", "180", "-179.9999", "0.10000")),
    st.floats(-900, 900).map(lambda number: f"{number:.3f}"),
    st.integers(-900, 900).map(str),
)
ROWS = st.lists(st.lists(NUMBERS, min_size=6, max_size=6), min_size=1, max_size=12)


def krl(rows: list[list[str]], between: str = "") -> Source:
    moves = [f"LIN {{{','.join(map(' '.join, zip('XYZABC', row, strict=True)))}}} C_DIS" for row in rows]
    text = ["&ACCESS RVP", "DEF long()", "$APO.CDIS=5", *moves, between, *moves, "END", ""]
    return source_from_text("long.src", "\n".join(text))


def rapid(rows: list[list[str]], between: str = "") -> Source:
    end = "[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
    moves = [f"  MoveL [[{a},{b},{c}],[{d},{e},{f},0.5],{end},v100,z10,tool0;" for a, b, c, d, e, f in rows]
    text = ["MODULE long", "PROC main()", "ConfL \\Off;", *moves, between, *moves, "ENDPROC", "ENDMODULE", ""]
    return source_from_text("long.mod", "\r\n".join(text))


Write = Callable[[list[list[str]], str], Source]


def read(source: Source, shortest: int) -> tuple[ReadProgram, list[tuple[str, int, str]]]:
    diagnostics = Diagnostics()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runs, "SHORTEST", shortest)
        found = read_program([source], diagnostics=diagnostics)
    return found, [(item.code.name, item.origin.start, item.message) for item in diagnostics]


def whole(node: object) -> object:
    """All that a node is, with what comparing nodes leaves out: spellings and places."""
    if isinstance(node, Origin):
        return node.start, node.end, node.comments
    if isinstance(node, tuple):
        return tuple(map(whole, node))
    if is_dataclass(node) and not isinstance(node, type):
        return type(node), tuple(whole(getattr(node, one.name)) for one in fields(node))
    return node


def taken(program: ir.Program) -> list[ir.Run]:
    return [node for node in walk(*program.modules) if isinstance(node, ir.Run)]


@given(ROWS, st.sampled_from((krl, rapid)), st.sampled_from(("", "!", ";remark", "HALT")))
@settings(max_examples=60, deadline=None)
def test_runs_are_what_reading_line_by_line_gives(rows: list[list[str]], write: Write, between: str) -> None:
    source = write(rows * 3, between)
    (fast, told), (slow, told_slowly) = read(source, 2), read(source, 10**9)
    assert not taken(slow.reduced)
    assert whole(fast.program) == whole(slow.program)
    assert whole(fast.raw) == whole(slow.raw)
    assert told == told_slowly
    assert fast.files == slow.files


@pytest.mark.parametrize(("write", "between"), [(krl, "HALT"), (rapid, "Stop;")])
def test_long_lists_of_points_are_runs(write: Write, between: str) -> None:
    rows = [[f"{at}.5", f"-{at}", "7.25", "0.5", "0.5", "0.5"] for at in range(40)]
    found = taken(read(write(rows, between), runs.SHORTEST)[0].reduced)
    assert [len(run) for run in found] == [36, 36]
    assert found[0].columns.values[:, 0].tolist() == [at + 0.5 for at in range(4, 40)]
    assert [found[0].columns.origin(at).line for at in (0, 35)] == [8, 43]


@pytest.mark.parametrize(
    "line",
    [
        'LIN {X 1,Y 2,Z 3,A 0,B 0,C 0} C_DIS ; "remark"',  # a comment belongs to its line
        "$OUT[1]=TRUE",  # no move
        "LIN {X 1E3,Y 2,Z 3,A 0,B 0,C 0",  # cannot be read
    ],
)
def test_other_lines_stay_alone(line: str) -> None:
    source = source_from_text("long.src", "\n".join(["DEF long()", *[line] * 60, "END", ""]))
    assert not taken(read(source, 2)[0].reduced)


def test_what_is_reported_of_one_move_is_reported_of_each() -> None:
    line = "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0,S 2.5,Q 4} C_DIS"
    source = source_from_text("long.src", "\n".join(["DEF long()", *[line] * 60, "END", ""]))
    told = read(source, 2)[1]
    assert told == read(source, 10**9)[1]
    assert [name for name, _, _ in told].count("unknown-component") == 60


def test_what_reading_reports_of_one_move_it_reports_of_each() -> None:
    place = "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
    line = rf"SearchL \Sup, di1, found, {place}, v100, tool0;"
    text = ["MODULE long", "VAR robtarget found;", "PROC main()", *[line] * 60, "ENDPROC", "ENDMODULE", ""]
    source = source_from_text("long.mod", "\n".join(text))
    fast, told = read(source, 2)
    assert told == read(source, 10**9)[1]
    assert isinstance(fast.program.modules[0].routines[0].body[-1], ir.Move)
    assert [name for name, _, _ in told].count("option-without-effect") == 60


def test_the_claims_of_runs_rebuild_the_source() -> None:
    source = krl([["1", "2", "3", "4", "5", "6"]] * 50)
    [first, second] = taken(read(source, 2)[0].lowered)
    ledger = Ledger(source)
    for run in (first, second):
        ledger.claim(int(run.columns.starts[0]), int(run.columns.ends[-1]), "lowered")
    assert ledger.rebuilt() == source.text


def test_runs_in_deep_blocks_come_out_too() -> None:
    moves = ["LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}"] * 40
    text = ["DEF deep()", *["IF TRUE THEN"] * 1000, *moves, *["ENDIF"] * 1000, "END", ""]
    found = read(source_from_text("deep.src", "\n".join(text)), runs.SHORTEST)[0]
    assert len(taken(found.reduced)) == 1
    assert sum(isinstance(node, ir.Move) for node in walk(*found.program.modules)) == 40
