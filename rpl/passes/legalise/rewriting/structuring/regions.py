"""A flow graph as structure: knots of nodes become loops, forward ways become branches.

A loop with several first nodes gets one that chooses between them by a state variable; nothing else does. A loop with
several ends, and a way forward over something that other ways run through, are told by a flag.
"""

from __future__ import annotations

import heapq
from collections import Counter
from dataclasses import dataclass, field, replace
from typing import TypeVar

from rpl import ir
from rpl.passes.legalise.rewriting.editing import Editor
from rpl.passes.legalise.rewriting.structuring.flowgraph import Around, Node, knots, reachable

_FIRST = 1
Looping = ir.For | ir.While | ir.Repeat | ir.Loop
Made = TypeVar("Made", ir.If, ir.Switch, Looping)


class Regions:
    """Turns the graphs of one routine into bodies. `returns`: the end of the body may be reached by Return. `made`: the
    branches and loops that were put together here, by identity. `markers`: what sets the flags that were needed."""

    def __init__(self, editor: Editor, returns: bool) -> None:
        self.editor = editor
        self.has = editor.capabilities.statements
        self.returns = returns
        self.made: dict[int, ir.Statement] = {}
        self.markers: dict[str, ir.Body] = {}
        self.sequences = 0
        self.exit = Node(kind="exit")

    def keep(self, statement: Made) -> Made:
        self.made[id(statement)] = statement
        return statement

    def flag(self, node: Node) -> ir.Name:
        return self.editor.temporary(f"to_{node.label.lower()}" if node.label else "onward", ir.BoolType())

    def body(self, first: Node) -> ir.Body:
        """The body that a graph is: loops first, then branches."""
        start = Node(ways=[first.final()])
        while True:
            nodes = reachable(start, lambda node: bool(node.kind))
            knot = next(knots(nodes), None)
            if knot is None:
                return Branches(self, start, nodes).body()
            heads = _heads(knot, nodes)
            if len(heads) > 1:
                self.dispatched(heads, nodes)
            else:
                self.knotted(knot, heads[0], nodes)

    # ---- loops

    def close(self, loop: Looping, first: Node, around: Around, follow: Node, graph: int) -> Node:
        """A loop of the source with a graph of its own as a node."""
        nodes = reachable(first.final(), lambda node: bool(node.kind) or node.graph != graph)
        return self.looped(loop, first.final(), nodes, around, follow.final())

    def knotted(self, knot: list[Node], head: Node, nodes: list[Node]) -> None:
        """Puts a node that is a loop in the place of a knot."""
        around = Around(Node(kind="leave"), Node(kind="next"))
        inner = _with_ends(knot, nodes)
        for node in knot:
            node.ways = [around.again if way is head else way for way in node.ways]
        ends = self.ends(inner, around)
        last = max(node.order for node in knot)
        behind = [end for end in ends if end.order > last and not end.kind] or [e for e in ends if not e.kind] or ends
        follow = min(behind, key=lambda node: node.order) if behind else None
        done = self.looped(ir.Loop(()), head, inner, around, follow)
        done.order = head.order
        inside = {id(node) for node in knot}
        for node in nodes:
            if id(node) not in inside:
                node.ways = [done if way is head else way for way in node.ways]

    def ends(self, nodes: list[Node], around: Around) -> list[Node]:
        """Where the ways out of these nodes go, each once."""
        inside = {id(node) for node in (*nodes, around.again, around.leave)}
        if self.returns:
            inside.add(id(self.exit))
        found = {id(way): way for node in nodes for way in node.ways if id(way) not in inside}
        return list(found.values())

    def looped(self, loop: Looping, first: Node, nodes: list[Node], around: Around, follow: Node | None) -> Node:
        """The loop as a node that goes on at `follow`, or at another end that a flag tells."""
        inside = {id(node) for node in (*nodes, around.again, around.leave)}
        flags: dict[int, tuple[Node, ir.Name]] = {}
        start = Node(ways=[first])
        for node in (start, *nodes):
            for at, way in enumerate(node.ways):
                if id(way) in inside:
                    continue
                if self.returns and way is self.exit:
                    node.ways[at] = Node((ir.Return(),))
                elif way is follow:
                    node.ways[at] = around.leave
                else:
                    if id(way) not in flags:
                        flags[id(way)] = (way, self.flag(way))
                    told = ir.Assign(flags[id(way)][1], ir.BoolLiteral(True))
                    node.ways[at] = Node((told,), ways=[around.leave])
        done = self.keep(replace(loop, body=self.body(start)))
        unset = tuple(ir.Assign(name, ir.BoolLiteral(False)) for _, name in flags.values())
        result = Node((*unset, done))
        if flags:
            result.fork = ir.If(tuple((name, ()) for _, name in flags.values()))
        result.ways = [*(end for end, _ in flags.values()), *([] if follow is None else [follow])]
        return result

    def dispatched(self, heads: list[Node], nodes: list[Node]) -> None:
        """One first node that chooses: each way to one of the heads says which."""
        state = self.editor.temporary("state", ir.IntType())
        choice = Node(order=heads[0].order, ways=list(heads))
        for number, head in enumerate(heads, _FIRST):
            say = ir.Assign(state, ir.IntLiteral(number))
            for node in nodes:
                for at, way in enumerate(node.ways):
                    if way is head:
                        node.ways[at] = Node((say,), ways=[choice], order=head.order)
        if len(heads) == 2:
            choice.fork = ir.If(((ir.Binary("=", state, ir.IntLiteral(_FIRST)), ()),))
        else:
            cases = tuple(ir.Case((ir.IntLiteral(number),), ()) for number in range(_FIRST, len(heads) + _FIRST - 1))
            choice.fork = ir.Switch(state, cases, ())


