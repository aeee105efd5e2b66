"""Answers about a program and its parts that are kept while these are the same objects.

Passes rewrite a program step by step, and most of its statements stay the same objects: what was worked out of one for
one pass holds for all later ones. Answers are kept within `keeping` only, while the passes of one translation run;
elsewhere each question is worked out anew. A question is a pure function; nobody changes the answer that he gets.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import wraps
from typing import Any, TypeVar

from rpl import ir

N = TypeVar("N")
A = TypeVar("A")
F = TypeVar("F", bound=frozenset[Any])


@dataclass(slots=True)
class _Kept:
    """Answers by question. Nodes go with theirs, so that no other one gets their identity."""

    of_nodes: dict[object, dict[int, tuple[object, Any]]] = field(default_factory=dict)
    of_programs: dict[object, tuple[ir.Program, Any]] = field(default_factory=dict)
    sets: dict[frozenset[Any], frozenset[Any]] = field(default_factory=dict)


_KEPT: ContextVar[_Kept | None] = ContextVar("kept answers", default=None)


@contextmanager
def keeping() -> Iterator[None]:
    """Within it answers are kept; behind it they are gone."""
    token = _KEPT.set(_KEPT.get() or _Kept())
    try:
        yield
    finally:
        _KEPT.reset(token)


def of_node(question: Callable[[N], A]) -> Callable[[N], A]:
    """A question about a node (a statement, a declaration) and what is in it."""

    @wraps(question)
    def asked(node: N) -> A:
        kept = _KEPT.get()
        if kept is None:
            return question(node)
        answers = kept.of_nodes.get(question)
        if answers is None:
            answers = kept.of_nodes[question] = {}
        known = answers.get(id(node))
        if known is None or known[0] is not node:
            answers[id(node)] = known = node, question(node)
        answer: A = known[1]
        return answer

    return asked


def of_program(question: Callable[[ir.Program], A]) -> Callable[[ir.Program], A]:
    """A question about a whole program; the answer is kept until another program is asked about."""

    @wraps(question)
    def asked(program: ir.Program) -> A:
        kept = _KEPT.get()
        if kept is None:
            return question(program)
        known = kept.of_programs.get(question)
        if known is None or known[0] is not program:
            kept.of_programs[question] = known = program, question(program)
        answer: A = known[1]
        return answer

    return asked


def shared(found: F) -> F:
    """The set as the one object that stands for all equal ones: thousands of statements hold the same."""
    kept = _KEPT.get()
    if kept is None:
        return found
    same: F = kept.sets.setdefault(found, found)  # type: ignore[assignment]  # equal sets are of one type here
    return same


__all__ = ["keeping", "of_node", "of_program", "shared"]
