"""Taught data of a program: places, joints, tools and frames with values of their own, and numbers that the controller
keeps. Each is a part of a declaration, of a line of a data list, or of the only statement that sets a variable.

A place that something computes is no taught datum; neither is an element of a list of frames that nobody has filled.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.fold import constant
from rpl.passes.rewrite import each, rewrite_bodies
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typewords import component_names, type_word
from rpl.passes.typing import type_of
from rpl.passes.values import Record, Target, Value, literal, real
from rpl.proof.record import Place, place_of
from rpl.runtime.functions.geometry import rotation_of_vector
from rpl.source import Origin

POINT, TOOL, FRAME, NUMBER = "point", "tool", "frame", "number"
KINDS = (POINT, TOOL, FRAME, NUMBER)

Owner = ir.Variable | ir.Initialise | ir.Assign
Joints = tuple[float, ...]
_PLACE = -1  # in a path: what stands behind a frame's name
_ZERO_MM, _ZERO_DEG = 1e-6, 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Datum:
    """A taught value. `name`: as people say it, with the routine where only that one knows it; `variable`: what is
    declared, `part`: which part of it; `label`: its comment in the controller. `owner`, `path`: the node that holds the
    value and the entries that lead to it. `value`: a pose, joints in degrees, or a number. `first`: the first taught
    part of its variable."""

    name: str
    kind: str
    variable: str
    part: str
    label: str
    routine: str
    owner: Owner
    path: tuple[int, ...]
    type: ir.Type
    value: rigid.Pose | Joints | float
    place: Place
    first: bool = True

    def as_json(self) -> dict[str, object]:
        """A stable document: name, kind, file, line."""
        return {"name": self.name, "kind": self.kind, "file": self.place.file, "line": self.place.line}


def taught_data(program: ir.Program, *, set_numbers: bool = False) -> tuple[Datum, ...]:
    """The taught data of a normalised program that its statements name, in the order of the files. `set_numbers`: also
    numbers that the only statement about a variable sets, as a translation does for those that a controller keeps."""
    finder = _Finder(program, set_numbers)
    return tuple(finder.found())


class _Finder:
    def __init__(self, program: ir.Program, set_numbers: bool) -> None:
        self.program, self.scope, self.set_numbers = program, ProgramScope(program), set_numbers
        routines = [(module, routine) for module in program.modules for routine in module.routines]
        nodes = [node for _, routine in routines for node in walk(routine)]
        nodes += [node for module in program.modules for one in module.declarations for node in walk(one)]
        self.named = {node.id.lower() for node in nodes if isinstance(node, ir.Name)}
        self.tools, self.frames = _settings(nodes)
        self.set = _set_in(nodes)
        self.labels = _names_of_numbers(program)

    def found(self) -> Iterator[Datum]:
        for module in self.program.modules:
            scope = self.scope.module(module)
            yield from self._declared(module.declarations, scope, "")
            for routine in module.routines:
                inner = self.scope.routine(module, routine)
                yield from self._declared(routine.declarations, inner, routine.name)
                own = _set_in(walk(routine))
                for node in walk(*routine.body):
                    if isinstance(node, ir.Assign):
                        yield from self._set_once(node, inner, routine.name, own)

    def _declared(self, declarations: Iterable[ir.Declaration], scope: Scope, routine: str) -> Iterator[Datum]:
        for one in declarations:
            match one:
                case ir.Variable(name=name, initial=ir.Aggregate() | ir.Builtin() as value) if self._is_used(name):
                    yield from self._parts(one, value, scope.resolve(one.type), scope, name, routine, one.label)
                case ir.Variable(name=name, initial=value, storage=storage) if (
                    value and (storage == "persistent" or self.set_numbers) and self._is_used(name)
                ):
                    yield from self._parts(one, value, scope.resolve(one.type), scope, name, routine, one.label)
                case ir.Initialise(assign=ir.Assign(target=target, value=value)) if name := _element(target):
                    type = type_of(target, scope)
                    if type is not None:
                        label = self.labels.get(name.lower(), "")
                        yield from self._parts(one, value, scope.resolve(type), scope, name, routine, label)

    def _set_once(self, node: ir.Assign, scope: Scope, routine: str, own: Counter[str]) -> Iterator[Datum]:
        """A variable that one statement sets to a value that stands there, and settings that do. `own`: how often the
        routine sets each."""
        match node.target:
            case ir.System(name="tool" | "base" as system):
                name, local = TOOL if system == "tool" else FRAME, routine
            case ir.Name() | ir.Index() if name := _element(node.target):
                symbol = scope.value(name.partition("[")[0])
                local = routine if symbol is None or symbol.routine is not None else ""
                if (own if local else self.set)[name.lower()] != 1 or not self._is_used(name.partition("[")[0]):
                    return
            case _:
                return
        type = type_of(node.target, scope)
        number = self.set_numbers and isinstance(node.value, ir.RealLiteral | ir.Unary)
        if type is not None and (number or isinstance(node.value, ir.Aggregate | ir.Builtin | ir.Binary)):
            yield from self._parts(node, node.value, scope.resolve(type), scope, name, local, "")

    def _is_used(self, name: str) -> bool:
        return name.lower() in self.named

    def _parts(
        self, owner: Owner, value: ir.Expression, type: ir.Type, scope: Scope, name: str, routine: str, label: str
    ) -> Iterator[Datum]:
        origin = value.origin if value.origin.source is not None else owner.origin
        number = 0
        for path, part, leaf, kind, known in _leaves(value, type, scope, (), ""):
            begun = isinstance(owner, ir.Variable) and self.set[name.lower()] > 0
            if _is_zero(known) and (number or begun or isinstance(type, ir.ArrayType)):
                continue  # a frame that nobody has filled, or that the program fills
            if _is_of_load(type, part):
                continue  # where a load has its centre is no place
            word = self._kind(kind, name, known)
            shown = f"{routine}.{name}" if routine else name
            told = shown + ("" if not part or (number == 0 and not part.startswith("[")) else part)
            comment = label or self.labels.get(f"{name}{part}".lower(), "")
            at = place_of(_origin_of(leaf, origin))
            yield Datum(told, word, name, part, comment, routine, owner, path, kind, known, at, number == 0)
            number += 1

    def _kind(self, type: ir.Type, name: str, known: rigid.Pose | Joints | float) -> str:
        if isinstance(known, float):
            return NUMBER
        key = name.partition("[")[0].lower()
        if isinstance(type, ir.TargetType | ir.JointsType):
            return POINT
        if key in self.tools:
            return TOOL
        return FRAME if key in self.frames else POINT


def _is_of_load(type: ir.Type, part: str) -> bool:
    """Is it a part of a load, alone or in a tool? A point may have any name."""
    while isinstance(type, ir.ArrayType):
        type = type.element
    of_record = isinstance(type, ir.NamedType) and "load" in type.name.lower()
    return isinstance(type, ir.LoadType) or of_record or "load" in part.lower()


def _settings(nodes: Sequence[object]) -> tuple[set[str], set[str]]:
    """What tools and frames of moves and settings name, folded."""
    tools, frames = {TOOL}, {FRAME}
    for node in nodes:
        match node:
            case ir.Assign(target=ir.System(name="tool"), value=value):
                tools |= _names(value)
            case ir.Assign(target=ir.System(name="base"), value=value):
                frames |= _names(value)
            case ir.Assign(value=ir.Binary(op=":", left=left)):
                frames |= _names(left)
            case ir.Move(tool=tool, frame=frame):
                tools |= _names(tool)
                frames |= _names(frame)
            case ir.Binary(op=":", left=left, right=right) if _names(right):  # a place that is given in a frame
                frames |= _names(left)
    for name in _lists(nodes):
        tools |= {name} if "tool" in name else set()
        frames |= {name} if "frame" in name or "base" in name else set()
    return tools, frames - tools


def _lists(nodes: Sequence[object]) -> set[str]:
    """Names of lists, folded."""
    return {node.base.id.lower() for node in nodes if isinstance(node, ir.Index) and isinstance(node.base, ir.Name)}


def _names(value: ir.Expression | None) -> set[str]:
    return set() if value is None else {node.id.lower() for node in walk(value) if isinstance(node, ir.Name)}


def _names_of_numbers(program: ir.Program) -> dict[str, str]:
    """What data lists call numbered tools and frames: `TOOL_NAME[1]="gripper"` names `tool_data[1]`."""
    found: dict[str, str] = {}
    for module in program.modules:
        for one in module.declarations:
            match one:
                case ir.Initialise(assign=ir.Assign(target=target, value=ir.TextLiteral(value=text))) if (
                    name := _element(target)
                ) and "_name[" in name.lower():
                    found[name.lower().replace("_name[", "_data[")] = text
    return found


def _set_in(nodes: Iterable[object]) -> Counter[str]:
    """How often variables and elements are set, by their folded names."""
    targets = (node.target for node in nodes if isinstance(node, ir.Assign))
    return Counter(_element(one).lower() or _root(one) for one in targets)


def _root(target: ir.Expression) -> str:
    while isinstance(target, ir.Index | ir.Field):
        target = target.base
    return target.id.lower() if isinstance(target, ir.Name) else ""


def _element(target: ir.Expression) -> str:
    match target:
        case ir.Name(id=name):
            return name
        case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=at),)):
            return f"{name}[{at}]"
    return ""


_Leaf = tuple[tuple[int, ...], str, ir.Expression, ir.Type, rigid.Pose | Joints | float]


def _leaves(value: ir.Expression, type: ir.Type, scope: Scope, path: tuple[int, ...], part: str) -> Iterator[_Leaf]:
    """The taught parts of a value: the entries that lead there, the words for it, the expression, type and value."""
    match type, value:
        case ((ir.TargetType() | ir.PoseType()), ir.Binary(op=":", left=frame, right=place)) if _names(frame):
            yield from _leaves(place, ir.PoseType(), scope, (*path, _PLACE), part)
            return
    match type:
        case ir.TargetType() | ir.PoseType() | ir.JointsType():
            known = _geometry(_stands_there(value, scope))
            if known is not None:
                yield path, part, value, type, known
            return
        case ir.RealType():
            number = _stands_there(value, scope)
            if isinstance(number, float) and number != round(number):
                yield path, part, value, type, number
            return
    if not isinstance(value, ir.Aggregate):
        return
    match type:
        case ir.ArrayType(element=element, base=base):
            for at, (_, entry) in enumerate(value.entries):
                yield from _leaves(entry, scope.resolve(element), scope, (*path, at), f"{part}[{at + base}]")
        case ir.ToolType() | ir.WorkObjectType() | ir.NamedType():
            names = component_names(type, scope)
            for at, (written, entry) in enumerate(value.entries):
                name = written or (names[at] if at < len(names) else "")
                inner = _component(type, name, scope)
                if inner is not None and not isinstance(inner, ir.RealType):
                    yield from _leaves(entry, inner, scope, (*path, at), f"{part}.{name}")


def _stands_there(value: ir.Expression, scope: Scope) -> Value | None:
    """The value of an expression that names nothing: what is worked out of other data follows those."""
    if any(isinstance(node, ir.Name | ir.System | ir.Call) for node in walk(value)):
        return None
    match value:
        case ir.Builtin(function="pose_from_rotation_vector", arguments=arguments):
            numbers = [constant(one, scope) for one in arguments]
            known = [float(one) for one in numbers if isinstance(one, int | float)]
            if len(known) < len(ir.POSE):
                return None
            return rigid.Pose(rigid.Vector(*known[:3]), rotation_of_vector(*known[3:]))
    return constant(value, scope)


def _component(type: ir.Type, name: str, scope: Scope) -> ir.Type | None:
    match type:
        case ir.NamedType(name=record):
            declared = scope.type(record)
            fields = declared.fields if isinstance(declared, ir.RecordDeclaration) else ()
            return next((scope.resolve(one) for each_name, one in fields if each_name.lower() == name.lower()), None)
    return ir.COMPONENTS.get(type.__class__, {}).get(name)


def _geometry(value: Value | None) -> rigid.Pose | Joints | None:
    match value:
        case rigid.Pose():
            return value
        case Target(pose=pose):
            return pose
        case Record(type=ir.JointsType()):
            axes = value.part("robax")
            record = axes if isinstance(axes, Record) else value
            found = [record.part(name) for name in ir.AXES]
            known = [float(one) for one in found if isinstance(one, int | float)]
            return tuple(known) if known and len(known) == sum(one is not None for one in found) else None
    return None


def _is_zero(value: rigid.Pose | Joints | float) -> bool:
    return isinstance(value, rigid.Pose) and value.position.length <= _ZERO_MM and value.rotation.angle <= _ZERO_DEG


def _origin_of(leaf: ir.Expression, whole: Origin) -> Origin:
    return leaf.origin if leaf.origin.source is not None else whole


# ---- another value in its place


@dataclass(frozen=True, slots=True)
class Taught:
    """What a datum is taught: its new value, and the flags of a place's posture where they are taught with it."""

    value: rigid.Pose | Joints | float
    flags: Mapping[str, int] | None = None


