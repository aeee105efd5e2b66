"""Moves to taught points as inline forms, which the pendant opens and touches up, in programs where that is natural.

At least half of the moves of a program must go to taught points with constant settings, and three times as many as go
to places that the run works out: then all of those are forms, and the rest stays as it is. A form sets what is in force
where it stands; settings that stood in front of it for its sake alone are left out. Counted in public programs: half of
all moves are forms, nine of ten go to points X....
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.entries import background, moving_entries
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, visit_bodies
from rpl.passes.scope import ProgramScope, Scope, rules_of
from rpl.source import Comment, Origin
from rpl.writing.names import renamed_as

from .. import tables
from ..forms.data import (
    HOME_DATA,
    Numbering,
    fits_home,
    frame_data,
    initialising,
    is_home,
    motion_data,
    parts_of,
    point_name,
    touchable,
)
from ..forms.moves import INITMOV, Form, form_of, is_plain, number_of
from ..forms.wanted import SETTINGS, Wanted, is_wanted

ACCELERATIONS = code(
    "krl-form-accelerations",
    Severity.INFO,
    "moves of inline forms accelerate as the basis package's defaults say (DEF_ACC_PTP, DEF_ACC_CP)",
    "where a time matters, change ACC in the form's data",
)

# Settings that a form sets and whose values are not followed here.
_NOT_FOLLOWED = frozenset(
    ("interpolation", "swivel_acceleration", "twist_acceleration", "base_unit", "base_root", "external_speed")
)
_OF_AXES = ("joint_speed", "joint_acceleration")
_AXES = tuple((ir.IntLiteral(number),) for number in range(1, 7))
_ARC = "circle_orientation"


# Programs that work out where they go (pallets) are written in expert lines: so many forms there must be for each such
# move that they are written all the same.
FORMS_PER_COMPUTED = 3


@dataclass(frozen=True, slots=True)
class Candidate:
    """A move that may be a form, its point as declared, and what is in force there."""

    move: ir.Move
    point: ir.Variable
    form: Form
    state: Mapping[str, ir.Expression | None]

    @property
    def frames(self) -> tuple[int, int]:
        return self.form.tool, self.form.base


@legalising(sees=("Move",))
def inline_forms(program: ir.Program, context: Context) -> ir.Program:
    """Moves to taught points with constant settings are inline forms, where at least half of a program's moves can be:
    with FDAT, PDAT and LDAT in the data list, and an INI fold where the program begins. The option `moves` asks for
    them wherever there can be one, or for none."""
    style = context.options.get("moves", "")
    if style == "lines":
        return program
    wherever = style == "forms"
    foreground = _foreground(program)
    moves = [node for node in walk_for({"Move"}, *foreground) if isinstance(node, ir.Move)]
    if not _enough(sum(map(is_plain, moves)), moves, wherever) or not _followed(program):
        return program
    arcs = any(move.kind == "circular" for move in moves)
    start: dict[str, ir.Expression] = {name: ir.RealLiteral(value) for name, value in INITMOV.items()}
    start[_ARC] = ir.EnumLiteral("path" if arcs else "base")
    flow = SettingsInForce.of(_without_values(program), dict(rules_of("krl").system_defaults), start)
    if any(_rests_on_start(move, flow.at(move), start) for move in moves):
        return program
    found = _of_one_frame(_candidates(program, foreground, flow))
    assigned = usage_of(_without_values(program)).assigned
    computed = sum(not flow.never_comes_to(move) and _by_run(move, flow.at(move), assigned) for move in moves)
    while _enough(len(found), moves, wherever) and (wherever or len(found) >= FORMS_PER_COMPUTED * computed):
        wanted = Wanted.of(program, {key: one.form for key, one in found.items()})
        kept = {key: one for key, one in found.items() if not _disturbs(one, wanted)}
        if len(kept) == len(found):
            return _written(program, context, found, wanted, arcs)
        found = kept
    return program


def _enough(count: int, moves: list[ir.Move], wherever: bool) -> bool:
    return count > 0 and (wherever or 2 * count >= len(moves))


def _by_run(move: ir.Move, state: Mapping[str, ir.Expression | None], assigned: set[str]) -> bool:
    """Does the run decide where the move goes: is its place or its frame one that the program works out?"""
    names = {node.id.lower() for node in walk(move.target) if isinstance(node, ir.Name)}
    return bool(names & assigned) or state.get("base") is None


def _foreground(program: ir.Program) -> list[ir.Module]:
    beside = background(program)
    return [module for module in program.modules if module.name not in beside]


def _followed(program: ir.Program) -> bool:
    """Are all settings that a form sets followed here, and those of the axes set for all six alike?"""
    for module in program.modules:
        for routine in module.routines:
            for body in bodies(routine):
                for inner in _bodies_in(body):
                    if not _all_alike(inner):
                        return False
    return True


def _bodies_in(body: ir.Body) -> Iterator[ir.Body]:
    yield body
    for statement in body:
        found: list[ir.Body] = []

        def inside(inner: ir.Body, found: list[ir.Body] = found) -> ir.Body:
            found.append(inner)
            return inner

        visit_bodies(statement, inside)
        for inner in found:
            yield from _bodies_in(inner)


def _all_alike(body: ir.Body) -> bool:
    at = 0
    while at < len(body):
        match body[at]:
            case ir.Assign(target=ir.System(name=name)) if name in _NOT_FOLLOWED:
                return False
            case ir.Assign(target=ir.System(name=name), value=value) if name in _OF_AXES:
                group = [(one.target, one.value) for one in body[at : at + 6] if isinstance(one, ir.Assign)]
                if group != [(ir.System(name, axis), value) for axis in _AXES]:
                    return False
                at += 5
        at += 1
    return True


def _without_values(program: ir.Program) -> ir.Program:
    """The program without the values of the controller's tables, which are no assignments of the program: an element
    stays the same tool all the while."""
    modules = (
        replace(one, declarations=tuple(each for each in one.declarations if not isinstance(each, ir.Initialise)))
        if one.name.lower() == tables.CONFIG
        else one
        for one in program.modules
    )
    return replace(program, modules=tuple(modules))


def _rests_on_start(
    move: ir.Move, state: Mapping[str, ir.Expression | None], start: Mapping[str, ir.Expression]
) -> bool:
    """Does the move take a speed or the size of its corner as the program before has left it? An INI fold would give
    it another."""
    used = ["path_speed"] if move.kind != "joint" else []
    match move.blend:
        case ir.BlendDistance():
            used.append("blend_distance")
        case ir.BlendPercent():
            used.append("blend_joint")
        case ir.BlendSpeed():
            used.append("blend_speed")
    return any(state.get(name) is start[name] for name in used)


# ---- which moves are forms


def _candidates(program: ir.Program, foreground: list[ir.Module], flow: SettingsInForce) -> Iterator[Candidate]:
    scopes, assigned = ProgramScope(program), usage_of(_without_values(program)).assigned
    lists = {id(one) for module in program.modules for one in module.declarations if isinstance(one, ir.Variable)}
    for module in foreground:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for body in bodies(routine):
                for move in _alone(body):
                    point = _point(move.target, scope, assigned)
                    if point is None or id(point) not in lists or flow.never_comes_to(move):
                        continue
                    state = flow.at(move)
                    form = form_of(move, state)
                    if form is not None:
                        yield Candidate(move, point, form, state)


def _alone(body: ir.Body) -> Iterator[ir.Move]:
    """Plain moves without a trigger in front of them and outside of spline blocks."""
    for inner in _bodies_in(body):
        before: ir.Statement | None = None
        for statement in inner:
            if isinstance(statement, ir.Move) and is_plain(statement) and not isinstance(before, ir.Trigger):
                yield statement
            before = statement


def _point(target: ir.Expression, scope: Scope, assigned: set[str]) -> ir.Variable | None:
    """The declaration of a taught point that the program never sets."""
    symbol = scope.value(target.id) if isinstance(target, ir.Name) else None
    if symbol is None or symbol.routine is not None or not isinstance(symbol.declaration, ir.Variable):
        return None
    point = symbol.declaration
    taught = isinstance(point.type, ir.TargetType | ir.JointsType) and isinstance(point.initial, ir.Aggregate)
    return point if taught and point.name.lower() not in assigned else None


def _of_one_frame(candidates: Iterator[Candidate]) -> dict[int, Candidate]:
    """A point has one FDAT: the moves to it with the tool and base that most of them have."""
    found = list(candidates)
    uses: dict[int, Counter[tuple[int, int]]] = {}
    for one in found:
        uses.setdefault(id(one.point), Counter())[one.frames] += 1
    own = {key: max(counted, key=lambda frames: counted[frames]) for key, counted in uses.items()}
    own |= {id(one.point): (0, 0) for one in found if is_home(one.point)}
    return {id(one.move): one for one in found if own[id(one.point)] == one.frames}


def _disturbs(one: Candidate, wanted: Wanted) -> bool:
    """Would its form set the size of corners that others are driven with, and that is not known there?"""
    idle = one.form.size is None and number_of(one.state.get(one.form.corner)) is None
    return idle and is_wanted(wanted.behind, one.move, {one.form.corner})


# ---- the program with forms


def _written(
    program: ir.Program, context: Context, found: Mapping[int, Candidate], wanted: Wanted, arcs: bool
) -> ir.Program:
    names = _names(found, context)
    found = {key: one for key, one in found.items() if id(one.point) in names}
    frames = {id(one.point): one.frames for one in found.values()}
    shared = _shared(program, {one.point.name.lower() for one in found.values()})
    taken, entries = set(context.taken), moving_entries(program)
    modules = []
    for module in program.modules:
        work = _Forms(found, names, wanted, Numbering(taken), _only_usual_advance(program))
        routines = []
        for routine in module.routines:
            done = edit_bodies(routine, work.body)
            begins = routine.name.lower() in entries and any(True for _ in done.body)
            routines.append(_begun(done, wanted, routine, arcs) if begins else done)
        declared: list[ir.Declaration] = []
        for one in module.declarations:
            if isinstance(one, ir.Variable) and id(one) in frames:
                point = touchable(replace(one, name=names[id(one)]), one.name.lower() not in shared)
                declared.append(replace(point, name=one.name))
                declared += [] if is_home(one) else [frame_data(point, *frames[id(one)])]
            else:
                declared.append(one)
        context.taken.update(each.name.lower() for each in work.data)
        modules.append(replace(module, declarations=(*declared, *work.data), routines=tuple(routines)))
    whole = replace(program, modules=tuple(modules))
    other = {one.point.name: names[id(one.point)] for one in found.values() if one.point.name != names[id(one.point)]}
    context.renamed.update(other)
    first = next(iter(found.values()))
    context.diagnostics.report(ACCELERATIONS, first.move.origin)
    return renamed_as(whole, other)


def _names(found: Mapping[int, Candidate], context: Context) -> dict[int, str]:
    """The form name of each point (by identity); points of one name in several modules have one."""
    names: dict[int, str] = {}
    chosen: dict[str, str | None] = {}
    for one in found.values():
        key = one.point.name.lower()
        if key not in chosen:
            chosen[key] = name = point_name(one.point.name, context.taken)
            context.taken.update(() if name is None else (name.lower(), f"f{name[1:]}".lower()))
        name = chosen[key]
        if name is not None:
            names[id(one.point)] = name
    return names


def _shared(program: ir.Program, points: set[str]) -> set[str]:
    """Points (folded) that modules other than the one that declares them mention."""
    homes = {
        (one.name.lower(), id(module))
        for module in program.modules
        for one in module.declarations
        if isinstance(one, ir.Variable) and one.name.lower() in points
    }
    found: set[str] = set()
    for module in program.modules:
        for node in walk_for({"Name"}, module):
            if isinstance(node, ir.Name) and node.id.lower() in points and (node.id.lower(), id(module)) not in homes:
                found.add(node.id.lower())
    return found


def _only_usual_advance(program: ir.Program) -> bool:
    """Does the program set the look-ahead only as INITMOV does?"""
    values = [
        number_of(node.value)
        for node in walk_for({"Assign"}, *program.modules)
        if isinstance(node, ir.Assign) and node.target == ir.System("advance")
    ]
    return all(value == INITMOV["advance"] for value in values)


class _Forms:
    """The bodies of one module with forms; `data`: what these have in the data list."""

    def __init__(
        self,
        found: Mapping[int, Candidate],
        names: Mapping[int, str],
        wanted: Wanted,
        numbering: Numbering,
        usual_advance: bool,
    ) -> None:
        self.found, self.names, self.wanted, self.numbering = found, names, wanted, numbering
        self.usual_advance = usual_advance
        self.data: list[ir.Variable] = []

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        left: tuple[Comment, ...] = ()  # remarks of settings that are gone
        for statement in body:
            if self.is_idle(statement):
                left += statement.origin.comments
                continue
            first, *more = self.statement(statement)
            if left:
                first = _remarked(first, left)
                left = ()
            done += [first, *more]
        return tuple(done) if not left else (*done, ir.Nothing(origin=Origin(comments=left)))

    def statement(self, statement: ir.Statement) -> ir.Body:
        one = self.found.get(id(statement))
        if one is None:
            return (rewrite_bodies(statement, self.body),)
        size, point = one.form.size, self.names[id(one.point)]
        if size is None and is_wanted(self.wanted.behind, one.move, {one.form.corner}):
            size = number_of(one.state.get(one.form.corner))
        if is_home(one.point) and fits_home(one.form, size):
            return parts_of(one.move, one.form, HOME_DATA, point)
        data = self.numbering.next(one.form)
        self.data.append(motion_data(data, one.form, size))
        return parts_of(one.move, one.form, data, point)

    def is_idle(self, statement: ir.Statement) -> bool:
        """Is it a setting that nothing asks for: forms set it themselves, or INITMOV has set it?"""
        match statement:
            case ir.Assign(target=ir.System(name="advance")):
                return self.usual_advance
            case ir.Assign(target=ir.System(name=name), value=value) if name in SETTINGS:
                harmless = not any(isinstance(one, ir.Call | ir.Builtin) for one in walk(value))
                return harmless and not is_wanted(self.wanted.behind, statement, {name})
        return False


def _remarked(statement: ir.Statement, remarks: tuple[Comment, ...]) -> ir.Statement:
    origin = statement.origin
    return replace(statement, origin=replace(origin, comments=(*remarks, *origin.comments)))


def _begun(done: ir.Routine, wanted: Wanted, routine: ir.Routine, arcs: bool) -> ir.Routine:
    """The routine behind an INI fold."""
    turning = arcs and _ARC in wanted.asks[routine.name.lower()]
    arc = (ir.Assign(ir.System(_ARC), ir.EnumLiteral("path")),) if turning else ()
    return replace(done, body=(initialising(), *arc, *done.body))


__all__ = ["inline_forms"]
