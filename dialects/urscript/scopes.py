"""Whose variable a name is. URScript decides it by one rule (script manual, scoping): what the program itself assigns
is global; inside a function a name is global if the project has such a global, else local; `local` and `global`
say it.
A nested function sees the globals, not its outer function's variables, so functions can stand side by side in the IR.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import PureWindowsPath

from rpl import ir
from rpl.source import Origin, Source

from . import nodes
from .functions import constant
from .kinds import Kind, is_joints
from .nodes import Block, Define, Expr, Node


@dataclass(slots=True, eq=False)
class Symbol:
    """One variable or parameter. uses: `joints` passed as a place of the arm, `array` indexed by a computed number or
    used as a whole list. `stores`: how many statements assign it. `read`: more than `join` and `kill` look at
    it. `given`: the one statement of the program that gives it a constant value; it becomes the declaration's."""

    name: str
    origin: Origin
    owner: Function | None = None
    kind: Kind | None = None
    hint: Kind | None = None
    joints_use: bool = False
    array_use: bool = False
    stores: int = 0
    read: bool = False
    parameter: bool = False
    given: nodes.Store | None = None
    told_apart: str = ""

    @property
    def only_handle(self) -> bool:
        """Does it hold nothing but the number of one thread, for `join` and `kill`?"""
        kind = self.kind
        return kind is not None and kind.word == "thread" and len(kind.threads) == 1 and not self.read

    @property
    def spelled(self) -> str:
        """Its name in the IR."""
        return self.told_apart or self.name

    @property
    def is_joints(self) -> bool:
        """Is it kept as joints of the arm rather than as a list?"""
        if self.array_use or not is_joints(self.kind):
            return False
        return self.joints_use or (self.kind is not None and self.kind.joints)


@dataclass(slots=True, eq=False)
class Function:
    """A def, thread or sec, or the statements of a file (`loose`). `name` is its name in the IR."""

    node: Define
    file: File
    outer: Function | None
    name: str
    program: bool = False
    loose: bool = False
    parameters: dict[str, Symbol] = field(default_factory=dict)
    locals: dict[str, Symbol] = field(default_factory=dict)
    globals: set[str] = field(default_factory=set)
    inner: dict[str, Function] = field(default_factory=dict)
    returns: Kind | None = None
    gives: bool = False

    @property
    def kind(self) -> str:
        return self.node.kind


@dataclass(slots=True, eq=False)
class File:
    """One source: its functions (nested ones too), its globals, its program."""

    source: Source
    name: str
    globals: dict[str, Symbol] = field(default_factory=dict)
    functions: list[Function] = field(default_factory=list)
    top: dict[str, Function] = field(default_factory=dict)
    program: Function | None = None
    start: str = ""
    leading: tuple[ir.Nothing, ...] = ()


@dataclass(slots=True, eq=False)
class Project:
    """All sources together. counts_registers: a program works out which integer register it means."""

    files: list[File] = field(default_factory=list)
    counts_registers: bool = False

    def functions(self) -> Iterator[Function]:
        for file in self.files:
            yield from file.functions

    def symbols(self) -> Iterator[Symbol]:
        for file in self.files:
            yield from file.globals.values()
            for function in file.functions:
                yield from function.parameters.values()
                yield from function.locals.values()

    def function(self, name: str, here: Function) -> Function | None:
        """The function that a call means: nested here, around here, of the file, of the project."""
        scope: Function | None = here
        while scope is not None:
            if name in scope.inner:
                return scope.inner[name]
            if scope.node.name == name and scope.node.name:
                return scope
            scope = scope.outer
        if name in here.file.top:
            return here.file.top[name]
        return next((file.top[name] for file in self.files if name in file.top), None)

    def symbol(self, name: str, here: Function) -> Symbol | None:
        """The variable that a name means; None when nothing in the project assigns it."""
        found = here.parameters.get(name)
        if found is None and name not in here.globals:
            found = here.locals.get(name)
        if found is None:
            found = here.file.globals.get(name)
        if found is None:
            found = next((file.globals[name] for file in self.files if name in file.globals), None)
        return found


def collect(contents: list[tuple[Source, Block]]) -> Project:
    """Functions and variables of all sources. Each content is the nodes at the top of a file."""
    project = Project()
    for source, block in contents:
        project.files.append(_file(source, block))
    called = {name for file in project.files for function in file.functions for name in _called(function)}
    for file in project.files:
        _find_program(file, called)
    for file in project.files:
        for function in file.functions:
            _declare_globals(function)
    for function in project.functions():
        _declare_locals(function, project)
    _tell_apart(project)
    return project


