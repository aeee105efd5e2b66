"""What is left over of a legalised program that the target's tables do not have."""

from dataclasses import replace

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes import legality
from rpl.passes.legality import Illegal, illegal, kind_of, unguarded
from rpl.project import read_sources
from rpl.source import NOWHERE, source_from_text
from rpl.translation import translate_program

ONE, TWO = ir.IntLiteral(1), ir.IntLiteral(2)
CASES = [
    (ir.While(ir.BoolLiteral(True), ()), "statement While"),
    (ir.Assign(ir.Name("a"), ONE), ""),
    (ir.Builtin("sin", (ONE,)), ""),
    (ir.Builtin("is_reachable", (ONE,)), "function is_reachable"),
    (ir.Binary("mod", ONE, TWO), ""),
    (ir.Binary("bxor", ONE, TWO), "operator bxor"),
    (ir.System("override"), ""),
    (ir.System("moving"), "system variable moving"),
    (ir.Do("text_append", ()), "procedure text_append"),
    (ir.VectorType(), "type VectorType"),
    (ir.RealType(), ""),
]


@pytest.mark.parametrize(("node", "kind"), CASES, ids=lambda one: str(one)[:40])
def test_a_node_is_asked_for_in_the_tables_of_its_class(node: object, kind: str) -> None:
    assert kind_of(node, registry.target("tp").capabilities()) == kind


def test_it_is_told_where_it_stands() -> None:
    read = read_sources([source_from_text("a.src", "DEF a()\nWHILE TRUE\nHALT\nENDWHILE\nEND\n")], "krl", Diagnostics())
    found = list(illegal(read.program, registry.target("tp").capabilities()))
    assert [(one.kind, one.origin.line) for one in found if one.kind.startswith("statement")] == [
        ("statement While", 2)
    ]


def test_what_the_writer_says_otherwise_is_fine() -> None:
    program = ir.Program((ir.Module("m", "krl", routines=(ir.Routine("r", body=(ir.WaitForMotion(),)),)),))
    can = registry.target("tp").capabilities()
    assert not list(illegal(program, can))
    assert [one.kind for one in illegal(program, replace(can, said_otherwise={}))] == ["statement WaitForMotion"]


def test_a_place_with_a_stop_needs_no_second_report() -> None:
    text = "DEF a()\nDECL INT i\nWHILE i<3\ni=i+1\nENDWHILE\nEND\n"
    read = read_sources([source_from_text("a.src", text)], "krl", Diagnostics())
    can = registry.target("tp").capabilities()
    kinds = {one.kind for one in unguarded(read.program, can, ())}
    assert "statement While" in kinds
    reported = Diagnostics()
    lost = legality.LEFT_OVER.__class__("test-lost", Severity.LOSS, "lost")
    for one in illegal(read.program, can):
        reported.report(lost, one.origin)
    assert unguarded(read.program, can, reported.items) == []


def test_what_no_pass_took_away_is_a_warning_of_the_translation(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if a pass had left a kind behind that the writer then wrote somehow."""
    monkeypatch.setattr("rpl.translation.unguarded", lambda *_: [Illegal("statement While", NOWHERE)])
    read = read_sources([source_from_text("a.src", "DEF a()\nHALT\nEND\n")], "krl", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(read, "tp", None, None, diagnostics)
    assert [item.message for item in diagnostics if item.code is legality.LEFT_OVER] == [
        "the target's tables do not have this statement While, and the line was written nevertheless"
    ]


def test_writers_say_few_kinds_in_forms_of_their_own_and_the_record_tells_how() -> None:
    records = {name: registry.target(name).capabilities() for name in registry.target_names()}
    assert len({kind for can in records.values() for kind in can.said_otherwise}) <= 10
    assert [name for name, can in records.items() if not all(can.said_otherwise.values())] == []


RECORD_CASES = [
    ("rapid", ir.ArrayType(ir.IntType(), (3,)), ""),
    ("rapid", ir.NamedType("recipe"), ""),
    ("vplus", ir.NamedType("recipe"), "type NamedType"),
    ("vplus", ir.IntType(), ""),
    ("tp", ir.System("flag", (ONE,)), ""),
    ("inform", ir.System("deceleration_percent"), ""),
    ("tp", ir.System("deceleration_percent"), "system variable deceleration_percent"),
    ("rapid", ir.EnumDeclaration("mode", ("a",)), "declaration EnumDeclaration"),
    ("krl", ir.EnumDeclaration("mode", ("a",)), ""),
    ("tp", ir.Handler((), ()), "handler of errors"),
]


@pytest.mark.parametrize(("target", "node", "kind"), RECORD_CASES, ids=lambda one: str(one)[:40])
def test_what_the_record_says_of_data_and_moves_is_asked_too(target: str, node: object, kind: str) -> None:
    assert kind_of(node, registry.target(target).capabilities()) == kind
