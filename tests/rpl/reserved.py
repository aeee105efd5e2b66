"""Which words the grammar of RPL takes for keywords where a name could stand: worked out from its parse table."""

from __future__ import annotations

import re
from functools import cache

from lark.lexer import TerminalDef

from rpl.reading.shapes import load_grammar

_WORD = re.compile(r"[a-z_]{2,}")
_PROBES = ("{}", "{} = 1", "{}:", "{}, x", "{}(x)", "{}[1]", "{})")


def keywords(grammar: str = "rpl.lark") -> frozenset[str]:
    """Every word that is a part of a keyword."""
    found: set[str] = set()
    for terminal in load_grammar(grammar).terminals:
        if "i" in terminal.pattern.flags and terminal.name != "UNIT":
            bare = re.sub(r"\\.|\(\?[=!:]", " ", terminal.pattern.value)
            found.update(_WORD.findall(bare))
    return frozenset(found)


def reserved(grammar: str = "rpl.lark") -> frozenset[str]:
    """The words of keywords that cannot stand bare as a name everywhere."""
    lark = load_grammar(grammar)
    terminals = {terminal.name: terminal for terminal in lark.terminals}
    words = keywords(grammar)
    found: set[str] = set()
    states = lark.parser.parser._parse_table.states
    for actions in states.values():
        names = [name for name in actions if "i" in getattr(terminals.get(name), "pattern", _NONE).flags]
        if "NAME" in actions:
            found.update(w for w in words if any(_takes(terminals[name], w) for name in names))
            if "_SET" not in names:  # at a statement's start no keyword can follow a name
                found.update(first for first, _ in _pairs(terminals, names, words))
        # A one-word keyword before a name: together they must not look like a two-word keyword.
        before = {name for name in names if "NAME" in states.get(actions[name][1], ())}
        for first, second in _pairs(terminals, names, words):
            if any(_takes(terminals[name], first) for name in before):
                found.add(second)
    return frozenset(found)


class _None:
    flags = ()


_NONE = _None()


@cache
def _takes(terminal: TerminalDef, word: str) -> bool:
    pattern = re.compile(terminal.pattern.to_regexp())
    for probe in _PROBES:
        match = pattern.match(probe.format(word))
        if match and match.end() == len(word):
            return True
    return False


def _pairs(terminals: dict[str, TerminalDef], names: list[str], words: frozenset[str]) -> set[tuple[str, str]]:
    """Two-word beginnings of the terminals accepted."""
    return {pair for name in names for pair in _pairs_of(terminals[name], words)}


@cache
def _pairs_of(terminal: TerminalDef, words: frozenset[str]) -> frozenset[tuple[str, str]]:
    value = terminal.pattern.value
    if r"\s" not in value:
        return frozenset()
    pattern = re.compile(terminal.pattern.to_regexp())
    bare = set(_WORD.findall(re.sub(r"\\.|\(\?[=!:]", " ", value))) & words
    tails = [" ".join(tail) for tail in ([], *([w] for w in bare), *([v, w] for v in bare for w in bare))]
    return frozenset(
        (first, second)
        for first in bare
        for second in bare
        if any(pattern.fullmatch(f"{first} {second} {tail}".strip()) for tail in tails)
    )