def _tell_apart(project: Project) -> None:
    """Names that differ in case alone are one name to most other languages: the later spelling gets a number."""
    spellings: dict[str, list[str]] = {}
    for name in (*(f.name for f in project.functions()), *(symbol.name for symbol in project.symbols())):
        known = spellings.setdefault(name.lower(), [])
        if name not in known:
            known.append(name)
    changed: dict[str, str] = {}
    taken = set(spellings)
    for known in spellings.values():
        for name in known[1:]:
            number = 2
            while f"{name}_{number}".lower() in taken:
                number += 1
            changed[name] = f"{name}_{number}"
            taken.add(changed[name].lower())
    for function in project.functions():
        function.name = changed.get(function.name, function.name)
    for symbol in project.symbols():
        symbol.told_apart = changed.get(symbol.name, "")


def identifier(text: str) -> str:
    """A name from a file's name."""
    name = re.sub(r"\W", "_", text) or "program"
    return f"_{name}" if name[0].isdigit() else name


def _file(source: Source, block: Block) -> File:
    stem = identifier(PureWindowsPath(source.path).stem)
    file = File(source, stem)
    loose: list[Node] = []
    leading: list[ir.Nothing] = []
    for node in block:
        if isinstance(node, Define):
            _add(node, file, None)
        elif isinstance(node, ir.Nothing) and not loose:
            leading.append(node)
        else:
            loose.append(node)
    file.leading = tuple(leading)
    starts = [_start(node, file) for node in loose]
    if loose and all(starts):
        file.start = starts[-1]
    elif any(not isinstance(node, ir.Nothing) for node in loose):
        name = stem if stem not in file.top else "main" if "main" not in file.top else f"{stem}_program"
        node = Define("def", name, (), tuple(loose), loose[0].origin)
        program = Function(node, file, None, name, program=True, loose=True)
        for inner in _defines(tuple(loose)):
            _add(inner, file, None)
        file.functions.insert(0, program)
        file.program = program
    else:
        file.leading += tuple(node for node in loose if isinstance(node, ir.Nothing))
    return file


def _start(node: Node, file: File) -> str:
    """The program that a line behind it starts (`name()`), or a remark."""
    match node:
        case nodes.Perform(call=nodes.Apply(name=name, arguments=(), base=None)):
            found = file.top.get(name)
            return name if found is not None and found.kind == "def" and not found.node.parameters else ""
    return ""


def _add(node: Define, file: File, outer: Function | None) -> None:
    name, taken = node.name, {function.name for function in file.functions}
    if name in taken:
        name = f"{outer.name}_{node.name}" if outer is not None else node.name
    while name in taken:
        name += "_"
    function = Function(node, file, outer, name)
    (file.top if outer is None else outer.inner)[node.name] = function
    file.functions.append(function)
    for parameter, _ in node.parameters:
        function.parameters[parameter] = Symbol(parameter, node.origin, function, parameter=True)
    for inner in _defines(node.body):
        _add(inner, file, function)


def _defines(block: Block) -> Iterator[Define]:
    """Functions defined in a block, in its branches and loops too."""
    for node in statements(block):
        if isinstance(node, Define):
            yield node


def statements(block: Block) -> Iterator[Node]:
    """All statements of a block and of the blocks in it; those of nested functions not."""
    for node in block:
        yield node
        match node:
            case nodes.Branches(branches=branches, otherwise=otherwise):
                for _, body in branches:
                    yield from statements(body)
                yield from statements(otherwise)
            case nodes.Repeat(body=body):
                yield from statements(body)


def own_expressions(node: Node) -> tuple[Expr, ...]:
    """The expressions that a statement itself has."""
    match node:
        case nodes.Store(target=target, value=value):
            return (target, value)
        case nodes.Perform(call=call):
            return (call,)
        case nodes.Branches(branches=branches):
            return tuple(condition for condition, _ in branches)
        case nodes.Repeat(condition=condition):
            return (condition,)
        case nodes.Give(value=value) if value is not None:
            return (value,)
        case nodes.Thread(handle=handle):
            return (handle,)
        case nodes.Define(parameters=parameters):
            return tuple(default for _, default in parameters if default is not None)
    return ()


