"""Loops in the forms that the target has, with the exact rule of their source.

A counting loop stays one where the target's own rule gives the same passes and the same value afterwards; otherwise it
becomes a While or Repeat over a counter, with its bounds looked at once. Repeat, Loop, ExitLoop and NextPass become
While and Goto where they are lacking. Runs after the passes that make new loops.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import Counting
from rpl.passes.conditions import negation
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.counters import declared_loops, jumps_about, overwritten, used_outside_loops
from rpl.passes.legalise.facts.effects import everything, is_constant, statements_in
from rpl.passes.legalise.facts.usage import assigned_in, base_name, each_expression, usage_of
from rpl.passes.legalise.rewriting.bodies import written_arguments
from rpl.passes.legalise.rewriting.editing import (
    Editor,
    edit_bodies,
    edit_routines,
    exits,
    expansion,
    map_body,
    passes_on,
)
from rpl.passes.legalise.rewriting.jumps import entered
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts
from rpl.passes.scope import Scope
from rpl.source import Comment


@legalising(sees=("For", "While", "Repeat", "Loop"))
def fit_loops(program: ir.Program, context: Context) -> ir.Program:
    """The program with only the loop statements and rules of the target."""

    assigned = cache(lambda: usage_of(program).assigned)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        loops = _Loops(editor, routine, assigned)
        return loops.without_counters(edit_bodies(routine, loops.body))

    return edit_routines(program, context, work)


@dataclass(frozen=True, slots=True)
class _Rule:
    """What is known of a counting loop before it runs. step None: the direction depends on the bounds."""

    step: float | None
    passes: bool | None
    whole: bool


class _Loops:
    def __init__(self, editor: Editor, routine: ir.Routine, assigned: Callable[[], set[str]]) -> None:
        self.editor = editor
        self.assigned = assigned  # folded names that something in the program assigns
        self.has = editor.capabilities.statements
        # without WHILE the loops stay for the pass that makes labels of them
        self.labelled = "While" not in self.has and {"Goto", "Label"} <= self.has
        self.routine = routine
        self.local = {
            variable.name.lower(): variable for variable in routine.declarations if isinstance(variable, ir.Variable)
        }
        self.outside = used_outside_loops(routine)
        self.overwritten = set() if jumps_about(routine) else overwritten(routine)
        self.entered = {one for body in bodies(routine) for one in entered(body)}
        self.counters: dict[str, tuple[ir.Name, ir.Type]] = {}
        self.active: list[str] = []
        self.implicit: set[str] = set()

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.For():
                return self.counting(statement)
            case ir.While() | ir.Repeat() | ir.Loop() if self.labelled and not self.stays(statement):
                return (rewrite_bodies(statement, self.body),)
            case ir.While():
                return self.left(statement, self.passed_on(statement))
            case ir.Repeat():
                return self.repeat(statement)
            case ir.Loop():
                return self.loop(statement)
            case ir.If() | ir.Switch():
                return (rewrite_bodies(statement, self.body),)
        return (statement,)

    def stays(self, loop: ir.Statement) -> bool:
        return loop.__class__.__name__ in self.has and id(loop) not in self.entered

    # ---- jumps

    def passed_on(self, loop: ir.While | ir.Repeat | ir.Loop | ir.For) -> ir.Body:
        """The body of a loop that stays one, with NextPass as a jump to its end where the target has none."""
        body = self.body(loop.body)
        if "NextPass" in self.has or not passes_on(body):
            return body
        label = self.editor.context.fresh("next_pass")
        return (*redirected(body, ir.NextPass, (ir.Goto(label),)), ir.Label(label))

    def left(self, loop: ir.While | ir.Repeat | ir.Loop | ir.For, body: ir.Body) -> ir.Body:
        """The loop with that body; ExitLoop is a jump behind it where the target has none."""
        if "ExitLoop" in self.has or not exits(body):
            return (loop if body is loop.body else replace(loop, body=body),)
        label = self.editor.context.fresh("loop_end")
        body = redirected(body, ir.ExitLoop, (ir.Goto(label),))
        return expansion(loop.origin, (replace(loop, body=body), ir.Label(label)))

    # ---- Repeat and Loop

    def repeat(self, statement: ir.Repeat) -> ir.Body:
        if "Repeat" in self.has:
            return self.left(statement, self.passed_on(statement))
        if not exits(statement.body) and not passes_on(statement.body) and _is_true(statement.until):
            return self.body(statement.body) or (ir.Nothing(origin=statement.origin),)
        done = self.editor.temporary("done", ir.BoolType())
        last = ir.Assign(done, statement.until)
        body = statement.body
        if passes_on(body):
            body = redirected(body, ir.NextPass, (last, ir.NextPass()))
        loop = ir.While(ir.Unary("not", done), (*body, last))
        first = ir.Assign(done, ir.BoolLiteral(False))
        return expansion(statement.origin, (first, *self.statement(loop)))

    def loop(self, statement: ir.Loop) -> ir.Body:
        if "Loop" in self.has:
            return self.left(statement, self.passed_on(statement))
        match statement.body:
            case (ir.If(branches=((condition, (ir.ExitLoop(),)),), otherwise=()), *rest) if not exits(tuple(rest)):
                loop = ir.While(negation(condition), tuple(rest), origin=statement.origin)
            case _:
                loop = ir.While(ir.BoolLiteral(True), statement.body, origin=statement.origin)
        return self.statement(loop)

    # ---- For

    def counting(self, loop: ir.For) -> ir.Body:
        if Counting.LOOKS_EACH_PASS in self.editor.capabilities.control.counting and self.bound_changes(loop):
            last = self.editor.temporary("last", self.editor.type_of(loop.stop) or ir.RealType())
            return expansion(loop.origin, (ir.Assign(last, loop.stop), *self.counting(replace(loop, stop=last))))
        rule = self.rule(loop)
        if self.fits(loop, rule):
            if loop.keeps_last != (Counting.KEEPS_LAST in self.editor.capabilities.control.counting):
                loop = replace(loop, keeps_last=not loop.keeps_last)  # nobody looks at the counter afterwards
            return self.left(loop, self.inside(loop))
        if Counting.SCOPED in self.editor.capabilities.control.counting:
            done = self.as_scoped(loop, rule)
        else:
            done = self.as_plain(loop, rule)
        return self.spelled_out(loop, rule) if done is None else done

    def bound_changes(self, loop: ir.For) -> bool:
        """May the body change what the loop's last value is calculated from?"""
        names = {one.id.lower() for one in everything(loop.stop) if isinstance(one, ir.Name)}
        if not names:
            return False
        if names & assigned_in(loop.body):
            return True
        calls = any(isinstance(one, ir.CallRoutine | ir.Call) for one in walk(*loop.body))
        return calls and bool((names - set(self.local) - self.editor.own) & self.assigned())

    def inside(self, loop: ir.For) -> ir.Body:
        with self.editor.counting(loop):
            return self.passed_on(loop)

    def rule(self, loop: ir.For) -> _Rule:
        scope = self.editor.scope
        first, last = constant_number(loop.start, scope), constant_number(loop.stop, scope)
        step = 1.0 if loop.step is None else constant_number(loop.step, scope)
        if loop.step is None and loop.automatic:
            upward = first is not None and first <= 1 and _counts_elements(loop.stop)
            known = first is not None and last is not None and first > last
            step = -1.0 if known else 1.0 if upward or (first is not None and last is not None) else None
        passes: bool | None = None
        if step and first is not None and last is not None:
            passes = first <= last if step > 0 else first >= last
        elif step == 1.0 and first is not None and first <= 1 and _counts_elements(loop.stop):
            passes = True
        if loop.automatic and loop.step is None:
            passes = True
        parts = [loop.start, loop.stop] + ([] if loop.step is None else [loop.step])
        return _Rule(step, passes, all(map(self.whole, parts)))

    def whole(self, expression: ir.Expression) -> bool:
        if isinstance(self.editor.type_of(expression), ir.IntType):
            return True
        number = constant_number(expression, self.editor.scope)
        return number is not None and number == int(number)

    def fits(self, loop: ir.For, rule: _Rule) -> bool:
        """Is the target's own rule exactly the loop's?"""
        target = self.editor.capabilities
        if not self.sayable(loop, rule) or (self.counter_matters(loop) and self.misses_value(loop)):
            return False
        if (loop.scoped, loop.automatic, loop.at_least_once) != (
            Counting.SCOPED in target.control.counting,
            Counting.AUTOMATIC in target.control.counting,
            Counting.AT_LEAST_ONCE in target.control.counting,
        ):
            return False
        return Counting.SCOPED in target.control.counting or (
            (Counting.REAL in target.control.counting or self.whole_counter(loop)) and rule.step is not None
        )

    def sayable(self, loop: ir.For, rule: _Rule) -> bool:
        """Has the target a For with such a step, and can it be that no jump goes into the loop?"""
        if "For" not in self.has or id(loop) in self.entered:
            return False
        return Counting.ONE_STEP not in self.editor.capabilities.control.counting or (
            rule.step is not None and abs(rule.step) == 1.0
        )

    def misses_value(self, loop: ir.For) -> bool:
        """Would the target's FOR leave another value in the counter?"""
        return not loop.scoped and loop.keeps_last != (Counting.KEEPS_LAST in self.editor.capabilities.control.counting)

    def counter_matters(self, loop: ir.For) -> bool:
        """May something look at the counter behind the loop?"""
        key = loop.counter.lower()
        if loop.scoped:
            return False
        own = key in self.local or any(
            one.name.lower() == key and one.mode == "value" for one in self.routine.parameters
        )
        return not own or (key in self.outside and id(loop) not in self.overwritten)

    def whole_counter(self, loop: ir.For) -> bool:
        return isinstance(self.editor.type_of(ir.Name(loop.counter)), ir.IntType)

    def as_plain(self, loop: ir.For, rule: _Rule) -> ir.Body | None:
        """As a For over a declared counter that is checked before each pass."""
        target = self.editor.capabilities
        if not rule.step or not self.sayable(loop, rule) or (loop.at_least_once and not rule.passes):
            return None
        counts_whole = rule.whole if loop.scoped else self.whole_counter(loop)
        if not (counts_whole or Counting.REAL in target.control.counting):
            return None
        written = loop.step if loop.step is not None else None if rule.step == 1.0 else _number(rule.step)
        if not loop.scoped:
            last = Counting.KEEPS_LAST in target.control.counting
            plain = replace(loop, step=written, automatic=False, at_least_once=False, keeps_last=last)
            if not self.counter_matters(loop) or not self.misses_value(loop):
                return self.left(plain, self.passed_on(plain))
            if exits(loop.body) or not rule.passes:
                return None
            by = ir.Binary("+" if last else "-", ir.Name(loop.counter), ir.IntLiteral(1))
            if abs(rule.step) != 1.0 and loop.step is not None:
                by = replace(by, right=loop.step)
            elif rule.step < 0:
                by = replace(by, op="-" if last else "+")
            mended = ir.Assign(by.left, by)
            return expansion(loop.origin, (*self.left(plain, self.passed_on(plain)), mended))
        name = self.counter(loop, ir.IntType() if rule.whole else ir.RealType())
        body = self.renamed(loop, name)
        last = Counting.KEEPS_LAST in target.control.counting
        plain = ir.For(
            name.id, _whole(loop.start), _whole(loop.stop), written, body, keeps_last=last, origin=loop.origin
        )
        self.active.append(name.id.lower())
        done = self.left(plain, self.passed_on(plain))
        self.active.pop()
        return done

    def as_scoped(self, loop: ir.For, rule: _Rule) -> ir.Body | None:
        """As a For with its own counter that always makes a first pass, behind a check where it must not."""
        if not rule.step or not self.sayable(loop, rule) or rule.passes is False:
            return None
        key = loop.counter.lower()
        if not loop.scoped and (key not in self.local or self.written(key, loop.body)):
            return None
        if not loop.scoped and key in self.outside and id(loop) not in self.overwritten:
            return None
        step = None if abs(rule.step) == 1.0 else loop.step
        if step is None and abs(rule.step) != 1.0:
            return None
        own = replace(loop, step=step, scoped=True, automatic=step is None, at_least_once=True, keeps_last=False)
        before: list[ir.Statement] = []
        first = loop.at_least_once and not rule.passes
        if first:  # by a step that is written: without one it would count the other way
            own = replace(own, step=loop.step or _number(rule.step), automatic=False)
        elif not rule.passes:
            start, stop = self.kept(loop.start, "first", loop, before), self.kept(loop.stop, "last", loop, before)
            own = replace(own, start=start, stop=stop)
        if not loop.scoped:
            self.implicit.add(key)
        with self.editor.counting(own):
            done = self.left(own, self.passed_on(own))
        if not rule.passes and not first:
            some = ir.Binary("<=" if rule.step > 0 else ">=", own.start, own.stop)
            return expansion(loop.origin, (*before, ir.If(((some, done),))))
        return done

    def kept(self, bound: ir.Expression, stem: str, loop: ir.For, before: list[ir.Statement]) -> ir.Expression:
        """A bound that can be looked at again without another value coming out."""
        if self.steady(bound, loop):
            return bound
        type = self.editor.type_of(bound) or ir.RealType()
        saved = self.editor.temporary(f"{loop.counter}_{stem}", type)
        before.append(ir.Assign(saved, bound))
        return saved

    def steady(self, bound: ir.Expression, loop: ir.For) -> bool:
        """Constant, of data that nothing assigns, or made of the routine's own variables that the loop does not
        change."""
        if not self.editor.effects.safe(bound):
            return False
        for part in everything(bound):
            if isinstance(part, ir.System | ir.Signal):
                return False
            if isinstance(part, ir.Name):
                symbol = self.editor.scope.value(part.id)
                declared = symbol.declaration if symbol else None
                if isinstance(declared, ir.Variable) and declared.storage == "constant":
                    continue
                key = part.id.lower()
                if isinstance(declared, ir.Variable) and declared.scope != "routine" and key not in self.assigned():
                    continue
                own = key in self.local or any(
                    parameter.name.lower() == key and parameter.mode == "value" for parameter in self.routine.parameters
                )
                own = own or key in self.editor.own
                if not own or key == loop.counter.lower() or self.written(key, loop.body):
                    return False
        return True

    def written(self, key: str, body: ir.Body) -> bool:
        """May the body change that variable?"""
        for statement in statements_in(body):
            match statement:
                case ir.Assign(target=target):
                    if base_name(target) == key:
                        return True
                case ir.For(counter=counter):
                    if counter.lower() == key:
                        return True
            if _handed_over(statement, key, self.editor.scope):
                return True
        return False

    # ---- While and Repeat over a counter

    def spelled_out(self, loop: ir.For, rule: _Rule) -> ir.Body:
        whole = rule.whole if loop.scoped else self.whole_counter(loop)
        type: ir.Type = ir.IntType() if whole else ir.RealType()
        if loop.scoped:
            name = self.counter(loop, type)
            loop = replace(loop, counter=name.id, body=self.renamed(loop, name), scoped=False)
            self.local.setdefault(name.id.lower(), ir.Variable(name.id, type, scope="routine"))
        counter = ir.Name(loop.counter)
        init: list[ir.Statement] = []
        if any(isinstance(part, ir.Name) and part.id.lower() == counter.id.lower() for part in everything(loop.stop)):
            stop = self.kept(loop.stop, "last", loop, init)
            init.append(ir.Assign(counter, loop.start))
        else:
            init.append(ir.Assign(counter, loop.start))
            stop = self.kept(loop.stop, "last", loop, init)
        step, over = self.stepping(loop, rule, counter, stop, type, init)
        if isinstance(step, ir.Unary) and step.op == "-":
            further: ir.Expression = ir.Binary("-", counter, step.operand)
        else:
            further = ir.Binary("+", counter, step)
        tail: ir.Body = (ir.Assign(counter, further),)
        if loop.keeps_last and not loop.scoped:
            tail = (ir.If(((self.last_pass(rule, over, further, whole), (ir.ExitLoop(),)),)), *tail)
        body = self.ended(loop.body, tail)
        spelled: ir.Statement
        if loop.at_least_once or (loop.automatic and loop.step is None):
            spelled = ir.Loop(body) if loop.keeps_last else ir.Repeat(over, body)
        else:
            spelled = ir.While(negation(over), body)
        self.active.append(counter.id.lower())
        done = self.statement(spelled)
        self.active.pop()
        return expansion(loop.origin, (*init, *done))

    def ended(self, body: ir.Body, tail: ir.Body) -> ir.Body:
        """A pass and what ends it, also on the way of NextPass."""
        if self.labelled and passes_on(body):
            label = self.editor.context.fresh("next_pass")
            return (*redirected(body, ir.NextPass, (ir.Goto(label),)), ir.Label(label), *tail)
        return (*redirected(body, ir.NextPass, (*tail, ir.NextPass())), *tail)

    def last_pass(self, rule: _Rule, over: ir.Expression, further: ir.Expression, whole: bool) -> ir.Expression:
        """Was this the last pass: would the next value be past the end?"""
        assert isinstance(over, ir.Binary)  # what `stepping` makes
        if rule.step and abs(rule.step) == 1.0 and whole and rule.whole:
            return replace(over, op=">=" if rule.step > 0 else "<=")
        if rule.step:
            return replace(over, left=further)
        way = over.left
        assert isinstance(way, ir.Binary) and isinstance(way.left, ir.Binary)
        return replace(over, left=replace(way, left=replace(way.left, left=further)))

    def stepping(
        self,
        loop: ir.For,
        rule: _Rule,
        counter: ir.Name,
        stop: ir.Expression,
        type: ir.Type,
        init: list[ir.Statement],
    ) -> tuple[ir.Expression, ir.Expression]:
        """The step, and the condition that the counter is past the end."""
        if rule.step:
            written = loop.step if loop.step is not None and is_constant(loop.step) else _number(rule.step)
            return written, ir.Binary(">" if rule.step > 0 else "<", counter, stop)
        if loop.step is None:
            step = self.editor.temporary(f"{loop.counter}_step", type)
            init.append(ir.Assign(step, ir.IntLiteral(1)))
            down = ir.Assign(step, ir.Unary("-", ir.IntLiteral(1)))
            init.append(ir.If(((ir.Binary(">", counter, stop), (down,)),)))
        else:
            kept = self.kept(loop.step, "step", loop, init)
            step = kept if isinstance(kept, ir.Name) else ir.Name(loop.counter)
            if not isinstance(kept, ir.Name):
                step = self.editor.temporary(f"{loop.counter}_step", type)
                init.append(ir.Assign(step, kept))
        way = ir.Binary("*", ir.Binary("-", counter, stop), step)
        return step, ir.Binary(">", way, ir.IntLiteral(0))

    # ---- counters

    def counter(self, loop: ir.For, type: ir.Type) -> ir.Name:
        """A declared variable for a loop's own counter: its name when nothing else has it."""
        key = loop.counter.lower()
        known = self.counters.get(key)
        if known is not None and known[1] == type and known[0].id.lower() not in self.active:
            return known[0]
        seen = self.editor.scope.value(loop.counter)
        if seen is None and known is None:
            variable = ir.Variable(loop.counter, type, scope="routine")
            self.editor.added.append(variable)
            self.editor.own.add(key)
            self.editor.context.taken.add(key)
            self.editor.scope = self.editor.scope.with_value(variable)
            name = ir.Name(loop.counter)
        else:
            name = self.editor.temporary(loop.counter, type)
        self.counters[key] = (name, type)
        return name

    def renamed(self, loop: ir.For, name: ir.Name) -> ir.Body:
        if name.id.lower() == loop.counter.lower():
            return loop.body
        return _renamed(loop.body, loop.counter.lower(), name.id)

    def without_counters(self, routine: ir.Routine) -> ir.Routine:
        """Declarations of counters that are the loops' own now are dropped; remarks on them stay in their place."""
        if not self.implicit:
            return routine
        kept: list[ir.Declaration] = []
        remarks: tuple[Comment, ...] = ()
        for declaration in routine.declarations:
            origin = declaration.origin
            if self.is_only_counter(declaration, routine):
                remarks = (*remarks, *(replace(one, behind=False) for one in origin.comments))
            elif remarks:
                kept.append(replace(declaration, origin=replace(origin, comments=(*remarks, *origin.comments))))
                remarks = ()
            else:
                kept.append(declaration)
        note: ir.Body = (ir.Nothing(origin=replace(routine.origin, comments=remarks)),) if remarks else ()
        return replace(routine, declarations=tuple(kept), body=(*note, *routine.body))

    def is_only_counter(self, one: ir.Declaration, routine: ir.Routine) -> bool:
        """Does nothing but loops that have a counter of their own use this variable?"""
        if not isinstance(one, ir.Variable):
            return False
        key = one.name.lower()
        return key in self.implicit - self.outside and not declared_loops(routine, key)


