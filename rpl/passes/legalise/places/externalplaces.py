"""Places that leave out external axes which the program moves elsewhere, for targets whose places name them all.

What is left out stays where the last move put it. Where that is known (written or constant data), it is written into
the place; where it is not, the loss has a name and the program stops in front of the move: an axis that nobody wrote
would come out at zero, or be refused by the controller.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir, registry
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import PlaceRule
from rpl.passes.fold import constant, constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.externalaxes import AXES, is_nothing
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import Target, real

LOST = code(
    "external-axis-left-out",
    Severity.LOSS,
    "the move leaves {axes} where the last one put it, and the target's places must say where that is",
    "the program stops there; write the value into the place",
)
_NAMES = AXES
_NONE = 9e8  # an axis that is not there stands at 9E9
_BLOCKS = (ir.While, ir.For, ir.Loop, ir.Repeat)
_TYPES = ("target", "pose", "joints")

Known = dict[str, float]


@legalising(unless=lambda context: PlaceRule.PARTIAL in context.capabilities.places.rules)
def external_places(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without partial places, and programs that move external axes."""
    used = _used(program)
    if not used:
        return program
    return _Places(program, context, used).program()


def _used(program: ir.Program) -> tuple[str, ...]:
    """Axes that some place or component of the program sends away from zero; those of no other place do not count,
    nor those of the parameters in a language's prelude, which are limits and not places."""
    found: set[str] = set()
    for node in walk_for({"Field", "Aggregate"}, *(module for module in program.modules if not _is_prelude(module))):
        match node:
            case ir.Field(name=name):
                found |= {name} & set(_NAMES)
            case ir.Aggregate(entries=entries):
                found |= {name for name, value in entries if name in _NAMES and not is_nothing(value)}
    return tuple(name for name in _NAMES if name in found)


def _is_prelude(module: ir.Module) -> bool:
    """Is the module the used part of its language's prelude?"""
    prelude = registry.dialect(module.dialect).prelude()
    if prelude is None or not module.declarations:
        return False
    sources = [declaration.origin.source for declaration in prelude.declarations]
    return all(any(one.origin.source is source for source in sources) for one in module.declarations)


class _Places:
    def __init__(self, program: ir.Program, context: Context, used: tuple[str, ...]) -> None:
        self.source, self.context, self.used = program, context, used
        self.unchanged, self.moving = unchanged_in(program), _moving_routines(program)
        self.scopes = ProgramScope(program)
        self.scope: Scope | None = None

    def program(self) -> ir.Program:
        modules = []
        for module in self.source.modules:
            routines = []
            for routine in module.routines:
                self.scope = self.scopes.routine(module, routine)
                routines.append(edit_bodies(routine, lambda body: self.body(body, {})))
            modules.append(replace(module, routines=tuple(routines)))
        return replace(self.source, modules=tuple(modules))

    def body(self, body: ir.Body, known: Known) -> ir.Body:
        """The body; `known` becomes what is known behind it."""
        return tuple(one for statement in body for one in self.statement(statement, known))

    def statement(self, statement: ir.Statement, known: Known) -> list[ir.Statement]:
        if isinstance(statement, ir.Move):
            return self.move(statement, known)
        if isinstance(statement, ir.Spline):
            return self.spline(statement, known)
        stays = not self.may_move(statement)
        if isinstance(statement, _BLOCKS):
            new = self.body(statement.body, dict(known) if stays else {})
            statement = rewrite_parts(statement, lambda value: value, None, {"body": new})
        else:
            statement = rewrite_bodies(statement, lambda body: self.body(body, dict(known)))
        if not stays:
            known.clear()
        return [statement]

    def spline(self, spline: ir.Spline, known: Known) -> list[ir.Statement]:
        """A block is one path: what would stop in front of one of its moves stops in front of the block."""
        halts: list[ir.Statement] = []
        body: list[ir.Statement] = []
        for item in spline.body:
            for one in self.statement(item, known):
                (halts if isinstance(one, ir.Halt) else body).append(one)
        return [*halts[:1], rewrite_parts(spline, lambda value: value, None, {"body": tuple(body)})]

    def move(self, move: ir.Move, known: Known) -> list[ir.Statement]:
        missing = self.missing(move.target)
        if move.relative is not None or move.search is not None:
            missing = ()
        lost = [name for name in missing if name not in known]
        given = move if lost or not missing else replace(move, target=self.filled(move.target, missing, known))
        behind = {} if move.search is not None else self.behind(given, known)
        known.clear()
        known.update(behind)
        if not lost:
            return [given]
        axes = " and ".join(f"external axis {name[1:]}" for name in lost)
        self.context.diagnostics.report(LOST, move.origin, axes=axes)
        return [ir.Halt(origin=replace(move.origin, comments=())), move]

    def missing(self, place: ir.Expression | None) -> tuple[str, ...]:
        """Axes in use that a place of known components leaves out."""
        if isinstance(place, ir.Aggregate):
            named = {name for name, _ in place.entries}
            if None in named or "ext" in named or not (place.type_name or "").startswith(_TYPES):
                return ()
            return tuple(name for name in self.used if name not in named)
        value = self.value(place)
        if not isinstance(value, Target) or not isinstance(place, ir.Name):
            return ()
        named = {name for name, _ in value.external}
        return tuple(name for name in self.used if name not in named)

    def value(self, place: ir.Expression | None) -> object:
        return None if place is None or self.scope is None else constant(place, self.scope, self.unchanged)

    def filled(self, place: ir.Expression, missing: tuple[str, ...], known: Known) -> ir.Expression:
        rest = tuple((name, real(known[name])) for name in missing)
        if isinstance(place, ir.Aggregate):
            return replace(place, entries=(*place.entries, *rest))
        return ir.Builtin("with_external", (place, ir.Aggregate(rest, "external")), origin=place.origin)

    def behind(self, move: ir.Move, known: Known) -> Known:
        """Where the external axes stand behind a move, as far as that is known."""
        place = move.target
        if isinstance(place, ir.Aggregate) and self.scope is not None:
            if "ext" in {name for name, _ in place.entries} or move.relative is not None:
                return {} if any(name in _NAMES or name == "ext" for name, _ in place.entries) else dict(known)
            found = dict(known)
            for name, value in place.entries:
                if name not in _NAMES:
                    continue
                number = constant_number(value, self.scope, self.unchanged)
                if number is None:
                    found.pop(name, None)
                elif abs(number) < _NONE:
                    found[name] = number
            return found
        taught = self.value(place)
        if isinstance(taught, Target):
            return {**known, **{name: number for name, number in taught.external if abs(number) < _NONE}}
        return {}

    def may_move(self, statement: ir.Statement) -> bool:
        """May external axes be elsewhere behind it?"""
        return any(_moves(node, self.moving) for node in walk(statement))


def _moves(node: object, moving: set[str]) -> bool:
    match node:
        case ir.Move() | ir.Spline() | ir.MoveExternal() | ir.Label():
            return True
        case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
            return True
        case ir.CallRoutine(name=name) | ir.Call(name=name):
            return name.lower() in moving
    return False


def _moving_routines(program: ir.Program) -> set[str]:
    """Routines that move the robot, folded, with those that call them."""
    found: set[str] = set()
    size = -1
    while size != (size := len(found)):
        for module in program.modules:
            for routine in module.routines:
                if any(_moves(node, found) and not isinstance(node, ir.Label) for node in walk(routine)):
                    found.add(routine.name.lower())
    return found


__all__ = ["external_places"]