def calls_inside(expression: Expr) -> list[nodes.Apply]:
    """The calls in an expression, outer ones first."""
    found: list[nodes.Apply] = []
    stack = [expression]
    while stack:
        part = stack.pop()
        if part.__class__ in _SINGLE:
            continue
        if isinstance(part, nodes.Apply):
            found.append(part)
        stack.extend(reversed(nodes.parts(part)))
    return found


_SINGLE = (nodes.Number, nodes.Text, nodes.Truth, nodes.Var)


def _called(function: Function) -> Iterator[str]:
    for node in statements(function.node.body):
        for expression in own_expressions(node):
            for part in calls_inside(expression):
                if part.base is None and part.name != function.node.name:
                    yield part.name


def _find_program(file: File, called: set[str]) -> None:
    """The def that is the program: the one that is started behind it, else the only one that nobody calls."""
    if file.program is not None:
        return
    if file.start:
        file.program = file.top[file.start]
    else:
        uncalled = [f for f in file.top.values() if f.kind == "def" and f.node.name not in called]
        startable = [function for function in uncalled if not function.node.parameters]
        if len(startable) == 1 and (len(uncalled) == 1 or startable[0].inner):
            file.program = startable[0]
        elif len(file.top) == 1:
            file.program = next((f for f in file.top.values() if f.kind == "sec"), None)
    if file.program is not None:
        file.program.program = True


def _stored(function: Function) -> Iterator[tuple[str, str, Origin]]:
    """Scope word, name and place of what a function declares or assigns as a whole."""
    for node in statements(function.node.body):
        match node:
            case (
                nodes.Store(scope=scope, target=nodes.Var(name=name), origin=origin)
                | nodes.Declare(scope=scope, name=name, origin=origin)
            ):
                yield scope, name, origin


def _declare_globals(function: Function) -> None:
    for scope, name, origin in _stored(function):
        if scope == "global" or (function.program and name not in function.parameters):
            function.globals.add(name)
            function.file.globals.setdefault(name, Symbol(name, origin))


def _declare_locals(function: Function, project: Project) -> None:
    """What is said to be local, and what is assigned and no global of the project."""
    if function.program:
        return
    for scope, name, origin in _stored(function):
        if name in function.parameters or name in function.globals or name in function.locals:
            continue
        if scope == "local" or not any(name in file.globals for file in project.files):
            function.locals[name] = Symbol(name, origin, function)


def count_stores(project: Project) -> None:
    """How often each variable is assigned, parts of it counted too."""
    for function in project.functions():
        for node in statements(function.node.body):
            target = node.target if isinstance(node, nodes.Store) else None
            while isinstance(target, nodes.At | nodes.Member):
                target = target.base
            if isinstance(target, nodes.Var):
                symbol = project.symbol(target.name, function)
                if symbol is not None:
                    symbol.stores += 1
            for name in _read_names(node):
                symbol = project.symbol(name, function)
                if symbol is not None:
                    symbol.read = True
    for file in project.files:
        if file.program is not None:
            _find_given(file, file.program)


def _read_names(node: Node) -> Iterator[str]:
    """Variables that a statement looks at, the handles of `join` and `kill` aside."""
    stack = [] if isinstance(node, nodes.Thread) else [*own_expressions(node)]
    if isinstance(node, nodes.Store) and isinstance(node.target, nodes.Var):
        stack = [node.value]
    while stack:
        part = stack.pop()
        if isinstance(part, nodes.Var):
            yield part.name
        stack.extend(nodes.parts(part))


def _is_constant(node: Node) -> bool:
    return isinstance(node, nodes.Store) and constant(node.value)


def _find_given(file: File, program: Function) -> None:
    """What is given once and never changed; in a file that holds nothing but data and functions everything."""
    body = [node for node in program.node.body if not isinstance(node, ir.Nothing | Define)]
    names = [node.target.name for node in body if isinstance(node, nodes.Store) and isinstance(node.target, nodes.Var)]
    data = program.loose and len(set(names)) == len(body) and all(map(_is_constant, body))
    for node in program.node.body:
        match node:
            case nodes.Store(target=nodes.Var(name=name), value=value) if constant(value):
                symbol = file.globals.get(name)
                if symbol is not None and (symbol.stores == 1 or data) and name not in program.parameters:
                    symbol.given = node