def redirected(body: ir.Body, kind: type, jump: ir.Body) -> ir.Body:
    """The body of a loop with each jump of that loop (ExitLoop, NextPass) replaced."""

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, kind):
            return expansion(statement.origin, jump)
        if isinstance(statement, ir.If | ir.Switch):
            return (rewrite_bodies(statement, inner),)
        return (statement,)

    def inner(statements: ir.Body) -> ir.Body:
        return map_body(statements, change)

    return inner(body)


def _is_true(expression: ir.Expression) -> bool:
    return isinstance(expression, ir.BoolLiteral) and expression.value


def _counts_elements(expression: ir.Expression) -> bool:
    """The size of an array: at least one."""
    return isinstance(expression, ir.Builtin) and expression.function in ("length", "dimension")


def _number(value: float) -> ir.Expression:
    size: ir.Expression = ir.IntLiteral(int(abs(value))) if value == int(value) else ir.RealLiteral(abs(value))
    return ir.Unary("-", size) if value < 0 else size


def _whole(bound: ir.Expression) -> ir.Expression:
    """A whole number written with a point is written without it."""
    if isinstance(bound, ir.RealLiteral) and bound.value == int(bound.value):
        return ir.IntLiteral(int(bound.value), origin=bound.origin)
    return bound


def _handed_over(statement: ir.Statement, key: str, scope: Scope) -> bool:
    """Is the variable given to something that could write it?"""
    match statement:
        case ir.CallRoutine(name=name, arguments=arguments) if _in_arguments(name, arguments, key, scope):
            return True
        case ir.Do(arguments=values) if any(value is not None and base_name(value) == key for value in values):
            return True
        case ir.WaitUntil(timed_out=place) | ir.Dialog(answer=place) | ir.ConnectInterrupt(handle=place):
            if place is not None and base_name(place) == key:
                return True
    found = False

    def look(expression: ir.Expression) -> None:
        nonlocal found
        if isinstance(expression, ir.Call) and _in_arguments(expression.name, expression.arguments, key, scope):
            found = True

    each_expression(statement, look)
    return found


def _in_arguments(name: str, arguments: tuple[ir.Argument, ...], key: str, scope: Scope) -> bool:
    values = [argument.value for argument in arguments if argument.value is not None]
    written = written_arguments(name, arguments, scope)
    return any(writes and base_name(value) == key for writes, value in zip(written, values, strict=True))


def _renamed(body: ir.Body, old: str, new: str) -> ir.Body:
    """The body with a counter's name replaced, except where an inner loop has a counter of that name."""

    def expression(node: ir.Expression) -> ir.Expression:
        if isinstance(node, ir.Name) and node.id.lower() == old:
            return replace(node, id=new)
        return rewrite_parts(node, expression)

    def statements(inner: ir.Body) -> ir.Body:
        return tuple(one(statement) for statement in inner)

    def one(statement: ir.Statement) -> ir.Statement:
        if isinstance(statement, ir.For) and statement.scoped and statement.counter.lower() == old:
            bounds = rewrite_parts(replace(statement, body=()), expression)
            return replace(bounds, body=statement.body)
        return rewrite_parts(statement, expression, statements)

    return statements(body)