def with_taught(program: ir.Program, new: Mapping[Datum, Taught]) -> ir.Program:
    """The program with other values of these data."""
    owners: dict[int, Owner] = {}
    scope = ProgramScope(program)
    module_scope = scope.module(program.modules[0]) if program.modules else None
    for datum, taught in new.items():
        owner = owners.get(id(datum.owner), datum.owner)
        assert module_scope is not None  # there is a datum
        owners[id(datum.owner)] = _with_value(owner, datum, taught, module_scope)
    modules = tuple(_in_module(module, owners) for module in program.modules)
    return replace(program, modules=modules)


def _in_module(module: ir.Module, owners: Mapping[int, Owner]) -> ir.Module:
    def statement(node: ir.Statement) -> ir.Statement:
        found = owners.get(id(node), node)
        assert not isinstance(found, ir.Variable | ir.Initialise)  # a statement's place holds one
        return rewrite_bodies(found, body)

    def body(statements: ir.Body) -> ir.Body:
        return each(statements, statement)

    def declared(some: tuple[ir.Declaration, ...]) -> tuple[ir.Declaration, ...]:
        return tuple(_declaration(owners.get(id(one), one)) for one in some)

    routines = tuple(
        replace(one, declarations=declared(one.declarations), body=body(one.body)) for one in module.routines
    )
    return replace(module, declarations=declared(module.declarations), routines=routines)


