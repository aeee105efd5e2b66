"""Statements that a value needs first run where the value is wanted, as often as it is, and never otherwise."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import is_statement
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import children
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import Pass, legalising
from rpl.project import read_sources
from rpl.source import source_from_text

from .common import PLAIN, nodes, same_run

MODULE = """VAR n: INT = 0

FUNCTION probe(i: INT): INT
    n = n + 1
    MESSAGE "probe " & number_text(i, 0)
    RETURN i
END FUNCTION

PROCEDURE main()
    VAR k: INT = 0
    VAR i: INT = 0
%s
    MESSAGE "end " & number_text(k, 0)
END PROCEDURE
"""


BODIES = {
    "the condition of a loop": "WHILE probe(k) < 2\nk = k + 1\nEND WHILE",
    "the end of a loop": "REPEAT\nk = k + 1\nUNTIL probe(k) > 2",
    "the end of a loop that goes on early": "REPEAT\nk = k + 1\nIF k = 2 THEN\nCONTINUE\nEND IF\nUNTIL probe(k) > 1",
    "a later branch": "IF probe(1) = 2 THEN\nk = 1\nELSEIF probe(3) = 3 THEN\nk = 2\nEND IF",
    "the bounds of a loop": "FOR i = probe(1) TO probe(3)\nk = k + i\nEND FOR",
    "a choice": "SWITCH probe(2)\nCASE 1\nk = 1\nCASE 2\nk = 2\nEND SWITCH",
    "what is decided already": "IF k > 0 AND THEN probe(1) = 1 THEN\nk = 7\nEND IF",
}


class _Whole(Rewriter):
    """The value of each call is kept before it is used."""

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        if not isinstance(done, ir.Call):
            return done
        kept = self.temporary(ir.IntType())
        self.before.append(ir.Assign(kept, done))
        return kept


@legalising()
def whole(program: ir.Program, context: Context) -> ir.Program:
    return _Whole(program, context).program()


@legalising()
def by_rule(program: ir.Program, context: Context) -> ir.Program:
    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def rule(expression: ir.Expression) -> Lowered | None:
            if not isinstance(expression, ir.Call):
                return None
            kept = editor.temporary("tmp", ir.IntType())
            return (ir.Assign(kept, expression),), kept

        return edit_bodies(routine, Hoister(editor, rule).body)

    return edit_routines(program, context, work)


@pytest.mark.parametrize("rewriting", [whole, by_rule])
@pytest.mark.parametrize("name", BODIES)
def test_calls_in_front_of_their_statements(name: str, rewriting: Pass) -> None:
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("t.rpl", MODULE % BODIES[name])], "rpl", diagnostics).program
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    after = same_run(program, PLAIN, rewriting)
    statements = [one for one in nodes(after) if is_statement(one) and not isinstance(one, ir.Assign)]
    assert not [one for one in statements if any(isinstance(part, ir.Call) for part in children(one))]
