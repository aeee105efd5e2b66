"""Numbered signals to named ones and back.

A number 5 of digital outputs becomes the name prefix + 5; a declared alias becomes the name itself. Backwards, a name
that is prefix + number gets that number, and any other name the first free number and a declaration. Numbers known only
at run time go through generated routines over the numbers in reach. A group that has a number of its own (its bits are
wired at the controller) gets free bits and a declaration too, where the target knows groups by their bits only.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from rpl import ir, registry
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import GroupRule
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.io.groupwidths import TOO_NARROW, WIDTH, group_widths
from rpl.passes.legalise.io.signalnumbers import numbers_as_arguments, parameters_as_numbers
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope
from rpl.source import Origin

DYNAMIC = code(
    "dynamic-signal",
    Severity.WARNING,
    "the signal number is computed; numbers 1 to {last} are covered, another one stops the program",
)
NUMBERED = code(
    "signal-number-chosen",
    Severity.WARNING,
    "signal {name} gets number {number}; wire or map it accordingly",
    several="{count} signals get numbers; wire or map them accordingly: [{name} {number}]",
)
# Numbers a computed index is expected to reach where the program shows no larger one.
_REACH = 32
_FLAGS = 64
_MOST = 1024  # beyond it a number that the program puts somewhere is none of a signal
_VALUES: dict[str, ir.Type] = {"analog": ir.RealType(), "group": ir.IntType()}


@legalising(unless=lambda context: not context.capabilities.io.signal_prefixes)
def name_signals(program: ir.Program, context: Context) -> ir.Program:
    """For targets whose signals have names."""
    scopes = ProgramScope(program)
    worker = _Named(program, context)
    modules = []
    for module in program.modules:
        declarations = tuple(d for d in module.declarations if not isinstance(d, ir.SignalDeclaration))
        routines = tuple(
            replace(
                edit_bodies(routine, worker.in_scope(scopes.routine(module, routine)).body),
                declarations=tuple(d for d in routine.declarations if not isinstance(d, ir.SignalDeclaration)),
            )
            for routine in module.routines
        )
        modules.append(replace(module, declarations=declarations, routines=routines))
    support = worker.support(program.modules[0].dialect, modules[0].task if modules else "")
    return replace(program, modules=_with_shared_flags((*modules, *support), worker.flags, worker.flag_count()))


def _with_shared_flags(modules: tuple[ir.Module, ...], flags: str | None, count: int) -> tuple[ir.Module, ...]:
    """Flags belong to the whole controller: where tasks have data of their own, each that uses them declares them."""
    users = {
        module.task: module
        for module in reversed(modules)
        if flags and any(isinstance(node, ir.Name) and node.id == flags for node in walk(module))
    }
    if len(users) < 2:
        return modules
    type = ir.ArrayType(ir.BoolType(), (ir.IntLiteral(count),))
    shared = ir.Variable(str(flags), type, storage="persistent", scope="global")
    done = []
    for module in modules:
        kept = tuple(one for one in module.declarations if not (isinstance(one, ir.Variable) and one.name == flags))
        home = len(kept) < len(module.declarations)
        if home or (users.get(module.task) is module and module.task != modules[0].task):
            kept = (shared, *kept)
        done.append(replace(module, declarations=kept))
    return tuple(done)


def _place(place: ir.Name | ir.Index) -> str:
    """A variable, or an element of one by constant numbers, folded; empty for any other place."""
    match place:
        case ir.Name(id=name):
            return name.lower()
        case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=number),)):
            return f"{name.lower()}[{number}]"
    return ""


class _Named:
    def __init__(self, program: ir.Program, context: Context) -> None:
        self.context = context
        self.prefixes = context.capabilities.io.signal_prefixes
        self.aliases: dict[tuple[str, int], str] = {}
        self.declared: dict[str, ir.Signal] = {}  # by folded name; the first of that name keeps it
        self.highest: dict[str, int] = {}
        self.dynamic: dict[str, str] = {}
        self.given: dict[str, int] = {}  # the highest whole number that a place is set to
        self.parameters = {
            routine.name.lower(): tuple(one.name for one in routine.parameters)
            for module in program.modules
            for routine in module.routines
        }
        self.flags: str | None = None
        self.flags_watched = False  # an interrupt comes with each change of one
        self.scope: Scope | None = None
        self._collect(program)

    def _collect(self, program: ir.Program) -> None:
        def look(expression: ir.Expression) -> ir.Expression:
            if isinstance(expression, ir.Signal) and isinstance(expression.index, ir.IntLiteral):
                self.highest[expression.kind] = max(self.highest.get(expression.kind, 0), expression.index.value)
            match expression:
                case ir.System(name="flag" | "cyclic_flag", indices=(ir.IntLiteral(value=number),)):
                    self.highest["flag"] = max(self.highest.get("flag", 0), number)
            return rewrite_parts(expression, look)

        def deeper(body: ir.Body) -> ir.Body:
            for statement in body:
                if isinstance(statement, ir.OrderInterrupt) and statement.event == "change":
                    self.flags_watched = self.flags_watched or _is_flag(statement.condition)
                self.note(statement)
            return tuple(rewrite_parts(statement, look, deeper) for statement in body)

        for module in program.modules:
            for declaration in module.declarations:
                if isinstance(declaration, ir.SignalDeclaration):
                    signal = declaration.signal
                    look(signal)
                    if self.declared.setdefault(declaration.name.lower(), signal) != signal:
                        continue
                    self.context.signal_groups.setdefault(declaration.name, signal)
                    if isinstance(signal.index, ir.IntLiteral) and signal.last is None:
                        self.aliases.setdefault((signal.kind, signal.index.value), declaration.name)
            for routine in module.routines:
                for body in bodies(routine):
                    deeper(body)

    def note(self, statement: ir.Statement) -> None:
        """Note what a variable or an element is set to, or counts to."""
        match statement:
            case ir.Assign(target=ir.Name() | ir.Index() as target, value=ir.IntLiteral(value=number)):
                key = _place(target)
                self.given[key] = max(self.given.get(key, 0), number)
            case ir.For(counter=name, start=start, stop=stop):
                ends = [one.value for one in (start, stop) if isinstance(one, ir.IntLiteral)]
                self.given[name.lower()] = max([self.given.get(name.lower(), 0), *ends])
            case ir.CallRoutine(name=str() as name, arguments=arguments):
                for place, argument in zip(self.parameters.get(name.lower(), ()), arguments, strict=False):
                    key = (argument.name or place).lower()
                    if isinstance(argument.value, ir.IntLiteral):
                        self.given[key] = max(self.given.get(key, 0), argument.value.value)

    def put_into(self, index: ir.Expression) -> list[int]:
        """The whole numbers that the program puts into an index, as far as they are seen; `n - 1000` counts too."""
        match index:
            case ir.Binary(op="-" | "+" as op, left=ir.Name() | ir.Index() as left, right=ir.IntLiteral(value=offset)):
                found = self.given.get(_place(left), 0)
                return [found - offset if op == "-" else found + offset] if found else []
        return [self.given.get(_place(node), 0) for node in walk(index) if isinstance(node, ir.Name | ir.Index)]

    def in_scope(self, scope: Scope) -> _Named:
        self.scope = scope
        return self

    def body(self, body: ir.Body) -> ir.Body:
        return tuple(self.statement(statement) for statement in body)

    def statement(self, statement: ir.Statement) -> ir.Statement:
        match statement:
            case ir.Assign(target=ir.Signal(index=index, name=None) as signal, value=value) if (
                signal.kind != "flag" and not _constant(index)
            ):
                assert index is not None
                routine = self.routine(f"set_{signal.kind}", statement.origin, signal.kind, index)
                arguments = (ir.Argument(self.expression(index)), ir.Argument(self.expression(value)))
                return ir.CallRoutine(routine, arguments, origin=statement.origin)
            case ir.Pulse(
                signal=ir.Signal(kind="digital_out", index=index, name=None), value=ir.BoolLiteral(value=True)
            ) if index is not None and not _constant(index):
                routine = self.routine("pulse_digital_out", statement.origin, "digital_out", index)
                arguments = (ir.Argument(self.expression(index)), ir.Argument(self.expression(statement.duration)))
                return ir.CallRoutine(routine, arguments, origin=statement.origin)
        return rewrite_parts(statement, self.expression, self.body)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Name(id=name) if self.scope is not None:
                symbol = self.scope.value(name)
                if symbol is not None and isinstance(symbol.declaration, ir.SignalDeclaration):
                    signal = symbol.declaration.signal
                    if signal.last is not None and self.declared.get(name.lower()) == signal:
                        kind = signal.kind.replace("digital", "group")
                        return ir.Signal(kind, name=symbol.declaration.name, origin=expression.origin)
                    return self.expression(replace(signal, origin=expression.origin))
                return expression
            case ir.Signal(kind="flag", index=index, last=None, name=None) if index is not None:
                return self.expression(ir.System("flag", (index,), origin=expression.origin))
            case ir.Signal(kind=kind, index=ir.IntLiteral(value=first), last=ir.IntLiteral(value=last), name=None):
                bits = ir.Signal(kind.replace("group", "digital"), ir.IntLiteral(first), ir.IntLiteral(last))
                kind = kind.replace("digital", "group")
                name = f"{self.prefixes.get(kind, kind)}{first}_{last}"
                self.context.signal_groups.setdefault(name, bits)
                return ir.Signal(kind, name=name, origin=expression.origin)
            case ir.Signal(kind=kind, index=index, name=None):
                if index is not None and _constant(index):
                    assert isinstance(index, ir.IntLiteral)
                    return ir.Signal(kind, name=self.name_of(kind, index.value), origin=expression.origin)
                assert index is not None
                routine = self.routine(f"get_{kind}", expression.origin, kind, index)
                argument = ir.Argument(self.expression(index))
                return ir.Call(routine, (argument,), origin=expression.origin)
            case ir.System(name="flag" | "cyclic_flag", indices=indices):
                if self.flags is None:
                    self.flags = self.context.fresh("rpl_flag")
                inner = tuple(self.expression(index) for index in indices)
                return ir.Index(ir.Name(self.flags), inner, origin=expression.origin)
        return rewrite_parts(expression, self.expression)

    def name_of(self, kind: str, number: int) -> str:
        """What the signal is called: in the map of an earlier translation, on the robot that will run the program, in
        the source, else by its number."""
        said = self.context.registers.get((kind, number)) or self.context.there.signals.get((kind, number))
        name = said or self.aliases.get((kind, number)) or f"{self.prefixes.get(kind, kind)}{number}"
        if said:
            self.context.signal_groups.setdefault(name, ir.Signal(kind, ir.IntLiteral(number)))
        self.context.signal_names[kind, number] = name
        return name

    def routine(self, what: str, origin: Origin, kind: str, index: ir.Expression) -> str:
        """The routine for signals of the kind. What the program itself puts into the index is in reach."""
        if what not in self.dynamic:
            self.dynamic[what] = self.context.fresh(f"rpl_{what}")
        numbers = (one for one in self.put_into(index) if one <= _MOST)
        self.highest[kind] = max([self.highest.get(kind, 0), *numbers])
        self.context.diagnostics.report(DYNAMIC, origin, last=self.reach(kind))
        return self.dynamic[what]

    def flag_count(self) -> int:
        return max(_FLAGS, self.highest.get("flag", 0))

    def reach(self, kind: str) -> int:
        return max(_REACH, self.highest.get(kind, 0))

    def support(self, dialect: str, task: str) -> tuple[ir.Module, ...]:
        """The generated routines and data, when there are any."""
        declarations: tuple[ir.Declaration, ...] = ()
        if self.flags is not None:
            type = ir.ArrayType(ir.BoolType(), (ir.IntLiteral(self.flag_count()),))
            storage = "persistent" if self.flags_watched else "variable"
            declarations = (ir.Variable(self.flags, type, storage=storage, scope="global"),)
        routines = tuple(self.access(what, name) for what, name in self.dynamic.items())
        if not declarations and not routines:
            return ()
        return (ir.Module(self.context.fresh("rpl_signals"), dialect, declarations, routines, task=task),)

    def access(self, what: str, name: str) -> ir.Routine:
        verb, _, kind = what.partition("_")
        type: ir.Type = _VALUES.get(kind.partition("_")[0], ir.BoolType())
        number, value = ir.Parameter("number", ir.IntType()), ir.Parameter("state", type)
        cases = []
        for index in range(1, self.reach(kind) + 1):
            signal_name = self.aliases.get((kind, index)) or f"{self.prefixes.get(kind, kind)}{index}"
            signal = ir.Signal(kind, name=signal_name)
            act: ir.Statement = ir.Return(signal)
            if verb == "set":
                act = ir.Assign(signal, ir.Name("state"))
            elif verb == "pulse":
                act = ir.Pulse(signal, ir.BoolLiteral(True), ir.Name("duration"))
            cases.append(ir.Case((ir.IntLiteral(index),), (act,)))
        failed: ir.Body = (
            ir.Message("error", ir.TextLiteral("signal number out of reach")),
            ir.Halt(),
        )
        switch = ir.Switch(ir.Name("number"), tuple(cases), failed)
        if verb == "set":
            return ir.Routine(name, "procedure", (number, value), body=(switch,), scope="global")
        if verb == "pulse":
            duration = ir.Parameter("duration", ir.RealType())
            return ir.Routine(name, "procedure", (number, duration), body=(switch,), scope="global")
        zero: ir.Expression = ir.BoolLiteral(False) if isinstance(type, ir.BoolType) else ir.IntLiteral(0)
        return ir.Routine(name, "function", (number,), type, body=(switch, ir.Return(zero)), scope="global")


def _constant(index: ir.Expression | None) -> bool:
    return isinstance(index, ir.IntLiteral)


@legalising(
    unless=lambda context: context.capabilities.io.signal_prefixes, sees=("Signal", "SignalDeclaration", "SignalType")
)
def number_signals(program: ir.Program, context: Context) -> ir.Program:
    """For targets whose signals have numbers."""
    computed = _computed(program)
    program, places = parameters_as_numbers(program)
    return numbers_as_arguments(_with_numbers(program, context, computed), places)


def _computed(program: ir.Program) -> frozenset[str]:
    """Kinds of single signals whose number a program calculates."""
    routines = [routine for module in program.modules for routine in module.routines]
    return frozenset(
        node.kind
        for node in walk_for({"Signal"}, *routines)
        if isinstance(node, ir.Signal) and node.last is None and not isinstance(node.index, ir.IntLiteral | None)
    )


def _with_numbers(program: ir.Program, context: Context, computed: frozenset[str]) -> ir.Program:
    prefixes, own_signals = _prefixes(), context.capabilities.io.own_signals
    alone = GroupRule.NUMBERED not in context.capabilities.io.groups

    def known(signal: ir.Signal) -> str | None:
        """The name of a named signal, or that of a group with a number of its own."""
        match signal:
            case ir.Signal(name=str() as name):
                return None if name.lower() in own_signals else name
            case ir.Signal(kind=kind, index=ir.IntLiteral(value=number), last=None) if kind.startswith("group"):
                return f"{min(prefixes.get(kind, {kind}))}{number}" if alone else None
        return None

    names, used = _named_and_numbered(program, known, alone)
    if not names:
        return program
    for kind in computed:  # any of them may be meant
        taken = used.setdefault(kind, set())
        taken.update(range(1, max({_REACH, *taken}) + 1))
    widest = context.capabilities.io.widest_group
    own = rules_of(context.source).group_bits
    widths = group_widths(program, known, widest, WIDTH if alone else widest, own)
    earlier = {(kind, name.lower()): at for (kind, at), name in context.there.signals.items() if name}
    earlier |= {(kind, name.lower()): number for (kind, number), name in context.registers.items()}
    for kind, number in context.there.signals:
        used.setdefault(_bits(kind) if alone else kind, set()).add(number)
    numbers = _numbers(names, prefixes, used, alone, {key: bits for key, (bits, _) in widths.items()}, earlier)
    declared, aliases = _chosen(context, names, numbers, widths, alone)

    def replaced(expression: ir.Expression) -> ir.Expression:
        name = known(expression) if isinstance(expression, ir.Signal) else None
        if isinstance(expression, ir.Signal) and name is not None:
            key = (expression.kind, name.lower())
            if key in aliases:
                return ir.Name(aliases[key], origin=expression.origin)
            return replace(_signal(expression.kind, numbers[key][0], alone), origin=expression.origin)
        return rewrite_parts(expression, replaced)

    def replaced_body(body: ir.Body) -> ir.Body:
        return map_body(body, lambda statement: (rewrite_parts(statement, replaced, replaced_body),), {"Signal"})

    modules = list(edit_all(program, replaced_body).modules)
    if declared:
        name = context.fresh("rpl_signals")
        modules.append(ir.Module(name, modules[0].dialect, tuple(declared), task=modules[0].task, public=True))
    return replace(program, modules=tuple(modules))


def _chosen(
    context: Context,
    names: dict[tuple[str, str], str],
    numbers: dict[tuple[str, str], tuple[int, bool]],
    widths: dict[tuple[str, str], tuple[int, bool]],
    alone: bool,
) -> tuple[list[ir.Declaration], dict[tuple[str, str], str]]:
    """Declarations of the signals whose numbers were chosen, and their names; each is reported."""
    declared: list[ir.Declaration] = []
    aliases: dict[tuple[str, str], str] = {}
    for (kind, key), name in names.items():
        number, chosen = numbers[kind, key]
        if chosen:
            alias = context.fresh(name)
            aliases[kind, key] = alias
            bits, fits = widths.get((kind, key), (WIDTH, True))
            signal = _signal(kind, number, alone, bits)
            declared.append(ir.SignalDeclaration(alias, signal, scope="global"))
            last = signal.last.value if isinstance(signal.last, ir.IntLiteral) else number
            if context.there.signals.get((kind, number), "").lower() != key:  # there it is wired already
                said = number if last == number else f"{number} to {last}"
                context.diagnostics.report(NUMBERED, name=name, number=said)
            if not fits:
                context.diagnostics.report(TOO_NARROW, name=name, bits=bits, most=(1 << bits) - 1)
    return declared, aliases


def _named_and_numbered(
    program: ir.Program, known: Callable[[ir.Signal], str | None], alone: bool
) -> tuple[dict[tuple[str, str], str], dict[str, set[int]]]:
    """The names that routines use, by kind and folded name, and the numbers in use, by kind of the single signals."""
    names: dict[tuple[str, str], str] = {}
    used: dict[str, set[int]] = {}
    for node in walk(*(routine for module in program.modules for routine in module.routines)):
        if isinstance(node, ir.Signal):
            name = known(node)
            if name is not None:
                names.setdefault((node.kind, name.lower()), name)
    for node in walk_for({"Signal"}, *program.modules):
        if isinstance(node, ir.Signal) and isinstance(node.index, ir.IntLiteral) and known(node) is None:
            last = node.last.value if isinstance(node.last, ir.IntLiteral) else node.index.value
            bits = node.kind if node.last is None and not alone else _bits(node.kind)
            used.setdefault(bits, set()).update(range(node.index.value, last + 1))
    return names, used


def _bits(kind: str) -> str:
    return kind.replace("group", "digital")


def _signal(kind: str, number: int, alone: bool, width: int = WIDTH) -> ir.Signal:
    """A group of bits gets numbers in a row; where groups have numbers of their own (not `alone`) the controller knows
    its bits."""
    if kind.startswith("group") and alone:
        last = ir.IntLiteral(number + width - 1)
        return ir.Signal(_bits(kind), index=ir.IntLiteral(number), last=last)
    return ir.Signal(kind, index=ir.IntLiteral(number))


def _prefixes() -> dict[str, set[str]]:
    """The prefixes with which any target names a numbered signal of a kind."""
    found: dict[str, set[str]] = {}
    for name in registry.target_names():
        for kind, prefix in registry.target(name).capabilities().io.signal_prefixes.items():
            found.setdefault(kind, set()).add(prefix.lower())
    return found


def _numbers(
    names: dict[tuple[str, str], str],
    prefixes: dict[str, set[str]],
    numbered: dict[str, set[int]],
    alone: bool,
    widths: dict[tuple[str, str], int],
    earlier: dict[tuple[str, str], int],
) -> dict[tuple[str, str], tuple[int, bool]]:
    """Number of each named signal, and whether it was chosen (by an `earlier` map, or off the `numbered` and those that
    the map gives to others) and not said by its name."""
    result: dict[tuple[str, str], tuple[int, bool]] = {}
    used: dict[str, set[int]] = {}

    def width(kind: str, key: str) -> int:
        return widths.get((kind, key), WIDTH) if alone and kind.startswith("group") else 1

    for kind, key in names:
        if (kind, key) in earlier:
            first = earlier[kind, key]
            used.setdefault(_bits(kind) if alone else kind, set()).update(range(first, first + width(kind, key)))
            result[kind, key] = (first, True)
    for kind, key in names:
        if (kind, key) in result:
            continue
        match = re.fullmatch(r"([a-z_]+?)_?([1-9]\d{0,3})", key)
        # The number of a group is not that of its first bit: groups of bits are declared by their names.
        if match and not (alone and kind.startswith("group")) and match.group(1) in prefixes.get(kind, set()):
            number = int(match.group(2))
            if number not in used.setdefault(kind, set()):
                used[kind].add(number)
                result[kind, key] = (number, False)
    for kind, key in names:
        if (kind, key) in result:
            continue
        bits = _bits(kind) if alone else kind
        taken = used.setdefault(bits, set())
        kept = {number for (other, _), number in earlier.items() if (_bits(other) if alone else other) == bits}
        number, taken = 1, taken | numbered.get(bits, set()) | kept
        # Groups: whole bytes of the numbers, which every controller can take at once.
        bit_count = width(kind, key)
        while any(number + bit in taken for bit in range(bit_count)):
            number += min(bit_count, WIDTH)
        used[bits].update(range(number, number + bit_count))
        result[kind, key] = (number, True)
    return result


def _is_flag(condition: ir.Expression | None) -> bool:
    match condition:
        case ir.System(name="flag") | ir.Signal(kind="flag"):
            return True
    return False


__all__ = ["name_signals", "number_signals"]
