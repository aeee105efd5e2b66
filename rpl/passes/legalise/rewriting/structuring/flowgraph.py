"""The flow graph of a body with jumps: nodes of plain statements, with a branch at their end or a way on.

Statements that no jump leaves or enters stay whole. A loop that jumps leave but none enters stays a loop: its body has
a graph of its own, whose ways out are ways of the loop's node (see passes.legalise.regions).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.passes.legalise.facts.effects import blocks, statements_in
from rpl.passes.legalise.rewriting.jumps import LOOPS, entered, labels, own_jumps, targets
from rpl.source import Origin


@dataclass(slots=True, eq=False)
class Node:
    """`fork`: an If or Switch whose bodies are the `ways`, the last one for no match. Without fork one way, or none
    where nothing follows. `kind`: empty, or what a way to it says: `next` pass, `leave` the loop, `exit` the routine.
    `graph`: the number of the graph it is in. `order`: its place in the source."""

    statements: tuple[ir.Statement, ...] = ()
    fork: ir.If | ir.Switch | None = None
    ways: list[Node] = field(default_factory=list)
    kind: str = ""
    graph: int = 0
    order: int = 0
    label: str = ""

    def final(self) -> Node:
        """This node, or the one behind when it does nothing."""
        node, seen, label = self, {id(self)}, ""
        while not node.kind and not node.statements and node.fork is None and len(node.ways) == 1:
            label = label or node.label
            node = node.ways[0]
            if id(node) in seen:
                break
            seen.add(id(node))
        if not node.kind:
            node.label = node.label or label
        return node


@dataclass(frozen=True, slots=True)
class Around:
    """Where ExitLoop and NextPass go."""

    leave: Node
    again: Node


# What closes a graph: the loop, the first node of its body, where its passes and its end go, the number of the graph.
Looping = ir.For | ir.While | ir.Repeat | ir.Loop
Close = Callable[[Looping, Node, Around, Node, int], Node]


class Builder:
    """Makes the graph of one body. `close` turns a loop with a graph of its own into a node. `raises`: the routine may
    go on behind a Raise. `next_pass`: the target has NextPass."""

    def __init__(self, body: ir.Body, close: Close, raises: bool, next_pass: bool) -> None:
        self.close = close
        self.next_pass = next_pass
        self.terminal: tuple[type, ...] = (ir.Return, ir.Retry, ir.TryNext) + (() if raises else (ir.Raise,))
        self.used = set(targets(body))
        self.entered = entered(body)
        self.nodes: dict[str, Node] = {}
        self.graph = 0
        self.graphs = 0
        self.order = 0
        self.numbers: dict[int, int] = {}
        self._count(body)

    def _count(self, body: ir.Body) -> None:
        for statement in body:
            self.order += 1
            self.numbers[id(statement)] = self.order
            for inner in blocks(statement):
                self._count(inner)

    def node(self, statement: ir.Statement, *ways: Node) -> Node:
        return Node(ways=list(ways), graph=self.graph, order=self.numbers.get(id(statement), 0))

    def whole(self, statement: ir.Statement) -> bool:
        """Does no jump leave the statement or go into it?"""
        if own_jumps(statement) or (not self.next_pass and _has_next_pass(statement)):
            return False
        return not labels((statement,)) & self.used and not targets((statement,))

    def declare(self, body: ir.Body) -> None:
        """Nodes for the labels of this graph."""
        for statement in body:
            if isinstance(statement, ir.Label):
                node = self.node(statement)
                node.label = statement.name
                self.nodes.setdefault(statement.name.lower(), node)
            if not isinstance(statement, LOOPS) or self.taken_apart(statement):
                for inner in blocks(statement):
                    self.declare(inner)

    def taken_apart(self, statement: ir.Statement) -> bool:
        return isinstance(statement, ir.While | ir.Repeat | ir.Loop) and id(statement) in self.entered

    def sequence(self, body: ir.Body, follow: Node, around: Around | None) -> Node:
        """The first node of a body that goes on at `follow`."""
        here = follow
        plain: list[ir.Statement] = []
        for statement in reversed(body):
            if self.is_plain(statement):
                plain.append(statement)
                continue
            here = self.flushed(plain, here)
            here = self.statement(statement, here, around)
        return self.flushed(plain, here)

    def is_plain(self, statement: ir.Statement) -> bool:
        if isinstance(statement, (ir.Label, ir.Goto, ir.ExitLoop, ir.NextPass, *self.terminal)):
            return False
        if isinstance(statement, ir.Halt):
            return statement.kind == "stop"
        return self.whole(statement)

    def flushed(self, plain: list[ir.Statement], here: Node) -> Node:
        if not plain:
            return here
        node = self.node(plain[-1], here)
        node.statements = tuple(reversed(plain))
        plain.clear()
        return node

    def statement(self, statement: ir.Statement, follow: Node, around: Around | None) -> Node:
        match statement:
            case ir.Label(name=name) if name.lower() in self.nodes:
                node = self.nodes[name.lower()]
                node.statements, node.ways = _comments(statement.origin), [follow]
                return node
            case ir.Goto(label=name) if name.lower() in self.nodes:
                return self.commented(statement, self.nodes[name.lower()])
            case ir.ExitLoop() if around is not None:
                return self.commented(statement, around.leave)
            case ir.NextPass() if around is not None:
                return self.commented(statement, around.again)
            case ir.If(branches=branches, otherwise=otherwise):
                ways = [self.sequence(body, follow, around) for _, body in branches]
                return self.fork(statement, [*ways, self.sequence(otherwise, follow, around)])
            case ir.Switch(cases=cases, default=default):
                ways = [self.sequence(case.body, follow, around) for case in cases]
                return self.fork(statement, [*ways, self.sequence(default or (), follow, around)])
            case ir.For() | ir.While() | ir.Repeat() | ir.Loop():
                return self.loop(statement, follow)
        node = self.node(statement)
        node.statements = (statement,)
        if not isinstance(statement, (*self.terminal, ir.Halt)):
            node.ways = [follow]
        return node

    def commented(self, jump: ir.Statement, to: Node) -> Node:
        if not jump.origin.comments:
            return to
        node = self.node(jump, to)
        node.statements = _comments(jump.origin)
        return node

    def fork(self, statement: ir.If | ir.Switch, ways: list[Node]) -> Node:
        node = self.node(statement, *ways)
        node.fork = statement
        return node

    def loop(self, statement: ir.For | ir.While | ir.Repeat | ir.Loop, follow: Node) -> Node:
        if self.taken_apart(statement):
            return self.apart(statement, follow)
        outer = self.graph
        self.graphs += 1
        self.graph = inside = self.graphs
        around = Around(Node(kind="leave", graph=inside), Node(kind="next", graph=inside))
        self.declare(statement.body)
        first = self.sequence(statement.body, around.again, around)
        self.graph = outer
        node = self.close(statement, first, around, follow, inside)
        node.graph, node.order = outer, self.numbers.get(id(statement), 0)
        return node

    def apart(self, statement: ir.Statement, follow: Node) -> Node:
        """A loop that a jump goes into: its check and its body are nodes like others."""
        match statement:
            case ir.While(condition=condition, body=body):
                check = self.fork(ir.If(((condition, ()),), origin=statement.origin), [])
                check.order = self.numbers[id(statement)]
                check.ways = [self.sequence(body, check, Around(follow, check)), follow]
                return check
            case ir.Repeat(until=until, body=body):
                check = self.fork(ir.If(((until, ()),), origin=replace(statement.origin, comments=())), [])
                check.order = self.numbers[id(statement)]
                first = self.sequence(body, check, Around(follow, check))
                check.ways = [follow, first]
                return self.commented(statement, first)
            case ir.Loop(body=body):
                start = self.node(statement)
                start.ways = [self.sequence(body, start, Around(follow, start))]
                start.statements = _comments(statement.origin)
                return start
        return follow


def _has_next_pass(statement: ir.Statement) -> bool:
    return any(isinstance(one, ir.NextPass) for one in statements_in((statement,)))


def _comments(origin: Origin) -> tuple[ir.Statement, ...]:
    return (ir.Nothing(origin=origin),) if origin.comments else ()


def reachable(first: Node, stops: Callable[[Node], bool]) -> list[Node]:
    """Nodes that are reached from `first` without going through one that `stops` names; ways are made final."""
    found: list[Node] = []
    seen: set[int] = set()
    stack = [first]
    while stack:
        node = stack.pop()
        if id(node) in seen or stops(node):
            continue
        seen.add(id(node))
        found.append(node)
        node.ways = [way.final() for way in node.ways]
        stack.extend(reversed(node.ways))
    return found


def knots(nodes: list[Node]) -> Iterator[list[Node]]:
    """Sets of nodes that all reach each other (more than one, or one with a way to itself)."""
    index: dict[int, int] = {}
    low: dict[int, int] = {}
    path: list[Node] = []
    on_path: set[int] = set()
    inside = {id(node) for node in nodes}
    for start in nodes:
        if id(start) in index:
            continue
        work: list[tuple[Node, Iterator[Node]]] = []

        def open_node(node: Node) -> tuple[Node, Iterator[Node]]:
            index[id(node)] = low[id(node)] = len(index)
            path.append(node)
            on_path.add(id(node))
            return node, iter(list(node.ways))

        work.append(open_node(start))
        while work:
            node, ways = work[-1]
            for way in ways:
                if id(way) not in inside:
                    continue
                if id(way) not in index:
                    work.append(open_node(way))
                    break
                if id(way) in on_path:
                    low[id(node)] = min(low[id(node)], index[id(way)])
            else:
                work.pop()
                if work:
                    low[id(work[-1][0])] = min(low[id(work[-1][0])], low[id(node)])
                if low[id(node)] == index[id(node)]:
                    at = next(i for i, one in enumerate(path) if one is node)
                    found = path[at:]
                    del path[at:]
                    on_path.difference_update(map(id, found))
                    if len(found) > 1 or any(way is node for way in node.ways):
                        yield found
