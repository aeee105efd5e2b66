"""Questions whether an element of a list has a value yet (V+ `DEFINED(a[n])`), where the target cannot ask as
the source does: a list of BOOLs beside it says which elements have been given one.

Only for lists of one dimension with a known size that get their values element by element. A list that a routine
fills through a parameter, or that is taken whole, stays, and the target refuses the question.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import assigned_in
from rpl.passes.legalise.rewriting.editing import edit_bodies, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope

_MOST = 512  # elements of a list that is written out


@legalising(sees=("function is_uninitialised",))
def asked_elements(program: ir.Program, context: Context) -> ir.Program:
    """The program without the question about elements, as far as it can be followed."""
    if not any(_element(node) for node in walk(*program.modules)):
        return program
    lists = _Lists(program, context)
    return lists.rewritten() if lists.flags else program


def _element(node: object) -> str | None:
    """The list of whose element a question asks."""
    match node:
        case ir.Builtin(function="is_uninitialised", arguments=(ir.Index(base=ir.Name(id=name), indices=(_,)),)):
            return name
    return None


@dataclass(slots=True)
class _Lists:
    """`flags`: id of a declaration -> name of the list beside it. `first`: elements with a value from the start."""

    program: ir.Program
    context: Context
    flags: dict[int, str] = field(default_factory=dict)
    first: dict[int, set[int]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        scopes = ProgramScope(self.program)
        asked: dict[int, ir.Variable] = {}
        lost: set[int] = set()
        for module, routine in scopes.routines():
            scope = scopes.routine(module, routine)
            for node in (node for body in bodies(routine) for node in walk(body)):
                name = _element(node)
                if name is not None and (found := _variable(name, scope)) is not None:
                    asked[id(found)] = found
                lost.update(_lost(node, scope))
        for module in self.program.modules:
            for one in module.declarations:
                if isinstance(one, ir.Initialise):
                    self.starts(one, scopes.module(module), lost)
        for key, variable in asked.items():
            if key not in lost and _size(variable) is not None:
                self.flags[key] = self.context.fresh(f"{variable.name.lstrip('$#')}_set")

    def starts(self, declaration: ir.Initialise, scope: Scope, lost: set[int]) -> None:
        match declaration.assign.target:
            case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=at),)):
                found = _variable(name, scope)
                if found is not None:
                    self.first.setdefault(id(found), set()).add(at)
            case ir.Index(base=ir.Name(id=name)) | ir.Name(id=name):
                found = _variable(name, scope)
                lost.update(() if found is None else (id(found),))

    def beside(self, declarations: tuple[ir.Declaration, ...]) -> tuple[ir.Declaration, ...]:
        """The declarations with the lists of BOOLs."""
        made: list[ir.Declaration] = []
        for one in declarations:
            made.append(one)
            name = self.flags.get(id(one))
            if name is not None and isinstance(one, ir.Variable) and isinstance(one.type, ir.ArrayType):
                base, last = one.type.base, _size(one) or 0
                set_first = self.first.get(id(one), set())
                values = tuple((None, ir.BoolLiteral(at in set_first)) for at in range(base, last + 1))
                type = replace(one.type, element=ir.BoolType())
                made.append(ir.Variable(name, type, ir.Aggregate(values), one.storage, one.scope))
        return tuple(made)

    def rewritten(self) -> ir.Program:
        scopes = ProgramScope(self.program)
        modules = []
        for module in self.program.modules:
            routines = tuple(self.routine(one, scopes.routine(module, one)) for one in module.routines)
            modules.append(replace(module, declarations=self.beside(module.declarations), routines=routines))
        return replace(self.program, modules=tuple(modules))

    def routine(self, routine: ir.Routine, scope: Scope) -> ir.Routine:
        def flag(name: str) -> str | None:
            found = _variable(name, scope)
            return None if found is None else self.flags.get(id(found))

        def answer(node: object) -> object:
            name = _element(node)
            beside = flag(name) if name is not None else None
            if beside is None or not isinstance(node, ir.Builtin) or not isinstance(node.arguments[0], ir.Index):
                return node
            place = replace(node.arguments[0], base=ir.Name(beside))
            return ir.Unary("not", place, origin=node.origin)

        def change(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Assign(target=ir.Index(base=ir.Name(id=name)) as place) if (beside := flag(name)) is not None:
                    now = ir.Assign(replace(place, base=ir.Name(beside)), ir.BoolLiteral(True))
                    return expansion(statement.origin, (statement, now))
            return (inside(statement, lambda body: map_body(body, change)),)

        def asked(body: ir.Body) -> ir.Body:
            return tuple(rewrite(one, answer) for one in map_body(body, change))

        done = edit_bodies(routine, asked)
        return replace(done, declarations=self.beside(routine.declarations))


def _variable(name: str, scope: Scope) -> ir.Variable | None:
    symbol = scope.value(name)
    return symbol.declaration if symbol is not None and isinstance(symbol.declaration, ir.Variable) else None


def _size(variable: ir.Variable) -> int | None:
    """The last index of a list of one dimension."""
    match variable.type:
        case ir.ArrayType(dimensions=(ir.IntLiteral(value=last),), base=base) if last - base < _MOST:
            return last if variable.initial is None else None
    return None


def _lost(node: object, scope: Scope) -> set[int]:
    """Lists (id of their declaration) that a node may give values in another way than element by element."""
    names: set[str] = set()
    match node:
        case ir.Assign(target=ir.Index()):
            return set()
        case ir.CallRoutine(name=name, arguments=arguments) | ir.Call(name=name, arguments=arguments):
            names = _filled(name, arguments, scope)
        case ir.TaskControl(task=name, arguments=arguments) if arguments:
            names = _filled(name, arguments, scope)
        case ir.Assign(target=ir.Name(id=name)):
            names = {name}
        case ir.DeclareInterrupt(action=action) | ir.Trigger(action=action) if isinstance(action, ir.Assign):
            names = set(assigned_in((action,)))
        case ir.Do() | ir.Move() | ir.Dialog() | ir.DefineTrigger() | ir.Spline() | ir.WaitUntil():
            names = set(assigned_in((node,)))
    found = (_variable(name, scope) for name in names)
    return {id(one) for one in found if one is not None}


def _filled(name: str, arguments: tuple[ir.Argument, ...], scope: Scope) -> set[str]:
    """Lists that a routine may fill through its parameters."""
    routine = scope.routine(name)
    changed = None if routine is None else {one for body in bodies(routine) for one in assigned_in(body)}
    names = set()
    for at, argument in enumerate(arguments):
        parameter = routine.parameters[at] if routine is not None and at < len(routine.parameters) else None
        writes = parameter is None or changed is None
        if parameter is not None and changed is not None:
            writes = parameter.mode == "reference" and parameter.name.lower() in changed
        match argument.value:
            case ir.Name(id=given) | ir.Index(base=ir.Name(id=given)) if writes:
                names.add(given)
    return names


__all__ = ["asked_elements"]
