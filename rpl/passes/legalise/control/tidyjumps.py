"""Bodies with jumps made tidy: no jump to the next statement, to another jump, or from where nothing comes; no label
that nothing jumps to. What a run shows stays as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.passes.conditions import opposite
from rpl.passes.legalise.facts.effects import Effects, blocks
from rpl.passes.legalise.rewriting.jumps import inside, labels, leaves, targets, without_labels

_ROUNDS = 200


def tidied(body: ir.Body, effects: Effects) -> ir.Body:
    """The body of a routine, tidy."""
    for _ in range(_ROUNDS):
        before = body
        body = _renamed(body, _forwarding(body))
        body = _rounds(body, effects)
        used = targets(body)
        body = without_labels(body, {name for name in labels(body) if not used[name]})
        if body == before:
            break
    return body


# ---- labels that stand for another place


def _forwarding(body: ir.Body) -> dict[str, str]:
    """Label -> the label that jumps to it may as well go to, in all bodies."""
    found: dict[str, str] = {}

    def look(statements: ir.Body) -> None:
        for at, statement in enumerate(statements):
            for inner in blocks(statement):
                look(inner)
            if not isinstance(statement, ir.Label):
                continue
            following = next((one for one in statements[at + 1 :] if not isinstance(one, ir.Nothing)), None)
            match following:
                case ir.Label(name=name) | ir.Goto(label=name) if name.lower() != statement.name.lower():
                    found[statement.name.lower()] = name

    look(body)
    return {name: _followed(name, found) for name in found}


def _followed(name: str, found: dict[str, str]) -> str:
    seen = {name}
    target = found[name]
    while target.lower() in found and target.lower() not in seen:
        seen.add(target.lower())
        target = found[target.lower()]
    return target


def _renamed(body: ir.Body, to: dict[str, str]) -> ir.Body:
    if not to:
        return body

    def statements(inner: ir.Body) -> ir.Body:
        return tuple(map(change, inner))

    def change(statement: ir.Statement) -> ir.Statement:
        match statement:
            case ir.Goto(label=name) if to.get(name.lower(), name) != name:
                return replace(statement, label=to[name.lower()])
        return inside(statement, statements)

    return statements(body)


# ---- jumps that do nothing


def _rounds(body: ir.Body, effects: Effects) -> ir.Body:
    done: list[ir.Statement] = []
    for at, old in enumerate(body):
        statement = inside(old, lambda inner: _rounds(inner, effects))
        rest = body[at + 1 :]
        if isinstance(statement, ir.Goto) and (_dead(done) or _next(rest, statement.label)):
            _keep_comments(statement, done)
            continue
        match statement:
            case ir.If(branches=((condition, (ir.Goto(label=label),)),), otherwise=()):
                if _next(rest, label) and effects.quiet(condition) and effects.safe(condition):
                    _keep_comments(statement, done)
                    continue
        if isinstance(statement, ir.Goto) and _turn(statement, rest, done):
            continue
        done.append(statement)
    return tuple(done) if len(done) != len(body) or any(a is not b for a, b in zip(done, body, strict=True)) else body


def _dead(done: Sequence[ir.Statement]) -> bool:
    """Does nothing come behind these statements?"""
    last = next((one for one in reversed(done) if not isinstance(one, ir.Nothing)), None)
    return last is not None and leaves(last)


def _next(rest: Sequence[ir.Statement], label: str) -> bool:
    """Do the labels that follow have this one among them?"""
    for one in rest:
        match one:
            case ir.Label(name=name):
                if name.lower() == label.lower():
                    return True
            case ir.Nothing():
                continue
            case _:
                return False
    return False


def _turn(jump: ir.Goto, rest: Sequence[ir.Statement], done: list[ir.Statement]) -> bool:
    """`If c Goto a; Goto b; a:` is `If not c Goto b; a:`."""
    match done[-1:]:
        case [ir.If(branches=((condition, (ir.Goto(label=label),)),), otherwise=()) as before] if _next(rest, label):
            if jump.origin.comments:
                return False
            turned = ((opposite(condition), (replace(jump, origin=before.branches[0][1][0].origin),)),)
            done[-1] = replace(before, branches=turned)
            return True
    return False


def _keep_comments(statement: ir.Statement, done: list[ir.Statement]) -> None:
    if statement.origin.comments:
        done.append(ir.Nothing(origin=statement.origin))