def _heads(knot: list[Node], nodes: list[Node]) -> list[Node]:
    """Nodes of the knot that are reached from outside of it, as in the source."""
    inside = {id(node) for node in knot}
    entries = {id(way) for node in nodes if id(node) not in inside for way in node.ways}
    return [node for node in sorted(knot, key=lambda node: node.order) if id(node) in entries]


def _with_ends(knot: list[Node], nodes: list[Node]) -> list[Node]:
    """The knot, and what only it leads to and where the routine ends: that stays inside of the loop."""
    entries = Counter(id(way) for node in nodes for way in node.ways)
    inside = {id(node) for node in knot}
    further = [
        way
        for node in knot
        for way in node.ways
        if not way.kind and not way.ways and entries[id(way)] == 1 and id(way) not in inside
    ]
    return [*knot, *further]


@dataclass(slots=True)
class _Sequence:
    """Nodes in which ways meet again behind a node: they stand behind it, in order. `at`: which part is being written
    (0: the node itself). `over`: ways from a part to a later one."""

    number: int
    parts: list[Node]
    at: int = 0
    over: list[tuple[int, int]] = field(default_factory=list)


class Branches:
    """Writes a graph without loops."""

    def __init__(self, regions: Regions, first: Node, nodes: list[Node]) -> None:
        self.regions = regions
        self.first = first
        self.entries: dict[int, int] = {}
        for node in nodes:
            for way in node.ways:
                self.entries[id(way)] = self.entries.get(id(way), 0) + 1
        self.ordered = self._in_order(nodes)
        self.behind = self._dominated()
        self.stack: list[_Sequence] = []

    def body(self) -> ir.Body:
        return self.node(self.first)

    def _in_order(self, nodes: list[Node]) -> list[Node]:
        """Every node behind the ones that lead to it; otherwise as in the source."""
        missing = {id(node): self.entries.get(id(node), 0) for node in nodes}
        count = 0
        ready: list[tuple[int, int, Node]] = [(self.first.order, count, self.first)]
        done = []
        while ready:
            *_, node = heapq.heappop(ready)
            done.append(node)
            for way in node.ways:
                if id(way) in missing:
                    missing[id(way)] -= 1
                    if missing[id(way)] == 0:
                        count += 1
                        heapq.heappush(ready, (way.order, count, way))
        return done

    def _dominated(self) -> dict[int, list[Node]]:
        """For each node those that are reached through it and no nearer one."""
        place = {id(node): at for at, node in enumerate(self.ordered)}
        above: dict[int, int] = {0: 0}
        before: dict[int, list[int]] = {}
        for node in self.ordered:
            for way in node.ways:
                if id(way) in place:
                    before.setdefault(place[id(way)], []).append(place[id(node)])
        for at in range(1, len(self.ordered)):
            one, *rest = before[at]
            for other in rest:
                while one != other:
                    if one > other:
                        one = above[one]
                    else:
                        other = above[other]
            above[at] = one
        found: dict[int, list[Node]] = {}
        for at in range(1, len(self.ordered)):
            found.setdefault(id(self.ordered[above[at]]), []).append(self.ordered[at])
        return found

    def node(self, node: Node) -> ir.Body:
        """A node and all that is reached through it only."""
        parts = [one for one in self.behind.get(id(node), ()) if self.entries[id(one)] > 1]
        self.regions.sequences += 1
        sequence = _Sequence(self.regions.sequences, parts)
        self.stack.append(sequence)
        written = [self.end(node)]
        for at, part in enumerate(parts, 1):
            sequence.at = at
            written.append(self.node(part))
        self.stack.pop()
        done: list[ir.Statement] = []
        for at, part in enumerate(parts, 1):
            if any(start < at < to for start, to in sequence.over):
                flag = self.regions.flag(part)
                self.regions.markers[_marker(sequence, at)] = (ir.Assign(flag, ir.BoolLiteral(True)),)
                done.append(ir.Assign(flag, ir.BoolLiteral(False)))
                written[at] = (self.regions.keep(ir.If(((flag, written[at]),))),)
        return (*node.statements, *done, *(one for part_body in written for one in part_body))

    def end(self, node: Node) -> ir.Body:
        match node.fork:
            case ir.If(branches=branches):
                bodies = [self.way(way) for way in node.ways]
                pairs = tuple((condition, body) for (condition, _), body in zip(branches, bodies, strict=False))
                return (self.regions.keep(replace(node.fork, branches=pairs, otherwise=bodies[-1])),)
            case ir.Switch(cases=cases, default=default):
                bodies = [self.way(way) for way in node.ways]
                filled = tuple(replace(case, body=body) for case, body in zip(cases, bodies, strict=False))
                other = bodies[-1] or (None if default is None else ())
                return (self.regions.keep(replace(node.fork, cases=filled, default=other)),)
        return self.way(node.ways[0]) if node.ways else ()

    def way(self, to: Node) -> ir.Body:
        """How control gets to a node from here."""
        match to.kind:
            case "leave":
                return (ir.ExitLoop(),)
            case "next" | "exit":
                if all(one.at == len(one.parts) for one in self.stack):
                    return ()
                if to.kind == "next" and "NextPass" in self.regions.has:
                    return (ir.NextPass(),)
                if to.kind == "exit" and self.regions.returns:
                    return (ir.Return(),)
                for one in self.stack:
                    one.over.append((one.at, len(one.parts) + 1))
                return ()
        if self.entries[id(to)] == 1:
            return self.node(to)
        for depth in range(len(self.stack) - 1, -1, -1):
            sequence = self.stack[depth]
            for at, part in enumerate(sequence.parts, 1):
                if part is to:
                    sequence.over.append((sequence.at, at))
                    return (ir.Goto(_marker(sequence, at)),)
            sequence.over.append((sequence.at, len(sequence.parts) + 1))
        raise AssertionError("a way to a node that is not behind this one")


def _marker(sequence: _Sequence, at: int) -> str:
    """Stands for setting the flag of a part until it is known whether the part has one."""
    return f"\0{sequence.number}/{at}"
