"""Where in a routine a temporary is used, and which temporaries of one routine are never needed at the same time.

A temporary lives from the first to the last statement of the body that holds all its uses. That is sure where no label
stands between (nothing comes in from elsewhere) and where it is set before it is read, which the caller has looked at.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.facts.effects import blocks, children, everything

# What is looked at when the program has gone on.
_LATER = (ir.Trigger, ir.DefineTrigger, ir.DeclareInterrupt, ir.OrderInterrupt, ir.Pulse, ir.SetAfter, ir.Move)
Path = tuple[int, ...]  # number of the body, index, number of the inner body, index, ...


@dataclass(frozen=True, slots=True)
class Life:
    """From one index to another of the body at `body`."""

    body: Path
    first: int
    last: int

    def meets(self, other: Life) -> bool:
        """Can both be needed at one moment?"""
        outer, inner = (self, other) if len(self.body) <= len(other.body) else (other, self)
        size = len(outer.body)
        if inner.body[:size] == outer.body:
            first = inner.first if len(inner.body) == size else inner.body[size]
            last = inner.last if len(inner.body) == size else first
            return not (last < outer.first or outer.last < first)
        at = next(number for number, one in enumerate(outer.body) if inner.body[number] != one)
        return at % 2 == 0  # bodies of one statement; else of different statements


def companions(routine: ir.Routine, variables: Iterable[ir.Variable]) -> dict[str, ir.Variable]:
    """For each variable (folded) the one whose place it can take: itself, or one that is not needed while it is."""
    wanted = {one.name.lower(): one for one in variables}
    places: dict[str, list[Path]] = {name: [] for name in wanted}
    labels: list[Path] = []
    for path, statement in _statements(routine):
        if isinstance(statement, ir.Label):
            labels.append(path)
        for name in _named(statement) & places.keys():
            if isinstance(statement, _LATER):
                del places[name]
            else:
                places[name].append(path)
    lives = {name: life for name, paths in places.items() if (life := _life(paths, labels)) is not None}
    groups: list[tuple[ir.Variable, list[Life]]] = []
    done = dict(wanted)
    for name in sorted(lives, key=lambda one: (lives[one].body, lives[one].first)):
        life, variable = lives[name], wanted[name]
        for first, members in groups:
            if first.type == variable.type and not any(life.meets(one) for one in members):
                members.append(life)
                done[name] = first
                break
        else:
            groups.append((variable, [life]))
    return done


def _statements(routine: ir.Routine) -> Iterator[tuple[Path, ir.Statement]]:
    """Every statement with the way to it."""

    def below(body: ir.Body, path: Path) -> Iterator[tuple[Path, ir.Statement]]:
        for at, statement in enumerate(body):
            here = (*path, at)
            yield here, statement
            for number, inner in enumerate(blocks(statement)):
                yield from below(inner, (*here, number))

    for number, body in enumerate(bodies(routine)):
        yield from below(body, (number,))


def _named(statement: ir.Statement) -> set[str]:
    """The names in a statement itself, not in the bodies inside of it."""
    if isinstance(statement, _LATER):
        return {node.id.lower() for node in walk(statement) if isinstance(node, ir.Name)}
    found = {statement.counter.lower()} if isinstance(statement, ir.For) else set()
    for child in children(statement):
        found.update(one.id.lower() for one in everything(child) if isinstance(one, ir.Name))
    return found


def _life(paths: list[Path], labels: list[Path]) -> Life | None:
    """The life of what is used at these places; None where a jump may come into it."""
    if not paths:
        return None
    shortest = min(len(one) for one in paths)
    size = next((at for at in range(shortest) if len({one[at] for one in paths}) > 1), shortest - 1)
    size -= 1 - size % 2  # an index: what stands before it is a body
    if size < 1:
        return None
    body = paths[0][:size]
    first, last = min(one[size] for one in paths), max(one[size] for one in paths)
    if any(one[:size] == body and first <= one[size] <= last for one in labels):
        return None
    return Life(body, first, last)


__all__ = ["Life", "companions"]
