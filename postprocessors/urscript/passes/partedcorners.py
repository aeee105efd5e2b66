"""Corners that keep clear of each other, for controllers that leave out a move whose corner touches the next one
(Universal Robots).

Each corner gets at most half of the way to the move before and to the one behind, on every way that the program can
go. Other controllers make their corners so by themselves, whence nothing is lost; what is written smaller is told.
Where a way is known only in the run, the radius is computed there: of two corners between which the way is not known
before, the later one takes what the first has left. Where not even that can be said, the robot stops.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.controllerfiles import controller_named
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.cornersizes import written_size
from rpl.passes.legalise.facts.motion.moveorder import Pair, pairs_of
from rpl.passes.legalise.facts.motion.placeboxes import Boxes
from rpl.passes.legalise.facts.motion.ways import Ways, between
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.library import Library, common_library
from rpl.passes.legalise.stages import legalising

SMALLER = code(
    "corner-made-smaller",
    Severity.WARNING,
    "this corner is written with {after} mm in place of {before}: the next place is {way:g} mm away, and the target's"
    " controller leaves out a move whose corner touches the one beside it",
)
COMPUTED = code(
    "corner-from-way",
    Severity.WARNING,
    "this corner ({before}) is written as at most its part of a way that the program computes: the target's controller"
    " leaves out a move whose corner touches the one beside it",
)
STOPPED = code(
    "corner-without-room",
    Severity.WARNING,
    "the robot stops here in place of a corner ({before}): how far it is to the corner in line {line} is not known, and"
    " the target's controller leaves out a move whose corner touches the one beside it",
    "give the places as constants, or this move or the other one no corner",
)
# Each corner takes so much of the way between two: less than half, so that they do not even touch in the rounding.
SHARE = 0.4999
_SLACK_MM = 1e-3
_CLEAR_MM = 0.02
_TOLD = 0.999  # what is not made smaller than by this share is a matter of rounding


@legalising(sees=("Move",))
def parted_corners(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that leave out moves. Behind what gives each move its corner."""
    if not any(isinstance(node, ir.Move) and _rounds(node) for node in walk_for({"Move"}, program.modules)):
        return program
    pairs = [one for one in pairs_of(program) if _rounds(one.first) or _rounds(one.second)]
    if not pairs:
        return program
    free = controller_named(context.source).corner_whole > 0.0
    ways = Ways.of(program, context)
    worker = _Corners(ways, Boxes.of(program, ways), context, free)
    for pair in pairs:
        worker.measure(pair)
    worker.measure_one_side()
    worker.leave_the_rest(pairs)
    worker.stop_unknown()
    return worker.program(program)


def _rounds(move: ir.Move | None) -> bool:
    return move is None or move.blend not in (None, ir.BlendStop())


@dataclass(slots=True)
class _Room:
    """What a corner may take: mm at most, and ways that the run computes. `way`: the one that decides; `beside`: ways
    that the run computes, with what the corner at the other end takes of them."""

    most: float = float("inf")
    way: float = 0.0
    computed: list[ir.Expression] = field(default_factory=list)
    beside: list[tuple[ir.Expression, float]] = field(default_factory=list)


