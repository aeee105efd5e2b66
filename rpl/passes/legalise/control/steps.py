"""Nested expressions as steps, for targets whose assignments, conditions and statements take simple operands only.

What a statement cannot hold is assigned to a temporary of the routine in front of it; the temporaries of one statement
serve the next one again. Order of evaluation is kept, a short circuit stays one. Conditions become comparisons that
and/or join. A wait whose operands may change while it waits is a loop that looks again and again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import Aggregate, Limit, MessageRule
from rpl.passes.conditions import negation
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.spread import is_computed, reads, spread
from rpl.passes.legalise.facts.effects import children, everything, is_constant
from rpl.passes.legalise.facts.runbeside import stands_still
from rpl.passes.legalise.facts.usage import assigned_in
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion
from rpl.passes.legalise.rewriting.operands import changing, is_number, is_operand, opposite
from rpl.passes.legalise.rewriting.polling import seconds_of
from rpl.passes.legalise.rewriting.walk import POLL_S, POLLED
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

TIMED = code("timed-wait-computed", Severity.LOSS, "a wait for a computed condition loses its time limit")

_COMPARISONS = ("=", "<>", "<", ">", "<=", ">=")
_JOINING = {"and": "and", "or": "or", "cand": "and", "cor": "or"}
_HELD = ir.IntLiteral(0)  # stands for a move's target while the rest of the move is looked at
_STRUCTURES = (ir.If, ir.While, ir.Repeat, ir.For, ir.Switch, ir.Loop)


@legalising(
    unless=lambda context: (
        Limit.STEPS not in context.capabilities.control.limits
        and (
            Limit.PLAIN_PLACES not in context.capabilities.control.limits
            and Limit.COMPARISONS not in context.capabilities.control.limits
            and (Limit.FUNCTIONS_ALONE not in context.capabilities.control.limits)
        )
    )
)
def steps(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that do not take any expression anywhere."""
    changes = changing(program)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Steps(editor, changes).body)

    return edit_routines(program, context, work)


