"""Groups of signals bit by bit, for targets that have single signals only (or groups that the controller declares).

Written: each bit gets its share of the number. Read: the bits are added up in front of the statement. Groups with
computed numbers stay for the writer.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.editing import Editor, Hoister, Lowered, edit_bodies, edit_routines, expansion

_WIDEST = 32


def groups_to_bits(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that cannot name a group by its first and last signal."""
    if context.capabilities.signal_groups:
        return program

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Bits(editor).body)

    return edit_routines(program, context, work)


def _bits(signal: ir.Expression) -> list[ir.Signal]:
    """The signals of a group with constant numbers, lowest bit first; empty for everything else."""
    match signal:
        case ir.Signal(kind=kind, index=ir.IntLiteral(value=first), last=ir.IntLiteral(value=last), name=None):
            if 0 <= last - first < _WIDEST:
                single = kind.replace("group", "digital")
                return [ir.Signal(single, ir.IntLiteral(n), origin=signal.origin) for n in range(first, last + 1)]
    return []


class _Bits(Hoister):
    def __init__(self, editor: Editor) -> None:
        super().__init__(editor, self.ruled)

    def ruled(self, expression: ir.Expression) -> Lowered | None:
        """The group's number, added up beforehand."""
        bits = _bits(expression)
        if not bits:
            return None
        number = self.editor.temporary("bits", ir.IntType())
        done: list[ir.Statement] = [ir.Assign(number, ir.IntLiteral(0))]
        for place, bit in enumerate(bits):
            more = ir.Assign(number, ir.Binary("+", number, ir.IntLiteral(2**place)))
            done.append(ir.If(((bit, (more,)),)))
        return tuple(done), number

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Assign(target=target, value=value) if bits := _bits(target):
                return self.written(statement, bits, value)
        return super().statement(statement)

    def written(self, statement: ir.Assign, bits: list[ir.Signal], value: ir.Expression) -> ir.Body:
        before, given = self.lower(value)
        first: list[ir.Statement] = list(before)
        whole = isinstance(self.editor.type_of(given), ir.IntType)
        if not whole or not isinstance(given, ir.IntLiteral | ir.Name):
            kept = self.editor.temporary("bits", ir.IntType())
            first.append(ir.Assign(kept, given if whole else ir.Convert("round_half_away", given)))
            given = kept
        shares = [ir.Assign(bit, self.share(given, place)) for place, bit in enumerate(bits)]
        done = expansion(statement.origin, (*first, *shares))
        return tuple(replace(one, origin=statement.origin) if at == 0 else one for at, one in enumerate(done))

    def share(self, number: ir.Expression, place: int) -> ir.Expression:
        """Is the bit set in the number?"""
        if isinstance(number, ir.IntLiteral):
            return ir.BoolLiteral(bool(number.value >> place & 1))
        cut = ir.Binary("div", number, ir.IntLiteral(2**place)) if place else number
        return ir.Binary("=", ir.Binary("mod", cut, ir.IntLiteral(2)), ir.IntLiteral(1))
