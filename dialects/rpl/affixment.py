"""Frames that hang on other frames: `FRAME part = {...} ON table`.

The variable keeps its offset, and its components are those of the offset; wherever the frame itself is used, it stands
for `table : part`. So it follows when the table moves.

A use means the frame that its name means there, in whichever file or module it was declared. Where the names of what it
hangs on mean something else, or nothing, a function of the frame's own module says where the frame is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar, cast

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import map_children, walk
from rpl.passes.scope import ProgramScope, Scope
from rpl.source import Origin

from .references import by_reference

Affixment = tuple[str, ir.Expression, Origin]
"""A hanging frame as it was declared: its name, what it hangs on, and where."""
Key = tuple[int, int, str]
Node = TypeVar("Node")

CYCLE = code(
    "frame-on-itself",
    Severity.ERROR,
    "frame {name} hangs on itself: {way}",
    "let one of them hang on something else, or on nothing",
)
CHANGED_COPY = code(
    "hanging-frame-by-reference",
    Severity.WARNING,
    "{name} hangs on another frame: {routine} is given the place itself; what it changes there is not kept in {name}",
    "assign to {name} or its components, or pass a variable",
)


def affix(program: ir.Program, affixed: Sequence[Affixment], diagnostics: Diagnostics) -> ir.Program:
    """The program with every use of a hanging frame put together with what it hangs on."""
    if not affixed:
        return program
    bases = {_key(name, origin): base for name, base, origin in affixed}
    hanging = _Hanging(ProgramScope(program), bases, diagnostics)
    modules = [hanging.in_module(module) for module in program.modules]
    added = hanging.added
    return replace(
        program,
        modules=tuple(
            replace(new, routines=(*new.routines, *added[id(old)].values())) if id(old) in added else new
            for old, new in zip(program.modules, modules, strict=True)
        ),
    )


def _key(name: str, origin: Origin) -> Key:
    return id(origin.source), origin.start, name.lower()


@dataclass(slots=True)
class _Hanging:
    """The hanging frames of a program and what their uses become."""

    scopes: ProgramScope
    bases: Mapping[Key, ir.Expression]
    diagnostics: Diagnostics
    added: dict[int, dict[str, ir.Routine]] = field(default_factory=dict)  # module -> frame -> the function for it
    _full: dict[int, ir.Expression] = field(default_factory=dict)  # declaration -> base in the words of its own place
    _open: list[ir.Variable] = field(default_factory=list)

    def in_module(self, module: ir.Module) -> ir.Module:
        outer = self.scopes.module(module)
        declared = tuple(self._used(declaration, outer) for declaration in module.declarations)
        routines = tuple(self._used(one, self.scopes.routine(module, one)) for one in module.routines)
        return replace(module, declarations=declared, routines=routines)

    def _used(self, node: Node, scope: Scope) -> Node:
        return cast(Node, self._replaced(node, scope))

    def _replaced(self, node: object, scope: Scope) -> object:
        match node:
            case ir.Name():
                return self._use(node, scope)
            case ir.Field(base=ir.Name()):
                return node
            case ir.Assign(target=target, value=value):
                # Assigning sets the offset itself; only indices on the left are uses.
                return replace(node, target=self._place(target, scope), value=self._used(value, scope))
            case ir.Search(found=found) if found is not None:
                rest = map_children(replace(node, found=None), lambda child: self._replaced(child, scope))
                return replace(rest, found=self._place(found, scope))
            case ir.For(counter=counter, scoped=True):
                inner = scope.with_value(ir.Variable(counter, ir.IntType()))
                heads = {part: self._used(getattr(node, part), scope) for part in ("start", "stop", "step")}
                return replace(node, **heads, body=tuple(self._used(one, inner) for one in node.body))
            case ir.Call(name=name, arguments=arguments) | ir.CallRoutine(name=name, arguments=arguments):
                self._report_changed(name, arguments, scope)
        return map_children(node, lambda child: self._replaced(child, scope))

    def _place(self, target: ir.Expression, scope: Scope) -> ir.Expression:
        match target:
            case ir.Name():
                return target
            case ir.Field(base=base) | ir.Index(base=base):
                inner = replace(target, base=ir.Name(""))
                return replace(self._used(inner, scope), base=self._place(base, scope))
        return self._used(target, scope)

    def _use(self, name: ir.Name, scope: Scope) -> ir.Expression:
        frame = self._frame(name, scope)
        if frame is None:
            return name
        home = self._home(frame, scope)
        base = self._base(frame, home)
        if base is None:
            return name
        if all(_meant(node, scope) is _meant(node, home) for node in walk(base)):
            return ir.Binary(":", base, name, origin=name.origin)
        return ir.Call(self._function(frame, base, home.module).name, (), origin=name.origin)

    def _frame(self, name: ir.Name, scope: Scope) -> ir.Variable | None:
        """The hanging frame that the name means here."""
        found = scope.value(name.id)
        if found is None or not isinstance(found.declaration, ir.Variable):
            return None
        frame = found.declaration
        return frame if _key(frame.name, frame.origin) in self.bases else None

    def _home(self, frame: ir.Variable, scope: Scope) -> Scope:
        """Where the frame was declared: its module, or the routine that it is used in."""
        module = self.scopes.home(frame)
        return scope if module is None else self.scopes.module(module)

    def _base(self, frame: ir.Variable, home: Scope) -> ir.Expression | None:
        """What the frame hangs on, said in full; nothing when that leads back to the frame."""
        if id(frame) not in self._full:
            if any(one is frame for one in self._open):
                way = " on ".join([*(one.name for one in self._open), frame.name])
                self.diagnostics.report(CYCLE, frame.origin, name=frame.name, way=way)
                return None
            self._open.append(frame)
            self._full[id(frame)] = self._used(self.bases[_key(frame.name, frame.origin)], home)
            self._open.pop()
        return self._full[id(frame)]

    def _function(self, frame: ir.Variable, base: ir.Expression, home: ir.Module) -> ir.Routine:
        """The function of the frame's module that gives the place of the frame."""
        added = self.added.setdefault(id(home), {})
        if frame.name.lower() not in added:
            place = ir.Binary(":", base, ir.Name(frame.name, origin=frame.origin), origin=frame.origin)
            added[frame.name.lower()] = ir.Routine(
                self._free(f"place_of_{frame.name}"),
                "function",
                returns=ir.PoseType(),
                body=(ir.Return(place, origin=frame.origin),),
                scope="global",
                origin=frame.origin,
            )
        return added[frame.name.lower()]

    def _free(self, wanted: str) -> str:
        """The name, with a number where it is taken anywhere in the program."""
        taken = {name.lower() for name in self._names()}
        found, number = wanted, 1
        while found.lower() in taken:
            number += 1
            found = f"{wanted}_{number}"
        return found

    def _names(self) -> Iterator[str]:
        for module in self.scopes.program.modules:
            yield from (routine.name for routine in module.routines)
            yield from (node.name for node in walk(module) if isinstance(node, ir.Variable | ir.Parameter))
        yield from (routine.name for routines in self.added.values() for routine in routines.values())

    def _report_changed(self, name: str, arguments: Sequence[ir.Argument], scope: Scope) -> None:
        """Frames that are passed to a parameter through which the routine would change them."""
        for value in by_reference(name, arguments, scope):
            if isinstance(value, ir.Name) and self._frame(value, scope) is not None:
                self.diagnostics.report(CHANGED_COPY, value.origin, name=value.id, routine=name)


def _meant(node: object, scope: Scope) -> object:
    """The declaration that a part of a base means at a place; None for what means the same everywhere."""
    match node:
        case ir.Name(id=name):
            found = scope.value(name)
            return found.declaration if found is not None else None
        case ir.Call(name=name):
            return scope.routine(name)
        case ir.EnumLiteral(member=member):
            return scope.enum_of(member)
    return None
