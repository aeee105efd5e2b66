"""What moves when a frame moves: the frames that are affixed to it, and those that it is affixed to rigidly.

A frame that takes part in an affixment gets a procedure which does what its change asks for. Going from the frame along
the affixments in the order of their first AFFIX, depth first and never through a frame twice on one way, each frame
gets its place from the one it was reached from: so a circle ends. All are moved by the same rigid displacement,
whichever way they are reached. Last, frames that moved without what they are affixed to take their relative pose anew.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from rpl import ir
from rpl.source import Origin

MOST_STEPS = 200
# What a part that is held is affixed to: no variable, but where the tool centre point is when it is asked for.
TOOL = ir.Variable("tool", ir.PoseType())


@dataclass(slots=True)
class Pair:
    """Two frames that an AFFIX names, where it stands first, and the data that keep the affixment: the pose of `child`
    in `parent`, whether the child follows the parent, and whether the parent follows the child. `one_way`, `rigid`:
    which kinds of AFFIX the program has for the two."""

    child: ir.Variable
    parent: ir.Variable
    origin: Origin
    one_way: bool = False
    rigid: bool = False
    relative: str = ""
    follows: str = ""
    leads: str = ""

    def name(self, free: Callable[[str], str]) -> None:
        """Give the data names that nothing else has."""
        child, parent = self.child.name, self.parent.name
        self.relative = free(f"{child}_in_{parent}")
        self.follows = free(f"{child}_follows_{parent}")
        self.leads = free(f"{parent}_follows_{child}") if self.rigid else ""

    def touches(self, *frames: ir.Variable) -> bool:
        """Whether one of the frames is its child or its parent."""
        return any(frame is self.child or frame is self.parent for frame in frames)

    def declarations(self, scope: str) -> tuple[ir.Variable, ...]:
        """The data: nothing is affixed when the program begins."""
        same = ir.Aggregate(tuple((part, ir.IntLiteral(0)) for part in ("x", "y", "z", "a", "b", "c")))
        flags = [name for name in (self.follows, self.leads) if name]
        return (
            ir.Variable(self.relative, ir.PoseType(), same, "variable", scope),
            *(ir.Variable(name, ir.BoolType(), ir.BoolLiteral(False), "variable", scope) for name in flags),
        )

    def affix(self, rigidly: bool, origin: Origin, quiet: Origin) -> tuple[ir.Statement, ...]:
        """AFFIX: the relative pose as it is now, and who follows whom. quiet: the place without its comments."""
        done: list[ir.Statement] = [self.retake(origin), _set(self.follows, True, quiet)]
        if self.leads:
            done.append(_set(self.leads, rigidly, quiet))
        return tuple(done)

    def unfix(self, origin: Origin, quiet: Origin) -> tuple[ir.Statement, ...]:
        """UNFIX: nobody follows."""
        flags = [name for name in (self.follows, self.leads) if name]
        return tuple(_set(name, False, origin if name == self.follows else quiet) for name in flags)

    def retake(self, origin: Origin) -> ir.Assign:
        """The relative pose as the two frames stand."""
        back = ir.Builtin("inverse", (_where_is(self.parent, origin),), origin=origin)
        value = ir.Binary(":", back, ir.Name(self.child.name, origin=origin), origin=origin)
        return ir.Assign(ir.Name(self.relative, origin=origin), value, origin=origin)

    def child_moves(self, origin: Origin) -> ir.Assign:
        """The child goes with the parent."""
        relative = ir.Name(self.relative, origin=origin)
        return _place(self.child.name, _where_is(self.parent, origin), relative, origin)

    def parent_moves(self, origin: Origin) -> ir.Assign:
        """The parent goes with the child."""
        back = ir.Builtin("inverse", (ir.Name(self.relative, origin=origin),), origin=origin)
        return _place(self.parent.name, ir.Name(self.child.name, origin=origin), back, origin)

    def alone(self, origin: Origin) -> ir.Expression:
        """Whether the child follows and does not lead."""
        follows = ir.Name(self.follows, origin=origin)
        if not self.leads:
            return follows
        return ir.Binary(
            "and", follows, ir.Unary("not", ir.Name(self.leads, origin=origin), origin=origin), origin=origin
        )


def _set(flag: str, value: bool, origin: Origin) -> ir.Assign:
    return ir.Assign(ir.Name(flag, origin=origin), ir.BoolLiteral(value, origin=origin), origin=origin)


def _where_is(frame: ir.Variable, origin: Origin) -> ir.Expression:
    if frame is TOOL:
        return ir.Builtin("current_target", (), origin=origin)
    return ir.Name(frame.name, origin=origin)


def _place(frame: str, base: ir.Expression, offset: ir.Expression, origin: Origin) -> ir.Assign:
    return ir.Assign(ir.Name(frame, origin=origin), ir.Binary(":", base, offset, origin=origin), origin=origin)


@dataclass(slots=True)
class Following:
    """The body of one frame's procedure. `steps`: how many frames it places; more than MOST_STEPS are not written."""

    pairs: Sequence[Pair]
    steps: int = 0
    frames: dict[int, ir.Variable] = field(default_factory=dict)  # those that it places
    _reached: set[tuple[int, int]] = field(default_factory=set)  # pair, frame that was reached by it

    def body(self, frame: ir.Variable) -> ir.Body:
        """What follows a change of the frame; empty where that is nothing."""
        self._moved(frame, (frame,), None)
        changing = {id(frame), *self.frames}
        self.steps = 0
        return (*self._moved(frame, (frame,), changing), *self._taken_anew(frame, changing))

    def _moved(self, frame: ir.Variable, way: tuple[ir.Variable, ...], changing: set[int] | None) -> ir.Body:
        """changing: all the frames that can change with the first one, once they are known."""
        done: list[ir.Statement] = []
        for pair in self.pairs:
            if pair.parent is frame:
                other, asked, step = pair.child, pair.follows, pair.child_moves
            elif pair.child is frame and pair.rigid:
                other, asked, step = pair.parent, pair.leads, pair.parent_moves
            else:
                continue
            if any(one is other for one in way) or self.steps > MOST_STEPS:
                continue
            self.steps += 1
            self.frames[id(other)] = other
            self._reached.add((id(pair), id(other)))
            left = [one for one in self.pairs if one is not pair and one.child is other and changing is not None]
            inner = (step(pair.origin), *self._moved(other, (*way, other), changing))
            anew = tuple(_taken_anew(one) for one in left if one.one_way and id(one.parent) not in (changing or ()))
            done.append(ir.If(((ir.Name(asked, origin=pair.origin), (*inner, *anew)),), origin=pair.origin))
        return tuple(done)

    def _taken_anew(self, frame: ir.Variable, changing: set[int]) -> ir.Body:
        """For the frame itself, and for those that can have moved together with what they are affixed to or without it:
        which it was is known when all have moved. What is affixed to the frame itself has gone with it."""
        done: list[ir.Statement] = []
        for pair in self.pairs:
            others = {by for by, reached in self._reached if reached == id(pair.child)} - {id(pair)}
            open_yet = others and pair.parent is not frame and id(pair.parent) in changing
            if pair.one_way and (pair.child is frame or open_yet):
                done.append(_taken_anew(pair))
        return tuple(done)


def _taken_anew(pair: Pair) -> ir.If:
    return ir.If(((pair.alone(pair.origin), (pair.retake(pair.origin),)),), origin=pair.origin)
