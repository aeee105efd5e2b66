"""Variables that hold a setting of the motion: where each reader stands close behind a statement that sets what it
reads, all other statements that set the variable say nothing and go away.

The passes that make such a variable set it at every change, as they do not know yet which moves will read it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.rewriting.jumps import inside


def only_served(program: ir.Program, variables: Collection[str]) -> ir.Program:
    """The program without what sets one of these variables in vain."""
    for name in variables:
        program = _without(program, name)
    return program


def _without(program: ir.Program, name: str) -> ir.Program:
    nodes = [node for module in program.modules for node in walk(*module.routines)]
    stores = sum(_stores(node, name) for node in nodes)
    reads = sum(isinstance(node, ir.Name) and node.id == name for node in nodes) - stores
    needed: set[int] = set()
    served = 0
    for node in nodes:
        parts: Iterator[ir.Body] = iter(())
        if isinstance(node, ir.Routine):
            parts = iter(bodies(node))
        elif isinstance(node, ir.Statement):
            parts = iter(blocks(node))
        for body in parts:
            served += _served(body, name, needed)
    if served != reads or len(needed) == stores:
        return program

    def change(body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for one in body:
            if not _stores(one, name) or id(one) in needed:
                done.append(inside(one, change))
            elif one.origin.comments:
                done.append(ir.Nothing(origin=one.origin))
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    return edit_all(program, change)


def _stores(node: object, name: str) -> bool:
    match node:
        case ir.Assign(target=ir.Name(id=place)):
            return place == name
    return False


def _served(body: ir.Body, name: str, needed: set[int]) -> int:
    """How often statements of this block read what an earlier one of it has set for sure; those are `needed`."""
    last: ir.Statement | None = None
    count = 0
    for statement in body:
        stores = _stores(statement, name)
        nodes = list(walk(statement))
        if isinstance(statement, ir.Label) or sum(isinstance(node, ir.Statement) for node in nodes) > 1:
            last = None  # a jump may come here; blocks, and actions that run later
            continue
        found = sum(isinstance(node, ir.Name) and node.id == name for node in nodes) - stores
        if found and last is not None:
            count += found
            needed.add(id(last))
        if stores:
            last = statement
        elif any(isinstance(node, ir.CallRoutine | ir.Call) for node in nodes):
            last = None
    return count
