"""Outputs that a target's programs can set and not read back: a variable beside each that is read keeps its value.

The variable is global and starts at zero, as the output does. An output whose number is computed, or that an action on
the path sets, is not followed; reading it stays, and the target refuses it.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.usage import each_statement
from rpl.passes.legalise.rewriting.editing import edit_bodies, expansion, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

_Key = tuple[str, int]

_WRITE_ONLY = frozenset(("analog_out",))  # kinds of outputs


@legalising(sees=("Signal",))
def kept_outputs(program: ir.Program, context: Context) -> ir.Program:
    """Outputs that programs set and cannot read back."""
    kinds = _WRITE_ONLY
    outputs = _Outputs(kinds)
    for module in program.modules:
        for routine in module.routines:
            for body in bodies(routine):
                each_statement(body, outputs.note)
    for key in sorted(outputs.read - outputs.lost):
        if key[0] not in outputs.computed:
            outputs.names[key] = context.fresh(f"{key[0]}_{key[1]}")
    if not outputs.names:
        return program
    zero = ir.RealLiteral(0.0)
    made = tuple(ir.Variable(name, ir.RealType(), zero, scope="global") for name in outputs.names.values())
    first, *others = (replace(one, routines=tuple(map(outputs.routine, one.routines))) for one in program.modules)
    return replace(program, modules=(replace(first, declarations=(*first.declarations, *made)), *others))


@dataclass(slots=True)
class _Outputs:
    """`read`, `lost`: outputs that are read, and that something else than a statement sets; `computed`: kinds of which
    one with a computed number is set; `names`: the variables beside them."""

    kinds: frozenset[str]
    read: set[_Key] = field(default_factory=set)
    lost: set[_Key] = field(default_factory=set)
    computed: set[str] = field(default_factory=set)
    names: dict[_Key, str] = field(default_factory=dict)

    def key(self, expression: ir.Expression) -> _Key | None:
        match expression:
            case ir.Signal(kind=kind, index=ir.IntLiteral(value=number), last=None) if kind in self.kinds:
                return kind, number
        return None

    # ---- what there is

    def note(self, statement: ir.Statement) -> None:
        def look(expression: ir.Expression) -> ir.Expression:
            if (key := self.key(expression)) is not None:
                self.read.add(key)
            return rewrite_parts(expression, look)

        match statement:
            case ir.Assign(target=ir.Signal(kind=kind) as target, value=value) if kind in self.kinds:
                if self.key(target) is None:
                    self.computed.add(kind)
                look(value)
                return
            case ir.DeclareInterrupt(action=ir.Assign() as action) | ir.Trigger(action=ir.Assign() as action):
                self.set_beside(action)
            case ir.Move(triggers=triggers):
                for one in triggers:
                    if isinstance(one, ir.Trigger) and isinstance(one.action, ir.Assign):
                        self.set_beside(one.action)
        rewrite_parts(statement, look)

    def set_beside(self, action: ir.Assign) -> None:
        if (key := self.key(action.target)) is not None:
            self.lost.add(key)

    # ---- rewriting

    def routine(self, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, self.body)

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Assign) and (key := self.key(statement.target)) in self.names and key is not None:
            kept = ir.Name(self.names[key])
            value = ir.Assign(kept, self.expression(statement.value))
            return expansion(statement.origin, (value, replace(statement, value=kept)))
        if blocks(statement):
            return (rewrite_parts(statement, self.expression, self.body),)
        return (rewrite_parts(statement, self.expression),)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        key = self.key(expression)
        if key is not None and key in self.names:
            return ir.Name(self.names[key], origin=expression.origin)
        return rewrite_parts(expression, self.expression)