@dataclass(slots=True)
class _Corners:
    ways: Ways
    boxes: Boxes
    context: Context
    free: bool  # does the source's controller let a corner take a whole move?
    rooms: dict[int, _Room] = field(default_factory=dict)
    unknown: list[Pair] = field(default_factory=list)
    stopped: dict[int, ir.Move] = field(default_factory=dict)  # and the move that it is too near to, perhaps
    sizes: dict[int, float | None] = field(default_factory=dict)
    made: dict[int, ir.Move] = field(default_factory=dict)
    kept: set[int] = field(default_factory=set)  # moves whose place is kept in mind
    variable: str = ""

    def measure(self, pair: Pair) -> None:
        """What two moves leave each other."""
        first, second = pair.first, pair.second
        moves = (second,) if pair.stands else (first, second)
        both = [one for one in moves if one is not None and self.size(one) != 0.0]
        way = self.ways.known_mm(first, second) if first is not None and second is not None else None
        if way is not None:
            for one in both if way > _SLACK_MM else ():  # who goes to where he is leaves nothing out
                if len(both) == 2 or not self.whole(one, way):
                    self.limit(one, SHARE * way, way)
            return
        if pair.stands or len(both) + (first is None) + (second is None) < 2:
            return  # the robot stops at the other one
        if first is not None and second is not None and self.far(both, self.boxes.least_mm(first, second)):
            return
        computed = self.ways.computed(first, second) if first is not None and second is not None else None
        if computed is None:
            self.unknown.append(pair)
            return
        for one in both:
            room = self.rooms.setdefault(id(one), _Room())
            if computed not in room.computed:
                room.computed.append(computed)

    def far(self, moves: list[ir.Move], least: float) -> bool:
        """Is there room for these corners wherever the run counts the places to?"""
        sizes = [self.size(one) for one in moves]
        return all(size is not None and size <= SHARE * least for size in sizes)

    def whole(self, move: ir.Move, way: float) -> bool:
        """May the corner take more than half of a way at whose other end the robot stands?"""
        size = self.size(move)
        return self.free and size is not None and size < way - _SLACK_MM

    def limit(self, move: ir.Move, most: float, way: float) -> None:
        room = self.rooms.setdefault(id(move), _Room())
        if most < room.most:
            room.most, room.way = most, way

    def measure_one_side(self) -> None:
        """Where one place is constant and the way is known at the other alone, that corner leaves the first its own."""
        left = []
        for pair in self.unknown:
            first, second = pair.first, pair.second
            if not any(self.leaves(one, other) for one, other in ((first, second), (second, first)) if one and other):
                left.append(pair)
        self.unknown = left

    def leaves(self, move: ir.Move, other: ir.Move) -> bool:
        way, most = self.ways.seen(move, other), self.taken(other)
        if way is None or most == float("inf"):
            return False
        beside = self.rooms.setdefault(id(move), _Room()).beside
        if (way, most) not in beside:
            beside.append((way, most))
        return True

    def leave_the_rest(self, pairs: list[Pair]) -> None:
        """Where the way to the next place is not known before, that one's corner takes what the first has left: the
        program keeps in mind where it has been."""
        unknown, before = _by_second(self.unknown), _by_second(pairs)
        left: list[Pair] = []
        for key, own in unknown.items():
            second = own[0].second
            firsts = [one.first for one in own if one.first is not None]
            taken = [self.taken(one) for one in firsts]
            here = None if second is None else self.ways.expression(second, {}, later=False)
            known = len(firsts) == len(own) and all(one.first is not None for one in before[key])
            if here is None or not known or float("inf") in taken or not all(map(self.can_note, firsts)):
                left += own
                continue
            self.kept |= {id(one.first) for one in before[key] if one.first is not None and self.can_note(one.first)}
            self.rooms.setdefault(key, _Room()).beside.append((between(here, self.corner()), max(taken)))
        self.unknown = left

    def taken(self, move: ir.Move) -> float:
        """What a corner takes at most, mm; infinite where no one knows."""
        size, room = self.size(move), self.rooms.get(id(move), _Room())
        return min(room.most, float("inf") if size is None else size)

    def corner(self) -> ir.Expression:
        """The variable for the place that the robot comes from."""
        self.variable = self.variable or self.context.fresh("rpl_corner")
        return ir.Name(self.variable)

    def can_note(self, move: ir.Move) -> bool:
        return self.ways.expression(move, {}, later=False) is not None or self.ways.at_start(move) is not None

    def noted(self, old: ir.Move, new: ir.Move) -> ir.Body:
        """A move, and where it goes kept in mind: before it, where that is seen from where the robot stands."""
        place = self.ways.expression(old, {}, later=False)
        later = place is not None
        place = place if place is not None else self.ways.at_start(old)
        assert place is not None  # as was looked for
        note = ir.Assign(self.corner(), ir.Builtin("pose_of", (place,)), origin=replace(old.origin, comments=()))
        return (new, note) if later else (note, new)

    def stop_unknown(self) -> None:
        """No corner where two may be too near to each other: of two that of the move that is in more such pairs."""
        count = Counter(key for pair in self.unknown for key in {id(pair.first), id(pair.second)})
        for pair in self.unknown:
            moves = [one for one in (pair.second, pair.first) if one is not None]
            if moves and not any(id(one) in self.stopped for one in moves):
                chosen = max(moves, key=lambda one: count[id(one)])
                self.stopped[id(chosen)] = moves[-1] if chosen is moves[0] else moves[0]

    def size(self, move: ir.Move) -> float | None:
        """Millimetres of a corner, 0 of a stop; None where the run decides."""
        key = id(move)
        if key not in self.sizes:
            self.sizes[key] = written_size(move.blend, self.ways.scopes[key])
        return self.sizes[key]

    # ---- writing

    def program(self, program: ir.Program) -> ir.Program:
        helpers = common_library(self.context)
        changed = False
        modules = []
        for module in program.modules:
            routines = tuple(edit_bodies(one, lambda body: self.body(body, helpers)) for one in module.routines)
            changed = changed or any(new is not old for new, old in zip(routines, module.routines, strict=True))
            modules.append(replace(module, routines=routines))
        if self.variable:
            origin = ir.Variable(self.variable, ir.PoseType(), ir.System("null_frame"), scope="global")
            name = self.context.fresh("rpl_corners")
            modules.append(ir.Module(name, program.modules[0].dialect, (origin,), public=True))
        return helpers.added_to(replace(program, modules=tuple(modules))) if changed else program

    def body(self, body: ir.Body, helpers: Library) -> ir.Body:
        def deeper(inner: ir.Body) -> ir.Body:
            return self.body(inner, helpers)

        done: list[ir.Statement] = []
        for one in body:
            if isinstance(one, ir.Move):
                new = self.move(one, helpers)
                done += self.noted(one, new) if id(one) in self.kept else (new,)
            else:
                done.append(inside(one, deeper))
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def move(self, move: ir.Move, helpers: Library) -> ir.Move:
        key = id(move)
        if key not in self.made:
            self.made[key] = self.fitted(move, helpers)
        return self.made[key]

    def fitted(self, move: ir.Move, helpers: Library) -> ir.Move:
        if move.blend in (None, ir.BlendStop()):
            return move
        size, room, other = self.size(move), self.rooms.get(id(move)), self.stopped.get(id(move))
        before = "a computed size" if size is None else f"{size:g} mm"
        if other is not None:
            self.context.diagnostics.report(STOPPED, move.origin, before=before, line=other.origin.line)
            return replace(move, blend=ir.BlendStop())
        if room is None or size == 0.0:
            return move
        asked = _asked(move.blend) if size is None else None
        if size is None and asked is None:
            return move  # a zone that the run chooses, which the target cannot say
        self.tell(move, before, size, room)
        most = min(room.most, float("inf") if size is None else size)
        if asked is None and not room.computed and not room.beside:
            return move if most == size else replace(move, blend=ir.BlendDistance(ir.Quantity(_metres(most), "m")))
        bounds: list[ir.Expression] = [ir.Magnitude(asked, "m")] if asked is not None else []
        bounds += [_metres(most)] if most < float("inf") else []
        bounds += [ir.Binary("*", ir.Magnitude(way, "m"), ir.RealLiteral(SHARE)) for way in room.computed]
        for way, taken in room.beside:
            left = ir.Binary("-", ir.Magnitude(way, "m"), _metres(taken + _CLEAR_MM))
            bounds.append(helpers.call("rpl_max", ir.RealLiteral(0.0), left))
        least: ir.Expression = bounds[0]
        for one in bounds[1:]:
            least = helpers.call("rpl_min", least, one)
        return replace(move, blend=ir.BlendDistance(ir.Quantity(least, "m")))

    def tell(self, move: ir.Move, before: str, size: float | None, room: _Room) -> None:
        if room.most < float("inf") and (size is None or room.most < _TOLD * size):
            after, way = f"{room.most:.4g}", round(room.way, 3)
            self.context.diagnostics.report(SMALLER, move.origin, before=before, after=after, way=way)
        elif room.computed or room.beside:
            self.context.diagnostics.report(COMPUTED, move.origin, before=before)


def _by_second(pairs: list[Pair]) -> dict[int, list[Pair]]:
    """Pairs by the identity of the second move."""
    found: dict[int, list[Pair]] = {}
    for pair in pairs:
        found.setdefault(id(pair.second), []).append(pair)
    return found


def _metres(value: float) -> ir.Expression:
    """Millimetres in metres, rounded down to the thousandth of a millimetre."""
    return ir.RealLiteral(float(f"{int(value * 1000.0 + 1e-6) / 1e6:.9g}"))


def _asked(blend: ir.Blend | None) -> ir.Expression | None:
    match blend:
        case ir.BlendDistance(distance=distance) | ir.BlendZone(distance=distance):
            return distance
    return None


__all__ = ["parted_corners"]