class _Steps(Hoister):
    def __init__(self, editor: Editor, changes: frozenset[str] | None) -> None:
        super().__init__(editor, lambda _: None)
        self.can = editor.capabilities
        self.by_steps = Limit.STEPS in self.can.control.limits
        self.changes = changes
        self.pool: dict[ir.Type, list[ir.Name]] = {}
        self.lent: list[tuple[ir.Type, ir.Name]] = []
        self.lasting = False

    # ---- temporaries

    def temporary(self, type: ir.Type) -> ir.Name:
        """A variable for a value that this statement needs; free again behind it."""
        if self.lasting:
            return self.editor.temporary("bound", type)
        free = self.pool.setdefault(type, [])
        name = free.pop(0) if free else self.editor.temporary("step", type)
        self.lent.append((type, name))
        return name

    def give_back(self, since: int) -> None:
        for type, name in reversed(self.lent[since:]):
            self.pool[type].insert(0, name)
        del self.lent[since:]

    # ---- expressions

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        """The expression where it is one part of something: an operand, an argument, a subscript."""
        if isinstance(expression, ir.Binary) and expression.op in ("cand", "cor") and not self.by_steps:
            return self.deciding(expression)
        expression = _plain_number(expression)
        if is_operand(expression):
            return (), expression
        if isinstance(expression, ir.Aggregate) and self.must_stand_alone(expression):
            return self.stored((), expression)
        before, value = self.whole(expression, lvalue)
        if lvalue or is_operand(value) or not self.must_stand_alone(value):
            return before, value
        return self.stored(before, value)

    def operand(self, expression: ir.Expression) -> Lowered:
        """The expression where only a constant or a variable can stand."""
        before, value = self.lower(expression)
        return (before, value) if is_operand(value) else self.stored(before, value)

    def stored(self, before: ir.Body, value: ir.Expression) -> Lowered:
        type = self.editor.type_of(value)
        if (
            type is not None
            and isinstance(value, ir.Aggregate)
            and Aggregate.CONSTANT in self.can.data.aggregates
            and is_computed(value)
        ):
            place = self.temporary(type)
            parts = spread(place, value)
            if parts is not None:
                return (*before, *self.several_steps(parts)), place
        if type is None or isinstance(value, ir.Aggregate) or isinstance(type, ir.ArrayType | ir.SignalType):
            return before, value
        if isinstance(type, ir.StringType) and not self.can.texts:
            return before, value
        if isinstance(type, ir.BoolType) and self.by_steps and isinstance(value, ir.Index | ir.Signal | ir.System):
            further, value = self.numbered(value)
            before = (*before, *further)
            if is_operand(value):
                return before, value
        name = self.further(value, type) or self.temporary(type)
        if isinstance(type, ir.BoolType) and self.by_steps and isinstance(value, ir.Unary | ir.Binary | ir.Convert):
            return (*before, *self.decided(name, value)), name
        return (*before, ir.Assign(name, value)), name

    def further(self, value: ir.Expression, type: ir.Type) -> ir.Name | None:
        """The variable of the step before, where this one calculates on with it: nothing else reads it."""
        match value:
            case ir.Binary(op="+" | "-" | "*" | "/", left=ir.Name() as left, right=right) if (type, left) in self.lent:
                return left if is_operand(right) and left != right else None
        return None

    def numbered(self, value: ir.Expression) -> Lowered:
        """An element or a signal whose number is itself an element with a computed number: that is kept before."""
        steps: list[ir.Statement] = []

        def number(part: ir.Expression) -> ir.Expression:
            if is_number(part):
                return part
            before, kept = self.stored((), part)
            steps.extend(before)
            return kept

        match value:
            case ir.Index(indices=indices):
                value = replace(value, indices=tuple(map(number, indices)))
            case ir.System(indices=indices):
                value = replace(value, indices=tuple(map(number, indices)))
            case ir.Signal():
                value = rewrite_parts(value, number)
        return tuple(steps), value

    def several_steps(self, parts: Sequence[ir.Assign]) -> ir.Body:
        """Assignments of components, each as the target takes it."""
        return tuple(one for part in parts for one in self.assigned(part, part.target, part.value))

    def must_stand_alone(self, value: ir.Expression) -> bool:
        """Does the target take this only as the whole right side of an assignment?"""
        if isinstance(value, ir.Aggregate):
            return (
                Aggregate.CONSTANT in self.can.data.aggregates
                and Limit.PLAIN_PLACES in self.can.control.limits
                and is_computed(value)
            )
        if isinstance(value, ir.Quantity):
            return False
        if isinstance(value, ir.Builtin) and value.function == "text_equal":
            return self.by_steps  # a comparison
        joined = Limit.FUNCTIONS_ALONE in self.can.control.limits and isinstance(value, ir.Binary) and value.op == "&"
        return self.by_steps or joined or isinstance(value, ir.Call | ir.Builtin | ir.Convert)

    def whole(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        """The expression itself with parts that the target takes in it."""
        if isinstance(expression, ir.Binary) and expression.op == "&" and not self.by_steps:
            return self.texts(expression)
        function = isinstance(expression, ir.Call | ir.Builtin | ir.Convert)
        strict = function or isinstance(expression, ir.Index | ir.Signal | ir.System) or self.by_steps
        if not strict:
            return super()._operands(expression, lvalue)
        outer, self.simple_parts = self.simple_parts, True
        done = super()._operands(expression, lvalue)
        self.simple_parts = outer
        return done

    def texts(self, expression: ir.Binary) -> Lowered:
        """Texts joined from left to right: a chain as it is, of operands."""
        pieces: list[ir.Expression] = [expression]
        while isinstance(pieces[0], ir.Binary) and pieces[0].op == "&":
            pieces[:1] = [pieces[0].left, pieces[0].right]
        before, values = self.several(pieces, [False] * len(pieces))
        if all(new is old for new, old in zip(values, pieces, strict=True)):
            return before, expression
        done = values[0]
        for one in values[1:]:
            done = ir.Binary("&", done, one, origin=expression.origin)
        return before, done

    simple_parts = False

    def several(self, parts: Sequence[ir.Expression], in_place: Sequence[bool]) -> tuple[ir.Body, list[ir.Expression]]:
        """Operands in order of evaluation; simple ones where the target wants them so."""
        if not self.simple_parts:
            return super().several(parts, in_place)
        self.simple_parts = False
        befores, values = [], []
        for part, place in zip(parts, in_place, strict=True):
            before, value = self.lower(part, True) if place else self.operand(part)
            befores.append(before)
            values.append(value)
        self.simple_parts = True
        return self.ordered(befores, values, in_place)

    def ordered(
        self, befores: list[ir.Body], values: list[ir.Expression], in_place: Sequence[bool]
    ) -> tuple[ir.Body, list[ir.Expression]]:
        """Lowered operands one behind the other: what a later one's statements would change is saved first."""
        last = max((at for at, before in enumerate(befores) if before), default=-1)
        done: list[ir.Statement] = []
        for at, value in enumerate(values):
            done.extend(befores[at])
            later = tuple(one for before in befores[at + 1 :] for one in before)
            if at < last and not in_place[at] and not self.settled(value, later):
                type = self.editor.type_of(value)
                if type is not None:
                    values[at] = self.temporary(type)
                    done.append(ir.Assign(values[at], value))
        return tuple(done), values

    def settled(self, value: ir.Expression, later: ir.Body) -> bool:
        """Also a variable of the routine that these statements do not name as a place they write."""
        if super().settled(value, later):
            return True
        if not isinstance(value, ir.Name):
            return False
        symbol = self.editor.scope.value(value.id)
        if symbol is None or symbol.routine is None:
            return False
        declared = symbol.declaration
        own = not isinstance(declared, ir.Parameter) or declared.mode != "reference"
        return own and value.id.lower() not in assigned_in(later)

    # ---- truth values

    def decided(self, place: ir.Expression, value: ir.Expression) -> ir.Body:
        """place := value, by a branch where the target cannot assign a comparison."""
        before, condition = self.condition(value)
        if isinstance(condition, ir.BoolLiteral):
            return (*before, ir.Assign(place, condition))
        yes, no = ir.Assign(place, ir.BoolLiteral(True)), ir.Assign(place, ir.BoolLiteral(False))
        return (*before, ir.If(((condition, (yes,)),), (no,)))

    def condition(self, expression: ir.Expression) -> Lowered:
        """A condition as the target takes it."""
        if Limit.COMPARISONS not in self.can.control.limits:
            return self.operand(expression) if self.by_steps else self.lower(expression)
        match expression:
            case ir.BoolLiteral():
                return (), expression
            case ir.Unary(op="not", operand=operand):
                return self.denied(expression, operand)
            case ir.Binary(op=op) if op in _JOINING:
                return self.joined(expression)
            case ir.Binary(op="xor", left=left, right=right):
                return self.condition(ir.Binary("<>", left, right, origin=expression.origin))
            case ir.Binary(op=op, left=left, right=right) if op in _COMPARISONS:
                return self.compared(expression, left, right)
            case ir.Convert(how="truth", operand=operand):
                zero = ir.IntLiteral(0) if isinstance(self.editor.type_of(operand), ir.IntType) else ir.RealLiteral(0.0)
                return self.condition(ir.Binary("<>", operand, zero, origin=expression.origin))
        before, value = self.operand(expression)
        return before, ir.Binary("=", value, ir.BoolLiteral(True), origin=expression.origin)

    def opposite(self, condition: ir.Expression) -> ir.Expression:
        return negation(condition) if Limit.COMPARISONS not in self.can.control.limits else opposite(condition)

    def denied(self, expression: ir.Expression, operand: ir.Expression) -> Lowered:
        """`not`: pushed down to the comparisons."""
        match operand:
            case ir.Binary(op="and" | "or" | "cand" | "cor" as op, left=left, right=right):
                other = {"and": "or", "or": "and", "cand": "cor", "cor": "cand"}[op]
                return self.condition(replace(operand, op=other, left=negation(left), right=negation(right)))
            case ir.Binary(op="xor", left=left, right=right):
                return self.condition(ir.Binary("=", left, right, origin=operand.origin))
            case ir.Binary() | ir.BoolLiteral() | ir.Unary(op="not"):
                return self.condition(negation(operand))
            case ir.Convert(how="truth"):
                before, shown = self.condition(operand)
                return before, negation(shown)
        before, value = self.operand(operand)
        return before, ir.Binary("=", value, ir.BoolLiteral(False), origin=expression.origin)

    def compared(self, expression: ir.Binary, left: ir.Expression, right: ir.Expression) -> Lowered:
        """A comparison of two operands; the constant stands on the right."""
        (before, one), (further, other) = self.operand(left), self.operand(right)
        done, (one, other) = self.ordered([before, further], [one, other], [False, False])
        turned = {"<": ">", ">": "<", "<=": ">=", ">=": "<="}
        op = expression.op
        if is_constant(one) and not is_constant(other):
            one, other, op = other, one, turned.get(op, op)
        return done, replace(expression, op=op, left=one, right=other)

    def joined(self, expression: ir.Binary) -> Lowered:
        before, left = self.condition(expression.left)
        further, right = self.condition(expression.right)
        deciding = expression.op in ("cand", "cor")
        if deciding and (further or not self.editor.effects.safe(expression.right)):
            result = self.temporary(ir.BoolType())
            goes_on = ir.Binary("=", result, ir.BoolLiteral(expression.op == "cand"))
            second = (*further, *self.branch(result, right))
            chosen = ir.If(((goes_on, second),))
            return (*before, *self.branch(result, left), chosen), ir.Binary("=", result, ir.BoolLiteral(True))
        op = expression.op if expression.op in self.can.operators else _JOINING[expression.op]
        if further and not self.settled(left, further):
            result = self.temporary(ir.BoolType())
            before, left = (*before, *self.branch(result, left)), ir.Binary("=", result, ir.BoolLiteral(True))
        return (*before, *further), replace(expression, op=op, left=left, right=right)

    def branch(self, place: ir.Expression, condition: ir.Expression) -> ir.Body:
        """place := a condition that is in its last form."""
        if not self.by_steps:
            return (ir.Assign(place, condition),)
        match condition:
            case ir.Binary(op="=", left=left, right=ir.BoolLiteral(value=True)):
                return (ir.Assign(place, left),)
        yes, no = ir.Assign(place, ir.BoolLiteral(True)), ir.Assign(place, ir.BoolLiteral(False))
        return (ir.If(((condition, (yes,)),), (no,)),)

    # ---- statements

    def placed(self, statement: ir.Statement) -> ir.Body:
        since = len(self.lent)
        done = self.stepped(statement)
        self.give_back(since)
        return done

    def stepped(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Assign(target=target, value=value):
                return self.assigned(statement, target, value)
            case ir.WaitUntil():
                return self.waiting(statement)
            case ir.Message() if MessageRule.COMPUTED not in self.can.texts.messages:
                return (statement,)  # its values are variables that the text names
        if isinstance(statement, _STRUCTURES):
            return super().placed(statement)
        if Limit.PLAIN_PLACES not in self.can.control.limits and not self.by_steps:
            return super().placed(statement)
        self.simple_parts = True
        done = super().placed(statement)
        self.simple_parts = False
        return done

    def bounds(self, given: list[ir.Expression]) -> tuple[ir.Body, list[ir.Expression]]:
        """Bounds are read once, but a loop made of labels reads them again: their temporaries last."""
        self.lasting, self.simple_parts = True, self.by_steps or Limit.PLAIN_PLACES in self.can.control.limits
        done = super().bounds(given)
        self.lasting = self.simple_parts = False
        return done

    def _move(self, statement: ir.Move, search: ir.Search | None) -> ir.Body:
        """The target of a move may be what only a move can say."""
        before, target = self.at_move(statement.target)
        further, via = ((), None) if statement.via is None else self.at_move(statement.via)
        self.simple_parts = self.by_steps or Limit.PLAIN_PLACES in self.can.control.limits
        done = super()._move(replace(statement, target=_HELD, via=None), search)
        last = done[-1]
        assert isinstance(last, ir.Move)  # _move keeps the statement's class
        first = (*done[:-1], *before, *further)
        if not first and target is statement.target and via is statement.via and last.target is _HELD:
            same = replace(last, target=target, via=via)
            return (statement if same == statement else same,)
        return self.expanded(statement, first, replace(last, target=target, via=via))

    def at_move(self, target: ir.Expression) -> Lowered:
        says = self.can.places.move_functions
        match target:
            case ir.Binary(op=":", left=left, right=right) if ":" in says:
                before, base = self.at_move(left)
                further, shift = self.operand(right)
                return (*before, *further), replace(target, left=base, right=shift)
            case ir.Builtin(function=name, arguments=(left, *rest)) if name in says:
                before, base = self.at_move(left)
                shifts = [self.operand(one) for one in rest]
                steps_before = tuple(one for further, _ in shifts for one in further)
                return (*before, *steps_before), replace(target, arguments=(base, *(value for _, value in shifts)))
        if self.by_steps or Limit.PLAIN_PLACES in self.can.control.limits:
            return self.operand(target)
        return self.lower(target)

    def switch(self, statement: ir.Switch) -> ir.Body:
        simple = self.by_steps or Limit.PLAIN_PLACES in self.can.control.limits
        before, selector = self.operand(statement.selector) if simple else self.lower(statement.selector)
        cases = tuple(replace(case, body=self.body(case.body)) for case in statement.cases)
        default = None if statement.default is None else self.body(statement.default)
        return self.expanded(statement, before, replace(statement, selector=selector, cases=cases, default=default))

    def assigned(self, statement: ir.Assign, target: ir.Expression, value: ir.Expression) -> ir.Body:
        first, place = self.lower(target, True)
        if isinstance(value, ir.Aggregate) and self.must_stand_alone(value):
            parts = None if reads(value, place) else spread(place, value)
            if parts is not None:
                return expansion(statement.origin, (*first, *self.several_steps(parts))) or (ir.Nothing(),)
            first, value = self.stored(first, value)
            return self.expanded(statement, first, replace(statement, target=place, value=value))
        value = _plain_number(value)
        if isinstance(target, ir.Signal) and Limit.PLAIN_PLACES in self.can.control.limits:
            before, value = self.operand(value)
            if isinstance(value, ir.Signal) and not isinstance(self.editor.type_of(value), ir.BoolType):
                before, value = self.stored(before, value)  # GO[4]=GI[3] is refused by loaders
        elif self.by_steps and isinstance(self.editor.type_of(target), ir.BoolType) and _is_logic(value):
            return expansion(statement.origin, (*first, *self.decided(place, value)))
        elif is_operand(value):
            before = ()
        elif isinstance(value, ir.Binary) and value.op in ("cand", "cor") and not self.by_steps:
            before, value = self.lower(value)
        else:
            before, value = self.whole(value)
        if place is target and value is statement.value:
            return (statement,)
        return self.expanded(statement, (*first, *before), replace(statement, target=place, value=value))

    def waiting(self, statement: ir.WaitUntil) -> ir.Body:
        """The condition is looked at while waiting: only what stands still may be computed before."""
        before, condition = self.condition(statement.condition)
        if not before and (statement.timeout is None or is_operand(statement.timeout)):
            return (statement if condition == statement.condition else replace(statement, condition=condition),)
        if all(self.stands_still(one) for one in _read_by(before)):
            limit = () if statement.timeout is None else (statement.timeout,)
            further, values = self.operand(limit[0]) if limit else ((), None)
            new = replace(statement, condition=condition, timeout=values)
            return self.expanded(statement, (*before, *further), new)
        shortest = self.can.io.shortest_wait_s or POLL_S
        period = ir.RealLiteral(round(round(POLL_S / shortest) * shortest, 6))
        self.editor.context.diagnostics.report(POLLED, statement.origin, seconds=period.value)
        first, late, counted = self.limited(statement, period)
        leave = ir.If(((condition, (ir.ExitLoop(),)),))
        pause = ir.Wait(period)
        loop = ir.Loop((*before, leave, *late, pause, *counted))
        stands: ir.Body = (ir.WaitForMotion(),) if statement.in_position else ()
        return expansion(statement.origin, (*stands, *first, loop))

    def limited(self, statement: ir.WaitUntil, period: ir.RealLiteral) -> tuple[ir.Body, ir.Body, ir.Body]:
        """The limit of a wait that is a loop: what stands in front of it, what ends it, and what counts its passes."""
        if statement.timeout is None:
            return (), (), ()
        if statement.timed_out is None:
            self.editor.context.diagnostics.report(TIMED, statement.origin)
            return (), (), ()
        before, limit = self.operand(seconds_of(statement.timeout))
        if not is_constant(limit):  # the flag or what the condition takes may be what it is made of
            kept = self.editor.temporary("limit", ir.RealType())
            before, limit = (*before, ir.Assign(kept, limit)), kept
        waited = self.editor.temporary("waited", ir.RealType())
        begun = self.body((ir.Assign(statement.timed_out, ir.BoolLiteral(False)),))
        ended = self.body((ir.Assign(statement.timed_out, ir.BoolLiteral(True)),))
        late = ir.If(((ir.Binary(">=", waited, limit), (*ended, ir.ExitLoop())),))
        count = ir.Assign(waited, ir.Binary("+", waited, period))
        return (*before, *begun, ir.Assign(waited, ir.RealLiteral(0.0))), (late,), (count,)

    def stands_still(self, value: ir.Expression) -> bool:
        own = isinstance(value, ir.Name) and value.id.lower() in self.editor.own
        return own or stands_still(value, self.changes)


# Units that no such target says of a variable.
_OTHERS = frozenset(("ms", "min", "m", "cm", "inch", "rad"))


def _plain_number(value: ir.Expression) -> ir.Expression:
    """A computed quantity as the arithmetic that it is."""
    match value:
        case ir.Magnitude(value=inner, unit=unit):
            factor = ir.UNITS[unit]
            done = _plain_number(inner)
            return done if factor == 1.0 else ir.Binary("/", done, ir.RealLiteral(factor), origin=value.origin)
        case ir.Quantity(value=inner, unit=unit) if not is_operand(inner) or (
            unit in _OTHERS and not is_constant(inner)
        ):
            factor = ir.UNITS[unit]
            return inner if factor == 1.0 else ir.Binary("*", inner, ir.RealLiteral(factor), origin=value.origin)
    return value


def _is_logic(value: ir.Expression) -> bool:
    """Is it a truth value that is computed here (not a variable, a constant or what a function gives)?"""
    match value:
        case ir.Binary(op=op):
            return op in _COMPARISONS or op in _JOINING or op == "xor"
        case ir.Unary(op="not") | ir.Convert(how="truth"):
            return True
    return False


def _read_by(body: ir.Body) -> list[ir.Expression]:
    """Everything that the statements in front of a wait read."""
    found: list[ir.Expression] = []
    for statement in body:
        match statement:
            case ir.Assign(value=value):
                found.extend(everything(value))
            case ir.If(branches=branches, otherwise=otherwise):
                for condition, inner in branches:
                    found.extend(everything(condition))
                    found.extend(_read_by(inner))
                found.extend(_read_by(otherwise))
            case _:
                for one in children(statement):
                    found.extend(everything(one))
    return found
