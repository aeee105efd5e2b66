"""Each structural fault has its code; a sound program has none."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.verify import verify
from rpl.ir.walk import expressions, map_children, rewrite, statements, walk
from rpl.source import Comment, Origin

X, ONE = ir.Name("x"), ir.IntLiteral(1)


def codes(program: ir.Program) -> list[str]:
    diagnostics = Diagnostics()
    verify(program, diagnostics)
    return [item.code.name for item in diagnostics]


def program(*body: ir.Statement, **routine: object) -> ir.Program:
    return ir.Program((ir.Module("m", "rpl", (), (ir.Routine("main", body=body, **routine),)),))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        (ir.Assign(X, ONE), []),
        (ir.Assign(ONE, ONE), ["not-assignable"]),
        (ir.Assign(X, ir.Binary("%", X, X)), ["unknown-word"]),
        (ir.Assign(X, ir.Unary("!", X)), ["unknown-word"]),
        (ir.Assign(X, ir.Convert("magic", X)), ["unknown-word"]),
        (ir.Assign(X, ir.Quantity(X, "furlong")), ["unknown-word"]),
        (ir.Assign(X, ir.Builtin("sine", (X,))), ["unknown-word"]),
        (ir.Assign(X, ir.Builtin("sin", (X,))), []),
        (ir.Assign(X, ir.Builtin("sin", ())), ["wrong-argument-count"]),
        (ir.Assign(X, ir.Builtin("round", (X,))), []),
        (ir.Assign(X, ir.Builtin("round", (X, X, X))), ["wrong-argument-count"]),
        (ir.Assign(X, ir.Builtin("format", (X, X, X, X))), []),
        (ir.Assign(X, ir.System("tools")), ["unknown-word"]),
        (ir.Do("increment", (X,)), []),
        (ir.Do("increment", ()), ["wrong-argument-count"]),
        (ir.Goto("nowhere"), ["unknown-label"]),
        (ir.Label("here"), []),
        (ir.ExitLoop(), ["outside-of-loop"]),
        (ir.Loop((ir.If(((X, (ir.ExitLoop(),)),)),)), []),
        (ir.Retry(), ["outside-of-handler"]),
        (ir.TryNext(), ["outside-of-handler"]),
        (ir.Halt("later"), ["unknown-word"]),
        (ir.Move("hop", X), ["unknown-word"]),
        (ir.Move("linear", X, relative="moon"), ["unknown-word"]),
        (ir.If(()), ["empty-branches"]),
    ],
)
def test_statements(statement: ir.Statement, expected: list[str]) -> None:
    assert codes(program(statement)) == expected


def test_jumps_and_handlers() -> None:
    assert codes(program(ir.Goto("A"), ir.Loop((ir.Label("a"),)))) == []
    assert codes(program(ir.Label("a"), ir.Label("A"))) == ["declared-twice"]
    assert codes(program(handlers=(ir.Handler((), (ir.Retry(),)),))) == []
    assert codes(program(ir.Return(), kind="function", returns=ir.IntType())) == ["return-without-value"]


def test_declarations() -> None:
    twice = (ir.Variable("a", ir.IntType()), ir.Variable("A", ir.IntType()))
    assert codes(ir.Program((ir.Module("m", "rpl", twice),))) == ["declared-twice"]
    record = ir.RecordDeclaration("r", (("x", ir.IntType()), ("x", ir.IntType())))
    assert codes(ir.Program((ir.Module("m", "rpl", (record,)),))) == ["declared-twice"]
    assert codes(ir.Program((), entry="main")) == ["unknown-entry"]


def test_walk_meets_every_node_once() -> None:
    body = (ir.If(((X, (ir.Assign(X, ONE),)),), (ir.Wait(ir.Quantity(ONE, "s")),)),)
    assert [type(node).__name__ for node in walk(body)] == [
        "If", "Name", "Assign", "Name", "IntLiteral", "Wait", "Quantity", "IntLiteral",
    ]  # fmt: skip
    assert len(list(expressions(body))) == 5
    assert [type(node).__name__ for node in statements(body)] == ["If", "Assign", "Wait"]


def test_rewrite_keeps_origins_and_what_did_not_change() -> None:
    origin = Origin(comments=(Comment("kept"),))
    kept = ir.Wait(ONE)
    body = ir.If(((X, (ir.Assign(X, ONE, origin=origin), kept)),))

    def change(node: object) -> object:
        return ir.IntLiteral(2) if node == ONE and node is not kept.time else node

    def rename(node: object) -> object:
        return ir.Name("y") if node == X else node

    done = rewrite(body, rename)
    assert isinstance(done, ir.If)
    assert done.branches[0][0] == ir.Name("y")
    assert done.branches[0][1][0].origin is origin
    assert done.branches[0][1][1] is kept
    assert rewrite(body, lambda node: node) is body
    assert map_children(kept, change) == kept

    def double(node: object) -> object:
        return (node, ir.Nothing()) if isinstance(node, ir.Wait) else node

    assert rewrite(body, double).branches[0][1][1:] == (kept, ir.Nothing())