def _declaration(node: ir.Declaration | Owner) -> ir.Declaration:
    assert not isinstance(node, ir.Assign)  # a declaration's place holds one
    return node


def _with_value(owner: Owner, datum: Datum, taught: Taught, scope: Scope) -> Owner:
    match owner:
        case ir.Variable(initial=value) if value is not None:
            return replace(owner, initial=_at(value, datum.path, datum.type, taught, scope))
        case ir.Initialise(assign=assign):
            value = _at(assign.value, datum.path, datum.type, taught, scope)
            return replace(owner, assign=replace(assign, value=value))
        case ir.Assign(value=value):
            return replace(owner, value=_at(value, datum.path, datum.type, taught, scope))
    return owner


def _at(value: ir.Expression, path: tuple[int, ...], type: ir.Type, taught: Taught, scope: Scope) -> ir.Expression:
    if not path:
        return _written(value, type, taught, scope)
    if isinstance(value, ir.Binary):
        return replace(value, right=_at(value.right, path[1:], type, taught, scope))
    assert isinstance(value, ir.Aggregate)  # the path leads through entries
    entries = list(value.entries)
    name, old = entries[path[0]]
    entries[path[0]] = name, _at(old, path[1:], type, taught, scope)
    return replace(value, entries=tuple(entries))


