"""Threads that a program runs more than once at a time: each `run` begins another one, with a handle of its own.

The IR knows a task by its routine, so a thread that is started into several handles becomes several routines: the first
handle has the thread itself, each further one a copy with a number behind its name. A handle that is used again stays
with its copy. `run` without a handle begins a further copy where nothing that could take time stands in between.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from . import nodes
from .nodes import Block, Define, Node, Run, Store
from .scopes import statements

_TAKES_NO_TIME = ("set_", "write_", "textmsg")
_Key = tuple[str, str]


def told_apart(block: Block) -> Block:
    """The statements of a source with a copy of each thread that runs several times."""
    worker = _Instances({name for node in _every(block) for name in _own_names(node)})
    worker.note(block)
    return worker.block(block) if worker.copies else block


def _every(block: Block) -> Iterator[Node]:
    for node in statements(block):
        yield node
        if isinstance(node, Define):
            yield from _every(node.body)


def _own_names(node: Node) -> Iterator[str]:
    match node:
        case Define(name=name):
            yield name
        case Store(target=nodes.Var(name=name)):
            yield name


def _started(node: Node) -> tuple[str, str] | None:
    """The thread that a statement starts, and what keeps its handle (empty: nothing)."""
    match node:
        case Store(target=nodes.Var() | nodes.At() as target, value=Run(call=nodes.Apply(name=name, base=None))):
            return name, nodes.shown(target)
        case nodes.Perform(call=Run(call=nodes.Apply(name=name, base=None))):
            return name, ""
    return None


@dataclass(slots=True)
class _Instances:
    """`taken`: names that a copy may not have; `copies`: the copies of each thread by what keeps the handle;
    `handles`: what keeps a handle of each thread, in their order."""

    taken: set[str]
    copies: dict[_Key, str] = field(default_factory=dict)
    handles: dict[str, list[str]] = field(default_factory=dict)

    # ---- what there is

    def note(self, block: Block) -> None:
        """Give a name to each further handle of a thread. Handles in one list are told apart by their written index;
        one that is computed could be any, so that list has one thread."""
        for key in self.keys(block):
            name, handle = key
            known = self.handles.setdefault(name, [])
            if handle in known:
                continue
            known.append(handle)
            if len(known) > 1:
                self.copies[key] = self.free(name)

    def keys(self, block: Block) -> Iterator[_Key]:
        beside: Counter[str] = Counter()
        for node in block:
            started = _started(node)
            if started is not None:
                yield self.key(started, beside)
            elif not _is_instant(node):
                beside.clear()
            for inner in _blocks(node):
                yield from self.keys(inner)

    def key(self, started: tuple[str, str], beside: Counter[str]) -> _Key:
        name, handle = started
        if handle:
            return name, handle
        beside[name] += 1
        return name, "" if beside[name] == 1 else f"#{beside[name]}"

    def free(self, name: str) -> str:
        number = 2
        while f"{name}_{number}" in self.taken:
            number += 1
        self.taken.add(f"{name}_{number}")
        return f"{name}_{number}"

    # ---- the copies

    def block(self, block: Block) -> Block:
        beside: Counter[str] = Counter()
        done: list[Node] = []
        for node in block:
            started = _started(node)
            if started is not None:
                node = self.start(node, self.copies.get(self.key(started, beside)))
            elif not _is_instant(node):
                beside.clear()
            node = self.inside(node)
            done.append(node)
            if isinstance(node, Define):
                made = [copy for (name, _), copy in self.copies.items() if name == node.name]
                done += [replace(node, name=copy) for copy in made]
        return tuple(done)

    def start(self, node: Node, copy: str | None) -> Node:
        match node:
            case Store(value=Run(call=nodes.Apply() as call)) if copy is not None:
                return replace(node, value=Run(replace(call, name=copy)))
            case nodes.Perform(call=Run(call=nodes.Apply() as call)) if copy is not None:
                return replace(node, call=Run(replace(call, name=copy)))
        return node

    def inside(self, node: Node) -> Node:
        match node:
            case nodes.Branches(branches=branches, otherwise=otherwise):
                done = tuple((condition, self.block(body)) for condition, body in branches)
                return replace(node, branches=done, otherwise=self.block(otherwise))
            case nodes.Repeat(body=body) | Define(body=body):
                return replace(node, body=self.block(body))
        return node


def _blocks(node: Node) -> tuple[Block, ...]:
    match node:
        case nodes.Branches(branches=branches, otherwise=otherwise):
            return (*(body for _, body in branches), otherwise)
        case nodes.Repeat(body=body) | Define(body=body):
            return (body,)
    return ()


def _is_instant(node: Node) -> bool:
    """Does the statement surely take no time?"""
    match node:
        case Store(value=nodes.Apply()):
            return False
        case nodes.Perform(call=nodes.Apply(name=name, base=None)):
            return name.startswith(_TAKES_NO_TIME)
        case Store() | nodes.Declare() | nodes.Perform(call=Run()):
            return True
    return node.__class__.__name__ == "Nothing"


__all__ = ["told_apart"]
