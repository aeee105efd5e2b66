"""Changing points in the text of a program: only the numbers of that point are written anew, all other bytes stay.

The numbers of a literal are found by their values and order, and the changed text is read back: what does not come out
as it was meant is not given away. So nothing here knows how a language writes a point.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product

from rpl import ir
from rpl.comparing.projects import differences
from rpl.comparing.values import known
from rpl.diagnostics import Diagnostics
from rpl.errors import SourceError, UsageError
from rpl.ir.walk import statements
from rpl.passes import rigid
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typewords import component_names, word_type
from rpl.passes.values import Record, Target, Value, component
from rpl.project import ReadProgram, read_sources
from rpl.source import Origin, Source

# A number as controllers write it, no part of a name.
_NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
_QUATERNION, _VECTOR = ("q1", "q2", "q3", "q4"), ("rx", "ry", "rz")
_MOST_DECIMALS = 6  # that a changed number gets beyond those that its literal has
_MOST_TRIES = 64

Components = Mapping[str, float]


@dataclass(frozen=True, slots=True)
class _Place:
    """A point in the text: what it is called, the literal, what its names mean, and where it stands."""

    name: str
    literal: ir.Expression
    scope: Scope
    origin: Origin


@dataclass(frozen=True, slots=True)
class _Leaf:
    """A number of a literal: the component that it says, its value, and how many base units one of it is."""

    component: str
    value: float
    factor: float


@dataclass(frozen=True, slots=True)
class _Edit:
    start: int
    end: int
    text: str


def with_points(read: ReadProgram, points: Mapping[str, Components]) -> tuple[Source, ...]:
    """The sources of a project with other values of points; those without one are the same objects.

    points: by name, behind the name of its module or routine and a dot where several have the name (`LINE.P1`); the
    components that change: x, y, z in mm, a, b, c in degrees (also where the language writes a quaternion or a rotation
    vector), j1 ... in degrees, e1 ... Raises UsageError for a name that is not there or that several have, SourceError
    where a point is not written as numbers that say these components.
    """
    if not points:
        return read.sources
    if len(read.dialects) != 1:
        raise UsageError("points are changed in a project of one language")
    places = _places(read)
    wanted = [
        (_found(places, name), {key.lower(): value for key, value in components.items()})
        for name, components in points.items()
    ]
    sources = {id(one): one for one in read.sources}
    first = [(place, next(_tries(place, components), []), components) for place, components in wanted]
    if not _take(read, sources, first):
        chosen = [(place, _one_by_one(read, place, components), components) for place, components in wanted]
        if not _take(read, sources, chosen):
            raise SourceError("these points are not written as numbers of their own")
    return tuple(sources.values())


def with_new_point(read: ReadProgram, name: str, components: Components) -> tuple[Source, ...]:
    """The sources of a project with one more point, in a line of its own below that of another point, which it is
    written like.

    Raises UsageError where the name is none or is taken, SourceError where no point of the project is written in one
    line with numbers that say these components.
    """
    if re.fullmatch(r"[A-Za-z]\w{0,30}", name) is None:
        raise UsageError(f"{name!r} is no name for a point: a letter, then letters, digits and underscores")
    places = _places(read)
    if name.lower() in places:
        raise UsageError(f"there is a point {name} already")
    for other in {id(some[-1]): some[-1] for some in places.values()}.values():
        origin = other.origin
        source = origin.source
        if source is None or "\n" in origin.text or not components.keys() <= _said(other):
            continue
        starts = source.line_starts()
        begin = starts[origin.line - 1]
        end = starts[origin.line] if origin.line < len(starts) else len(source.text)
        line = source.text[begin:end]
        copied, count = re.subn(rf"(?i)(?<!\w){re.escape(other.name)}(?!\w)", name, line)
        if count != 1 or not line.endswith(("\n", "\r")):
            continue
        new = edited(source, [_Edit(end, end, copied)])
        diagnostics = Diagnostics()
        again = read_sources([new if one is source else one for one in read.sources], read.dialects[0], diagnostics)
        if not diagnostics.has_errors and name.lower() in _places(again):
            return with_points(again, {name: components})
    raise SourceError(f"no point is written in one line that {name} could be written like")


def _said(place: _Place) -> set[str]:
    """The components that a literal says as numbers; angles also as a quaternion or a rotation vector."""
    found = {leaf.component for leaf in _leaves(place.literal, place.scope)}
    return found | set(ir.ANGLES) if found >= set(_QUATERNION) or found >= set(_VECTOR) else found


def _one_by_one(read: ReadProgram, place: _Place, components: Components) -> list[_Edit]:
    """The edits of a point alone, tried one after the other. Raises SourceError where none does what is meant."""
    for edits in _tries(place, components):
        if _take(read, {id(one): one for one in read.sources}, [(place, edits, components)]):
            return edits
    names = ", ".join(components)
    raise SourceError(f"{place.origin.place}{place.name} does not say {names} as numbers of its own")


def _places(read: ReadProgram) -> dict[str, list[_Place]]:
    """All places that have a name and a literal in the text, by that name and by the name behind that of its module and
    routine; in small letters."""
    found: dict[str, list[_Place]] = {}
    scopes = ProgramScope(read.reduced)
    for module in read.reduced.modules:
        for routine in (None, *module.routines):
            scope = scopes.module(module) if routine is None else scopes.routine(module, routine)
            for name, literal, origin in _literals(module if routine is None else routine):
                if origin.source is not None and origin.end > origin.start:
                    place = _Place(name, literal, scope, origin)
                    home = module.name if routine is None else routine.name
                    for key in (name, f"{home}.{name}"):
                        found.setdefault(key.lower(), []).append(place)
    return found


def _literals(home: ir.Module | ir.Routine) -> Iterator[tuple[str, ir.Expression, Origin]]:
    for one in home.declarations:
        match one:
            case ir.Variable(initial=literal) if literal is not None:
                yield one.name, literal, one.origin
            case ir.Initialise(assign=ir.Assign(target=ir.Name(id=name), value=literal)):
                yield name, literal, one.origin
    if isinstance(home, ir.Routine):
        for node in statements(home.body):
            if isinstance(node, ir.Assign) and isinstance(node.target, ir.Name):
                yield node.target.id, node.value, node.origin


def _found(places: Mapping[str, Sequence[_Place]], name: str) -> _Place:
    some = places.get(name.lower(), [])
    if not some:
        raise UsageError(f"there is no point {name} with a value in the text")
    if len(some) > 1:
        where = ", ".join(f"{one.origin.file}:{one.origin.line}" for one in some[:4])
        raise UsageError(f"there are several of the name {name} ({where}): say which by MODULE.NAME")
    return some[0]


# ---- the numbers of a literal


def _leaves(expression: ir.Expression, scope: Scope, name: str = "") -> Iterator[_Leaf]:
    """The numbers of a literal in the order in which they stand."""
    match expression:
        case ir.Aggregate(entries=entries, type_name=word):
            type = word_type(word, scope) if word else None
            names = component_names(type, scope) if type is not None else ()
            for at, (written, value) in enumerate(entries):
                yield from _leaves(value, scope, written or (names[at] if at < len(names) else ""))
        case ir.Builtin(function="pose_from_rotation_vector", arguments=arguments):
            for part, value in zip(("x", "y", "z", *_VECTOR), arguments, strict=True):
                yield from _leaves(value, scope, part)
        case _:
            number = known(expression, scope)
            if isinstance(number, int | float) and not isinstance(number, bool):
                factor = ir.UNITS[expression.unit] if isinstance(expression, ir.Quantity) else 1.0
                yield _Leaf(name.lower(), float(number), factor)


def _wanted(place: _Place, leaves: Sequence[_Leaf], components: Components) -> dict[int, float]:
    """Which leaves get which value (in base units). Raises SourceError where the literal has none for a component."""
    at: dict[str, int] = {}
    for number, leaf in enumerate(leaves):
        at.setdefault(leaf.component, number)  # a tool has its frame before its centre of gravity
    direct = {at[name]: value for name, value in components.items() if name in at}
    turned = {name: value for name, value in components.items() if name not in at}
    if not turned:
        return direct
    value = known(place.literal, place.scope)
    parts = _QUATERNION if set(_QUATERNION) <= at.keys() else _VECTOR
    if not turned.keys() <= set(ir.ANGLES) or not set(parts) <= at.keys() or value is None:
        missing = ", ".join(turned)
        raise SourceError(f"{place.origin.place}{place.name} is not written with {missing}")
    angles = [turned.get(name, _number(component(value, name))) for name in ir.ANGLES]
    rotation = rigid.rotation_of_zyx(*angles)
    before = [leaves[at[name]].value for name in parts]
    numbers = _quaternion(rotation, before) if parts is _QUATERNION else _vector(rotation)
    return direct | {at[name]: number for name, number in zip(parts, numbers, strict=True)}


def _number(value: Value | None) -> float:
    return float(value) if isinstance(value, int | float) else 0.0


def _quaternion(rotation: rigid.Rotation, before: Sequence[float]) -> tuple[float, ...]:
    """Of both quaternions of a rotation that which is nearer to the one before."""
    parts = rotation.quaternion
    return parts if sum(a * b for a, b in zip(parts, before, strict=True)) >= 0 else tuple(-part for part in parts)


def _vector(rotation: rigid.Rotation) -> tuple[float, ...]:
    """The rotation vector in degrees."""
    w, x, y, z = rotation.quaternion
    size = math.hypot(x, y, z)
    angle = math.degrees(2 * math.atan2(size, w))
    return tuple(part / size * angle if size > 0 else 0.0 for part in (x, y, z))


# ---- the numbers of the text


def _tries(place: _Place, components: Components) -> Iterator[list[_Edit]]:
    """Edits of the text that may be meant, the likeliest first."""
    leaves = list(_leaves(place.literal, place.scope))
    wanted = _wanted(place, leaves, components)
    source, start = place.origin.source, place.origin.start
    assert source is not None  # as _places gives them
    tokens = [(start + one.start(), one[0]) for one in _NUMBER.finditer(place.origin.text)]
    numbers = [float(text) for _, text in tokens]
    guess = _aligned(leaves, numbers)
    options = []
    for leaf in wanted:
        fits = [at for at, number in enumerate(numbers) if _is(leaves[leaf], number)]
        options.append(sorted(fits, key=lambda at: (at != guess.get(leaf), -at)))
    for chosen in islice(product(*options), _MOST_TRIES):
        if len(set(chosen)) == len(chosen):
            yield [
                _edit(source.text, *tokens[at], value / leaves[leaf].factor)
                for at, (leaf, value) in zip(chosen, wanted.items(), strict=True)
            ]


def _is(leaf: _Leaf, number: float) -> bool:
    return math.isclose(number * leaf.factor, leaf.value, rel_tol=1e-9, abs_tol=1e-9)


def _aligned(leaves: Sequence[_Leaf], numbers: Sequence[float]) -> dict[int, int]:
    """Which number of the text each leaf is: as many as possible in one order, the last ones first."""
    most = [[0] * (len(numbers) + 1) for _ in range(len(leaves) + 1)]
    for i, leaf in enumerate(leaves):
        for j, number in enumerate(numbers):
            same = most[i][j] + 1 if _is(leaf, number) else 0
            most[i + 1][j + 1] = max(most[i][j + 1], most[i + 1][j], same)
    found = {}
    i, j = len(leaves), len(numbers)
    while i and j:
        if _is(leaves[i - 1], numbers[j - 1]) and most[i][j] == most[i - 1][j - 1] + 1:
            i, j = i - 1, j - 1
            found[i] = j
        elif most[i][j] == most[i][j - 1]:
            j -= 1
        else:
            i -= 1
    return found


def _edit(text: str, start: int, old: str, value: float) -> _Edit:
    """The number written with as many decimals as the old one, or more where it needs them; blanks in front of it give
    way, so that columns stay."""
    decimals = len(old.partition(".")[2]) if "e" not in old.lower() else 0
    new = f"{value:.{decimals}f}"
    while float(new) != value and decimals < _MOST_DECIMALS:
        decimals += 1
        new = f"{value:.{decimals}f}"
    if float(new) == 0.0:
        new = new.removeprefix("-")
    while old.startswith(("-.", ".")) and new.lstrip("-").startswith("0."):
        new = new.replace("0.", ".", 1)
    end = start + len(old)
    blanks = start - len(text[:start].rstrip(" ")) if text[start - 1 : start] == " " else 0
    room = max(0, min(len(new) - len(old), blanks - 1)) if blanks > 1 else 0
    more = " " * (len(old) - len(new)) if blanks > 1 else ""
    return _Edit(start - room, end, more + new)


def edited(source: Source, edits: Sequence[_Edit]) -> Source:
    """The source with other text at some places; everything else keeps its bytes."""
    parts, at = [], 0
    for edit in sorted(edits, key=lambda one: one.start):
        parts += [source.text[at : edit.start], edit.text]
        at = edit.end
    text = "".join([*parts, source.text[at:]])
    return Source(source.path, text.encode(source.encoding), text, source.encoding)


# ---- is it what was meant?


def _take(
    read: ReadProgram, sources: dict[int, Source], places: Sequence[tuple[_Place, list[_Edit], Components]]
) -> bool:
    """Put the edits into the sources, where reading them back gives these points these values and changes nothing
    else."""
    edits: dict[int, list[_Edit]] = {}
    for place, some, _ in places:
        edits.setdefault(id(place.origin.source), []).extend(some)
    new = {key: edited(source, edits[key]) if key in edits else source for key, source in sources.items()}
    again = read_sources(list(new.values()), read.dialects[0], Diagnostics())
    told = {change.name.lower() for change in differences(read, again).changes}
    if not told <= {place.name.lower() for place, *_ in places}:
        return False
    found = _places(again)
    for place, _, components in places:
        homes = [one for one in found.get(place.name.lower(), []) if one.origin.line == place.origin.line]
        now = [one for one in homes if one.origin.file == place.origin.file]
        if len(now) != 1 or not _has(known(now[0].literal, now[0].scope), components):
            return False
    sources.update(new)
    return True


def _has(value: Value | None, components: Components) -> bool:
    """Has the value these components, as closely as six decimals say them?"""
    if value is None:
        return False
    turned = {name: number for name, number in components.items() if name in ir.ANGLES}
    if turned and isinstance(value, rigid.Pose | Target):
        pose = value.pose if isinstance(value, Target) else value
        angles = [turned.get(name, _number(component(value, name))) for name in ir.ANGLES]
        if pose.rotation.inverse.then(rigid.rotation_of_zyx(*angles)).angle > 1e-3:
            return False
    rest = {name: number for name, number in components.items() if name not in turned}
    return all(abs(_part(value, name) - number) <= 1e-3 for name, number in rest.items())


def _part(value: Value, name: str) -> float:
    """A component by its name, also one of a part (RAPID robax and extax)."""
    found = component(value, name)
    if found is None and isinstance(value, Record):
        found = next((one for _, part in value.parts if (one := component(part, name)) is not None), None)
    return _number(found) if found is not None else math.nan
