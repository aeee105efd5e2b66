"""Every name of a program made legal for a target, consistently, with the map that gives the source's names back."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.capabilities import AS_MODULE
from rpl.passes.rewrite import changed, rewrite_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of
from rpl.writing.namemap import NameMap
from rpl.writing.target import NameRules
from rpl.writing.text import NameMangler

NO_MAP = NameMap()


def rename(
    program: ir.Program,
    rules: NameRules,
    earlier: NameMap = NO_MAP,
    hiding: Mapping[str, str] = MappingProxyType({}),
    taken: Collection[str] = (),
    numbered: bool = False,
) -> tuple[ir.Program, dict[str, str]]:
    """The program with names that the target accepts, and source name -> new name of those that changed. `earlier`: a
    map whose names are kept; `hiding`: what `rename_hiding` has renamed; `taken`: names (folded) that the controller
    has for something else; `numbered`: of the program it knows routines alone. Raises UsageError for a name of the map
    that the target does not accept."""
    collector = _Collector()
    collector.program(program)
    started = _started(program, collector) if rules.entry == AS_MODULE else {}
    pinned = _pinned(collector, rules, earlier, hiding, frozenset(started))
    if taken:
        shared = (name for name in shared_names(program, numbered) if name not in started)
        pinned = _apart(shared, collector, rules, pinned, taken)
    mangler = NameMangler(rules, collector.names, routines=collector.routines, pinned=pinned)
    changed = mangler.renamed()
    changed |= {name: changed.get(module, module) for name, module in started.items()}
    if not changed:
        return program, {}
    folded = {old.lower(): new for old, new in changed.items()}
    return _Renamer(folded, collector.fields, collector.members, ProgramScope(program)).program(program), changed


def rename_hiding(program: ir.Program, rules: NameRules) -> tuple[ir.Program, dict[str, str]]:
    """The program with other names for what it declares under a name the controller has declared, which it would hide
    (RAPID's `fine`, a function `Offs`), and source name -> new name. Before the passes, which use the controller's."""
    collector = _Collector()
    collector.program(program)
    taken = {name.lower() for name in collector.names}
    changed: dict[str, str] = {}
    for name in collector.declared:
        if name.lower() in rules.predefined:
            numbers = range(2, len(taken) + 3)
            changed[name] = next(f"{name}_{number}" for number in numbers if f"{name}_{number}".lower() not in taken)
            taken.add(changed[name].lower())
    if not changed:
        return program, {}
    folded = {old.lower(): new for old, new in changed.items()}
    return _Renamer(folded, collector.fields, collector.members, ProgramScope(program)).program(program), changed


def renamed_as(program: ir.Program, names: Mapping[str, str]) -> ir.Program:
    """The program with these names (old name -> new name) wherever they stand; nothing else has the new ones."""
    if not names:
        return program
    collector = _Collector()
    collector.program(program)
    folded = {old.lower(): new for old, new in names.items()}
    return _Renamer(folded, collector.fields, collector.members, ProgramScope(program)).program(program)


def _started(program: ir.Program, collector: _Collector) -> dict[str, str]:
    """The routine `main` to the name of its module, where nothing else of the program has either name."""
    mains = [(one.name, module.name) for module in program.modules for one in module.routines if _is_main(one.name)]
    if not mains:  # a name that is the module's in the letters that its language has (V+ `pick.place`)
        mains = [
            (one.name, module.name)
            for module in program.modules
            for one in module.routines
            if one.name.lower() != module.name.lower() and _in_letters(one.name) == _in_letters(module.name)
        ]
    if len(mains) != 1:
        return {}
    [(name, module)] = mains
    own = [one.lower() for one in collector.declared]
    return {} if module.lower() in own or own.count(name.lower()) > 1 else {name: module}


def _in_letters(name: str) -> str:
    return "".join(sign if sign.isalnum() else "_" for sign in name.lower())


def _is_main(name: str) -> bool:
    return name.lower() == "main"


def _pinned(
    collector: _Collector, rules: NameRules, earlier: NameMap, hiding: Mapping[str, str], started: frozenset[str]
) -> dict[str, str]:
    """Names of the program to what the map calls them. A name that keeps its spelling gets another all the same when
    the target does not accept it (any more). What is `started` is called as its module."""
    if not earlier.names:
        return {}
    check = NameMangler(rules, routines=collector.routines)
    folded = {hiding.get(old, old).lower(): (old, new) for old, new in reversed([*earlier.names.items()])}
    found: dict[str, str] = {}
    owners: dict[str, str] = {}
    for name in collector.names:
        old, new = folded.get(name.lower(), ("", ""))
        if not new or name in started:
            continue
        if not check.legal(new) or new.lower() in rules.predefined:
            if new.lower() in (old.lower(), name.lower()):
                continue
            longest = rules.longest_routine or rules.longest if name in collector.routines else rules.longest
            reason = f"{new!r} is no name that a program can have there: a letter, then letters and digits, at most"
            raise earlier.complaint("names", old, f"{reason} {longest} characters, no word of the language")
        other = owners.setdefault(new if rules.case_sensitive else new.lower(), name.lower())
        if other != name.lower():
            raise earlier.complaint("names", old, f"{new!r} is the name of {other} too: give one of them another")
        found[name] = new
    return found


def _apart(
    shared: Iterator[str], collector: _Collector, rules: NameRules, pinned: dict[str, str], taken: Collection[str]
) -> dict[str, str]:
    """`pinned` with other names for what all programs of the controller would know by a name that is taken there."""
    here = NameMangler(rules, collector.names, routines=collector.routines, pinned=pinned)
    used = {*taken, *(here.name(name).lower() for name in collector.names)}
    mine = {name.lower() for name in pinned}
    found = dict(pinned)
    for name in dict.fromkeys(shared):
        new = here.name(name)
        if name.lower() in mine or new.lower() not in taken or new.lower().startswith("rpl_"):
            continue
        longest = rules.longest_routine or rules.longest if name in collector.routines else rules.longest
        tails = (f"_{number}" if "_" in rules.further else str(number) for number in range(2, len(used) + 3))
        found[name] = next(one for tail in tails if (one := new[: longest - len(tail)] + tail).lower() not in used)
        used.add(found[name].lower())
    return found


def shared_names(program: ir.Program, numbered: bool) -> Iterator[str]:
    """Modules, routines and data that all programs of a controller know."""
    for module in program.modules:
        if not numbered:
            yield module.name
        for routine in module.routines:
            yield routine.name
        for declaration in module.declarations:
            if isinstance(declaration, ir.Variable) and not numbered:
                yield declaration.name


def named(program: ir.Program, renamed: Mapping[str, str], numbered: bool) -> dict[str, str]:
    """Source name -> name of what a written program declares; where its data has numbers, of its routines alone. Names
    of our own library are left out: nobody chooses them."""
    back = {new: old for old, new in renamed.items()}
    found: dict[str, str] = {}
    for module in program.modules:
        names = [] if numbered else [module.name]
        for routine in module.routines:
            names.append(routine.name)
            if not numbered:
                names += [one.name for one in routine.parameters]
        for declaration in () if numbered else (*module.declarations, *_inner(module)):
            match declaration:
                case ir.Initialise() | ir.Unread() | ir.ExternalDeclaration():
                    continue
                case ir.EnumDeclaration(name=name, members=members):
                    names += [name, *members]
                case _:
                    names.append(declaration.name)
        found |= {back.get(name, name): name for name in names if not name.lower().startswith("rpl_")}
    return found


def _inner(module: ir.Module) -> tuple[ir.Declaration, ...]:
    return tuple(one for routine in module.routines for one in routine.declarations)


def renamed_routine(program: ir.Program, name: str, new: str) -> ir.Program:
    """The program with another name for that routine; a module of the same name keeps it."""
    done = _Renamer({name.lower(): new}, set(), set(), ProgramScope(program)).program(program)
    pairs = zip(done.modules, program.modules, strict=True)
    return replace(done, modules=tuple(replace(one, name=old.name) for one, old in pairs))


def renamed_twice(first: Mapping[str, str], second: Mapping[str, str]) -> dict[str, str]:
    """Source name -> last name of what was renamed in one of two steps or in both."""
    between = set(first.values())
    done = {old: second.get(new, new) for old, new in first.items()}
    return done | {old: new for old, new in second.items() if old not in between}


class _Collector:
    """All names of a program in order of first appearance, which of them are record fields, and which ones it declares
    itself."""

    def __init__(self) -> None:
        self.names: dict[str, None] = {}
        self.declared: dict[str, None] = {}
        self.fields: set[str] = set()
        self.members: set[str] = set()  # of the program's own enumerations; other words are the controller's
        self.routines: list[str] = []

    def add(self, name: str | None) -> None:
        if name:
            self.names.setdefault(name)

    def own(self, name: str) -> None:
        self.add(name)
        self.declared.setdefault(name)

    def program(self, program: ir.Program) -> None:
        for module in program.modules:
            self.add(module.name)
            for declaration in module.declarations:
                self.declaration(declaration)
            for routine in module.routines:
                self.own(routine.name)
                self.routines.append(routine.name)
                for parameter in routine.parameters:
                    self.own(parameter.name)
                for declaration in routine.declarations:
                    self.declaration(declaration)
                for body in bodies(routine):
                    self.body(body)

    def declaration(self, declaration: ir.Declaration) -> None:
        match declaration:
            case ir.EnumDeclaration(name=name, members=members):
                for one in (name, *members):
                    self.own(one)
                self.members.update(one.lower() for one in members)
            case ir.RecordDeclaration(name=name, fields=fields):
                self.own(name)
                for field, _ in fields:
                    self.add(field)
                    self.fields.add(field.lower())
            case ir.Initialise(assign=assign):
                self.body((assign,))
            case ir.Unread() | ir.ExternalDeclaration():
                return
            case ir.SignalDeclaration(name=name, signal=signal):
                self.add(name)
                self.add(signal.name)
            case _:
                self.own(declaration.name)
                if isinstance(declaration, ir.Variable) and declaration.initial is not None:
                    self.expression(declaration.initial)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Name(id=name) | ir.Call(name=name) | ir.Signal(name=name):
                self.add(name)
            case ir.Present(name=name):
                self.add(name)
        return rewrite_parts(expression, self.expression)

    def body(self, body: ir.Body) -> ir.Body:
        for statement in body:
            match statement:
                case ir.CallRoutine(name=name, dynamic=None) | ir.Label(name=name) | ir.Goto(label=name):
                    self.add(name)
                case ir.For(counter=name) | ir.ConnectInterrupt(routine=name) | ir.TaskControl(task=name):
                    self.add(name)
                case ir.OnError(routine=str() as name):
                    self.add(name)
            rewrite_parts(statement, self.expression, self.body)
        return body


class _Renamer:
    def __init__(self, changed: dict[str, str], fields: set[str], members: set[str], scopes: ProgramScope) -> None:
        self.changed = changed
        self.members = members
        self.changed_fields = fields & set(changed)
        self.scopes = scopes
        self.scope: Scope | None = None

    def new(self, name: str) -> str:
        return self.changed.get(name.lower(), name)

    def program(self, program: ir.Program) -> ir.Program:
        modules = tuple(self.module(module) for module in program.modules)
        tasks = tuple(
            replace(task, entry=self.new(task.entry), modules=tuple(map(self.new, task.modules)))
            for task in program.tasks
        )
        return replace(program, modules=modules, tasks=tasks, entry=self.new(program.entry))

    def module(self, module: ir.Module) -> ir.Module:
        self.scope = self.scopes.module(module)
        declarations = tuple(map(self.declaration, module.declarations))
        routines = tuple(self.routine(module, routine) for routine in module.routines)
        return replace(module, name=self.new(module.name), declarations=declarations, routines=routines)

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.scope = self.scopes.routine(module, routine)
        return replace(
            routine,
            name=self.new(routine.name),
            parameters=tuple(replace(p, name=self.new(p.name), type=self.type(p.type)) for p in routine.parameters),
            returns=None if routine.returns is None else self.type(routine.returns),
            declarations=tuple(map(self.declaration, routine.declarations)),
            body=self.body(routine.body),
            handlers=tuple(
                replace(h, codes=tuple(map(self.expression, h.codes)), body=self.body(h.body)) for h in routine.handlers
            ),
            undo=self.body(routine.undo),
            backward=self.body(routine.backward),
        )

    def type(self, type: ir.Type) -> ir.Type:
        match type:
            case ir.NamedType(name=name):
                return ir.NamedType(self.new(name))
            case ir.ArrayType(element=element):
                return replace(rewrite_parts(type, self.expression), element=self.type(element))
            case ir.StringType():
                return rewrite_parts(type, self.expression)
        return type

    def declaration(self, declaration: ir.Declaration) -> ir.Declaration:
        match declaration:
            case ir.Variable(initial=initial):
                value = None if initial is None else self.expression(initial)
                type = self.type(declaration.type)
                return replace(declaration, name=self.new(declaration.name), type=type, initial=value)
            case ir.RecordDeclaration(fields=fields):
                new = tuple((self.new(name), self.type(type)) for name, type in fields)
                return replace(declaration, name=self.new(declaration.name), fields=new)
            case ir.EnumDeclaration(members=members):
                return replace(declaration, name=self.new(declaration.name), members=tuple(map(self.new, members)))
            case ir.AliasDeclaration(type=type):
                return replace(declaration, name=self.new(declaration.name), type=self.type(type))
            case ir.SignalDeclaration(signal=signal):
                done = self.expression(signal)
                assert isinstance(done, ir.Signal)
                return replace(declaration, name=self.new(declaration.name), signal=done)
            case ir.Initialise(assign=assign):
                (one,) = self.body((assign,))
                return replace(declaration, assign=one) if isinstance(one, ir.Assign) else declaration
        return declaration

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Field(base=base, name=name) if name.lower() in self.changed_fields and self.is_record(base):
                return replace(expression, base=self.expression(base), name=self.new(name))
        done = rewrite_parts(expression, self.expression)
        match done:
            case ir.Name(id=name):
                return changed(done, id=self.new(name))
            case ir.Call(name=name):
                arguments = tuple(map(self.argument, done.arguments))
                return replace(done, name=self.new(name), arguments=arguments)
            case ir.Builtin(function="task_runs", arguments=(ir.TextLiteral(value=name),)):
                return replace(done, arguments=(ir.TextLiteral(self.new(name)),))
            case ir.EnumLiteral(member=name) if name.lower() in self.members:
                return replace(done, member=self.new(name))
            case ir.Present(name=name):
                return replace(done, name=self.new(name))
            case ir.Signal(name=str() as name):
                return replace(done, name=self.new(name))
            case ir.Aggregate(type_name=str() as word) if self.scope is not None:
                if isinstance(self.scope.type(word), ir.RecordDeclaration):
                    entries = tuple((None if n is None else self.new(n), value) for n, value in done.entries)
                    return replace(done, type_name=self.new(word), entries=entries)
        return done

    def is_record(self, base: ir.Expression) -> bool:
        return self.scope is not None and isinstance(type_of(base, self.scope), ir.NamedType | None)

    def argument(self, argument: ir.Argument) -> ir.Argument:
        name = None if argument.name is None else self.new(argument.name)
        present = None if argument.if_present is None else self.new(argument.if_present)
        return replace(argument, name=name, if_present=present)

    def body(self, body: ir.Body) -> ir.Body:
        return tuple(map(self.statement, body))

    def statement(self, statement: ir.Statement) -> ir.Statement:
        done = rewrite_parts(statement, self.expression, self.body)
        match done:
            case ir.CallRoutine(name=name, arguments=arguments):
                return replace(done, name=self.new(name), arguments=tuple(map(self.argument, arguments)))
            case ir.Label(name=name):
                return replace(done, name=self.new(name))
            case ir.Goto(label=name):
                return replace(done, label=self.new(name))
            case ir.For(counter=name):
                return replace(done, counter=self.new(name))
            case ir.ConnectInterrupt(routine=name):
                return replace(done, routine=self.new(name))
            case ir.OnError(routine=str() as name):
                return replace(done, routine=self.new(name))
            case ir.TaskControl(task=name):
                return replace(done, task=self.new(name))
        return done