def _written(old: ir.Expression, type: ir.Type, taught: Taught, scope: Scope) -> ir.Expression:
    match taught.value:
        case rigid.Pose() as pose:
            whole = literal(pose)
            if not isinstance(type, ir.TargetType) or not isinstance(old, ir.Aggregate):
                assert whole is not None  # every pose can be written
                return whole
            return _target(old, type, pose, taught.flags, scope)
        case tuple() as joints:
            return _joints(old, joints)
        case float() as number:
            return real(number)


def _named(old: ir.Aggregate, type: ir.Type, scope: Scope) -> list[tuple[str, ir.Expression]]:
    names = component_names(type, scope)
    return [(name or names[at], value) for at, (name, value) in enumerate(old.entries)]


def _target(
    old: ir.Aggregate, type: ir.TargetType, pose: rigid.Pose, flags: Mapping[str, int] | None, scope: Scope
) -> ir.Expression:
    """The place with another pose, its external axes as they are, and other flags where they are taught."""
    new = literal(pose)
    assert isinstance(new, ir.Aggregate)  # a pose has parts
    entries: list[tuple[str | None, ir.Expression]] = list(new.entries)
    for name, value in _named(old, type, scope):
        if name in _OF_POSE:
            continue
        if flags is not None and name == "conf" and isinstance(value, ir.Aggregate):
            told = _named(value, ir.ConfigType(type.notation), scope)
            value = replace(value, entries=tuple((each_name, _flag(each_name, one, flags)) for each_name, one in told))
        elif flags is not None:
            value = _flag(name, value, flags)
        entries.append((name, value))
    return ir.Aggregate(tuple(entries), type_name=type_word(type), origin=old.origin)


_OF_POSE = frozenset((*ir.POSE, "trans", "rot", "q1", "q2", "q3", "q4"))


def _flag(name: str, old: ir.Expression, flags: Mapping[str, int]) -> ir.Expression:
    return ir.IntLiteral(flags[name]) if name in flags else old


def _joints(old: ir.Expression, joints: Joints) -> ir.Expression:
    """The joints in the shape of the old ones, their external axes as they are."""
    axes = tuple((name, real(value)) for name, value in zip(ir.AXES, joints, strict=False))
    if not isinstance(old, ir.Aggregate):
        return ir.Aggregate(axes, type_name=type_word(ir.JointsType()))
    first = old.entries[0]
    if isinstance(first[1], ir.Aggregate):  # the arm's axes stand in a part of their own
        inner = replace(first[1], entries=axes)
        return replace(old, entries=((first[0], inner), *old.entries[1:]))
    rest = tuple(entry for at, entry in enumerate(old.entries) if (entry[0] or f"j{at + 1}") not in dict(axes))
    return replace(old, entries=(*axes, *rest))


__all__ = ["FRAME", "KINDS", "NUMBER", "POINT", "TOOL", "Datum", "Joints", "Taught", "taught_data", "with_taught"]
