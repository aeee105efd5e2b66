"""Parts of texts that may lie outside of them, for controllers that give a shorter text there: the program stops first.

A source whose controller stops at such a part would go on with another text. What a counting loop over the text's own
length or a length that was cut to what is left proves to be inside stays as it is.
"""

from __future__ import annotations

from rpl import ir, registry
from rpl.passes.capabilities import Fault
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.raising import raising_of
from rpl.passes.legalise.facts.usage import assigned_in
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.stages import legalising

_SIMPLE = (ir.Name, ir.IntLiteral, ir.TextLiteral)


@legalising(
    unless=lambda context: (
        Fault.TEXT_PART in context.capabilities.errors.faults
        or (
            context.source in registry.target_names()
            and Fault.TEXT_PART not in registry.target(context.source).capabilities().errors.faults
        )
    ),
    sees=("function text_part",),
)
def checked_text_parts(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that cut, where the source does not. A program that catches the error keeps its handlers."""
    can = context.capabilities
    if not can.errors.handlers and "out_of_range" in raising_of(program).caught:
        return program

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Checks(editor).body)

    return edit_routines(program, context, work)


def _part(node: object) -> bool:
    return isinstance(node, ir.Builtin) and node.function == "text_part"


class _Checks(Hoister):
    """One routine. `counted`: counters of the loops around, with the texts whose characters they count."""

    def __init__(self, editor: Editor) -> None:
        super().__init__(editor, self.checked)
        self.counted: list[tuple[str, str]] = []

    def checked(self, expression: ir.Expression) -> Lowered | None:
        if not isinstance(expression, ir.Builtin) or not _part(expression) or len(expression.arguments) != 3:
            return None
        if self.inside(*expression.arguments):
            return None
        before: list[ir.Statement] = []
        settled: list[ir.Expression] = []
        for value in expression.arguments:
            type = self.editor.type_of(value)
            if not isinstance(value, _SIMPLE) and constant_number(value, self.editor.scope) is None:
                name = self.editor.temporary("part", type or ir.IntType())
                before.append(ir.Assign(name, value))
                value = name
            settled.append(value)
        text, first, count = settled
        tests = self.tests(text, first, count)
        wrong = tests[0]
        for test in tests[1:]:
            wrong = ir.Binary("or", wrong, test)
        stop = (ir.Message("error", ir.TextLiteral("A part of a text is outside")), ir.Halt("exit"))
        part = ir.Builtin("text_part", (text, first, count), origin=expression.origin)
        return (*before, ir.If(((wrong, stop),))), part

    def tests(self, text: ir.Expression, first: ir.Expression, count: ir.Expression) -> list[ir.Expression]:
        """What must not be."""
        place, size = (constant_number(value, self.editor.scope) for value in (first, count))
        tests: list[ir.Expression] = []
        if place is None or place < 1:
            tests.append(ir.Binary("<", first, ir.IntLiteral(1)))
        if size is None or size < 0:
            tests.append(ir.Binary("<", count, ir.IntLiteral(0)))
        last: ir.Expression = ir.Binary("-", ir.Binary("+", first, count), ir.IntLiteral(1))
        if size == 1:
            last = first
        elif place == 1:
            last = count
        elif place is not None and size is not None:
            last = ir.IntLiteral(int(place + size) - 1)
        return [*tests, ir.Binary(">", last, ir.Builtin("text_length", (text,)))]

    def inside(self, text: ir.Expression, first: ir.Expression, count: ir.Expression) -> bool:
        """Is the part surely one of the text?"""
        if isinstance(count, ir.Builtin) and count.function == "min":
            return True
        place, size = (constant_number(value, self.editor.scope) for value in (first, count))
        if isinstance(text, ir.TextLiteral) and place is not None and size is not None:
            return place >= 1 and size >= 0 and place + size - 1 <= len(text.value)
        if not isinstance(first, ir.Name) or not isinstance(text, ir.Name) or size != 1:
            return False
        return (first.id.lower(), text.id.lower()) in self.counted

    def placed(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.For(
                counter=counter,
                start=start,
                stop=ir.Builtin(function="text_length", arguments=(ir.Name(id=text),)),
                step=step,
                body=body,
            ) if (constant_number(start, self.editor.scope) or 0) >= 1 and _upwards(step):
                changed = {name.lower() for name in assigned_in(body)}
                if not {counter.lower(), text.lower()} & changed:
                    self.counted.append((counter.lower(), text.lower()))
                    done = super().placed(statement)
                    self.counted.pop()
                    return done
        return super().placed(statement)


def _upwards(step: ir.Expression | None) -> bool:
    return step is None or (isinstance(step, ir.IntLiteral) and step.value > 0)


__all__ = ["checked_text_parts"]
