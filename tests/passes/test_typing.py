"""The normal form: what passes.typing decides about division, conversions, components and aggregates."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text

KRL = """DEF CASES()
DECL INT I, J
DECL REAL R
DECL BOOL B
DECL CHAR C, S[10]
DECL FRAME F
DECL E6POS P
DECL E6AXIS Q
{statement}
END
"""


def lowered(statement: str) -> tuple[ir.Statement, Diagnostics]:
    diagnostics = Diagnostics()
    source = source_from_text("cases.src", KRL.format(statement=statement))
    program = read_sources([source], "krl", diagnostics).program
    (routine,) = program.modules[0].routines
    return routine.body[0], diagnostics


def value_of(statement: str) -> ir.Expression:
    found, diagnostics = lowered(statement)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    assert isinstance(found, ir.Assign)
    return found.value


@pytest.mark.parametrize(
    ("statement", "op"),
    [
        ("I = I / J", "div"),  # INT/INT truncates: Expert Programming p.26
        ("R = I / J", "div"),  # the operands decide, not the place of the result
        ("R = R / J", "/"),
        ("R = I / 2.0", "/"),
        ("R = P.X / 2", "/"),
    ],
)
def test_division_goes_by_the_operands(statement: str, op: str) -> None:
    value = value_of(statement)
    assert isinstance(value, ir.Binary)
    assert value.op == op


@pytest.mark.parametrize(
    ("statement", "how"),
    [
        ("I = R", "round_half_away"),  # REAL to INT rounds: Expert Programming p.25
        ("I = R * 2", "round_half_away"),
        ("C = I", "char"),
        ("I = C", "code"),
    ],
)
def test_silent_conversions_are_written_down(statement: str, how: str) -> None:
    value = value_of(statement)
    assert isinstance(value, ir.Convert)
    assert value.how == how


@pytest.mark.parametrize("statement", ["R = I", "I = J + 2", "B = I > R", "P = $POS_ACT", "F = P"])
def test_nothing_is_converted_without_need(statement: str) -> None:
    assert not isinstance(value_of(statement), ir.Convert)


def test_aggregates_take_the_type_of_their_place() -> None:
    frame = value_of("F = {X 1, A 2.5}")
    assert frame == ir.Aggregate((("x", ir.IntLiteral(1)), ("a", ir.RealLiteral(2.5))), type_name="pose")
    target = value_of("P = {X 1, S 2, T 35, E1 0}")
    assert isinstance(target, ir.Aggregate)
    assert (target.type_name, [name for name, _ in target.entries]) == ("target krl", ["x", "s", "t", "e1"])
    joints = value_of("Q = {A1 0, A3 90}")
    assert isinstance(joints, ir.Aggregate)
    assert (joints.type_name, [name for name, _ in joints.entries]) == ("joints", ["j1", "j3"])


def test_motion_targets_are_typed_by_their_components() -> None:
    move, _ = lowered("PTP {A3 45}")
    assert isinstance(move, ir.Move)
    assert isinstance(move.target, ir.Aggregate)
    assert move.target.type_name == "joints"
    move, _ = lowered("LIN P:{X 10, Y 0, Z 0, A 0, B 0, C 0}")
    assert isinstance(move, ir.Move)
    assert isinstance(move.target, ir.Binary)
    assert isinstance(move.target.right, ir.Aggregate)
    assert move.target.right.type_name == "pose"


@pytest.mark.parametrize(
    ("statement", "code"),
    [
        ("B = 1", "type-mismatch"),
        ("I = TRUE", "type-mismatch"),
        ("I = Q.X", "unknown-component"),
        ("I = NOBODY", "unknown-name"),
        ("SOMEWHERE()", "unknown-routine"),
    ],
)
def test_what_is_wrong_is_reported_with_its_place(statement: str, code: str) -> None:
    _, diagnostics = lowered(statement)
    found = [item for item in diagnostics if item.code.name == code]
    assert [item.origin.line for item in found] == [9]


def test_normalising_twice_changes_nothing() -> None:
    from rpl.passes.typing import normalise

    source = source_from_text(
        "cases.src", KRL.format(statement="I = R / 2\nP = {X 1, S 2}\nF.A = P.B / 2\nLIN P C_DIS")
    )
    program = read_sources([source], "krl", Diagnostics()).program
    assert normalise(program, Diagnostics()) == program
