"""Answers about statements are kept while these are the same objects, and what is passed by holds nothing asked for."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.passes.legalise.kept import keeping, of_node, of_program
from rpl.passes.legalise.kinds import gathering, kinds_in, kinds_of, kinds_within, walk_for
from rpl.project import read_program

SAMPLES = Path(__file__).parents[2] / "samples"
PROJECTS = sorted(path.parent for path in SAMPLES.glob("*/palletiser/expected.toml"))


def assign(name: str, number: int) -> ir.Assign:
    return ir.Assign(ir.Name(name), ir.IntLiteral(number))


def test_the_same_object_is_asked_once() -> None:
    asked: list[object] = []
    question = of_node(lambda node: asked.append(node) or len(asked))
    one, equal = assign("n", 1), assign("n", 1)
    with keeping():
        assert [question(one), question(equal), question(one), question(equal)] == [1, 2, 1, 2]
    assert len(asked) == 2


def test_behind_a_translation_nothing_is_kept() -> None:
    asked: list[object] = []
    question = of_node(lambda node: asked.append(node) or len(asked))
    one = assign("n", 1)
    assert [question(one), question(one)] == [1, 2]
    with keeping():
        assert [question(one), question(one)] == [3, 3]
        with keeping():
            assert question(one) == 3
    assert question(one) == 4


def test_answers_about_the_last_program_are_kept() -> None:
    asked: list[object] = []
    question = of_program(lambda program: asked.append(program) or len(asked))
    first, second = ir.Program(()), ir.Program(())
    with keeping():
        assert [question(first), question(first), question(second), question(first)] == [1, 1, 2, 3]


@gathering("Assign")
def assigned(statement: ir.Statement) -> list[str]:
    match statement:
        case ir.Assign(target=ir.Name(id=name)):
            return [name]
    return []


BODIES = [
    (assign("a", 1), {"a"}),
    (ir.Nothing(), set()),
    (ir.If(((ir.Name("on"), (assign("a", 1), ir.Nothing())),), (assign("b", 2),)), {"a", "b"}),
    (ir.Loop((ir.If(((ir.Name("on"), (assign("a", 1),)),)), ir.ExitLoop())), {"a"}),
    (ir.Switch(ir.Name("n"), (ir.Case((ir.IntLiteral(1),), (assign("a", 1),)),), (assign("b", 1),)), {"a", "b"}),
    (ir.DeclareInterrupt(ir.IntLiteral(1), ir.Name("on"), assign("a", 1)), {"a"}),
]


@pytest.mark.parametrize(("statement", "names"), BODIES, ids=range(len(BODIES)))
def test_a_question_about_a_statement_is_asked_of_all_in_it(statement: ir.Statement, names: set[str]) -> None:
    with keeping():
        assert assigned(statement) == assigned(statement) == names
    assert assigned(statement) == names


@pytest.mark.parametrize("folder", PROJECTS, ids=[path.parent.name for path in PROJECTS])
def test_what_is_passed_by_holds_nothing_asked_for(folder: Path) -> None:
    program = read_program([folder], diagnostics=Diagnostics()).program
    nodes = list(walk(*program.modules))
    with keeping():
        assert kinds_in(program) == {kind for node in nodes for kind in kinds_of(node)}
        for node in nodes:
            assert kinds_within(node) == {kind for one in walk(node) for kind in kinds_of(one)}
        for kind in sorted(kinds_in(program)):
            met = [id(one) for one in walk_for({kind}, *program.modules) if kind in kinds_of(one)]
            assert met == [id(one) for one in nodes if kind in kinds_of(one)]
