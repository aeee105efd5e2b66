"""The vocabulary agrees with the grammar, and names that look like keywords survive."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir import words
from rpl.source import source_from_text
from rpl.writing.target import WriteContext

sys.path.insert(0, str(Path(__file__).resolve().parent))
import reserved as grammar_words


def test_reserved_words_are_those_of_the_grammar() -> None:
    assert grammar_words.reserved() == words.RESERVED


def test_every_keyword_survives_as_a_name_everywhere() -> None:
    """A name is written bare only where it reads back as that name."""
    modules = []
    for word in sorted(grammar_words.keywords() | words.FUNCTION_WORDS | words.PROCEDURE_WORDS | {"mm", "s", "kg"}):
        modules.append(ir.Module(word, "rpl", _declared(word), (_routine(word),)))
    program = ir.Program(tuple(modules))
    text = registry.target("rpl").write(program, WriteContext(Diagnostics()))[0].data.decode()
    diagnostics = Diagnostics()
    again = registry.dialect("rpl").read([source_from_text("t.rpl", text)], diagnostics).program
    assert [item.as_text() for item in diagnostics] == []
    assert again == program


def _declared(word: str) -> tuple[ir.Declaration, ...]:
    named = ir.NamedType(word)
    return (
        ir.Variable(word, named, ir.Name(word)),
        ir.RecordDeclaration(word, ((word, named),)),
        ir.EnumDeclaration(word, (word,)),
        ir.SignalDeclaration(word, ir.Signal("digital_in", name=word)),
    )


def _routine(word: str) -> ir.Routine:
    name = ir.Name(word)
    return ir.Routine(
        word,
        parameters=(ir.Parameter(word, ir.NamedType(word)),),
        body=(
            ir.Assign(name, name),
            ir.Assign(ir.Field(name, word), ir.Binary("+", name, ir.Unary("not", name))),
            ir.Assign(ir.Index(name, (name,)), ir.Aggregate(((word, name), (None, name)), word)),
            ir.CallRoutine(word, (ir.Argument(name, word, word), ir.Argument(None, word), ir.Argument(name))),
            ir.CallRoutine("", (ir.Argument(name),), name),
            ir.Return(ir.Call(word, (ir.Argument(name),))),
            ir.Move("joint", name, via=name, tool=name, speed=ir.Speed(name, name, name, name, name)),
            ir.Move("joint", name, blend=ir.BlendDistance(name, name), triggers=(name,), settings=((name, name),)),
            ir.Move("joint", name, blend=ir.BlendPercent(name, ir.BlendDistance(name)), relative="tool"),
            ir.Move("linear", name, blend=ir.BlendSpeed(name), search=ir.Search(name, name)),
            ir.Trigger("start", ir.CallRoutine(word), name, name, name),
            ir.DefineTrigger(name, ir.Trigger("end", ir.Assign(name, name)), name),
            ir.Wait(name, True),
            ir.WaitUntil(name, name, name, word, True),
            ir.For(word, name, name, name, (), True, True, True),
            ir.If(((name, ()), (name, (ir.Label(word), ir.Goto(word)))), (ir.Raise(name),)),
            ir.Switch(name, (ir.Case((name, name), ()),), None),
            ir.DeclareInterrupt(name, name, ir.Assign(name, name), True),
            ir.ConnectInterrupt(name, word),
            ir.OrderInterrupt(name, "edge", name, name, True),
            ir.ControlInterrupt("on", name),
            ir.Message("state", name, name),
            ir.Dialog(name, name, (name, None), "number", name, name, name),
            ir.Pulse(name, name, name),
            ir.SetAfter(name, name, name),
            ir.Clock("start", name),
            ir.TaskControl("start", word, (ir.Argument(name),)),
            ir.Assign(name, ir.Quantity(name, "mm/s")),
            ir.Assign(name, ir.Magnitude(name, "inch")),
        ),
        handlers=(ir.Handler((name, name), ()),),
    )


ODD_TEXTS = ["", "plain", 'a"b', "a`b", "\\", "\n\t\r", "\x00\x1f\u2028", "\ud800", "😀", "\\u0041"]


@pytest.mark.parametrize("text", ODD_TEXTS)
def test_quoted_text_reads_back(text: str) -> None:
    for quote in '"`':
        assert words.disclose(words.enclose(text, quote)) == text
        assert "\n" not in words.enclose(text, quote)
