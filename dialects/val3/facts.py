"""What a look over all files of an application finds before its statements are read.

Programs with their parameters and local data, which names anything assigns, which signals are outputs, which task name
means which program.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from rpl.source import Source

from .data import KINDS, Datum

_PROGRAM = re.compile(
    r"<[Pp]rogram\s[^>]*?\bname=\"([^\"]+)\"[^>]*>((?:(?!</?[Pp]rogram\b).)*?)"
    r"<[Cc]ode>(\s*<!\[CDATA\[)?(.*?)(?:\]\]>\s*)?</[Cc]ode>",
    re.DOTALL,
)
_PARAMETER = re.compile(r"<(?:Parameter|param|parameter)\s([^>]*)>")
_LOCAL = re.compile(r"<(?:Local|local)\s([^>]*)>")
_ATTRIBUTE = re.compile(r"([\w:]+)=\"([^\"]*)\"")
# Sections of local data before s7: `<localSection><local name="n" type="num" size="1"/></localSection>`.
_ASSIGNED = re.compile(r"(?<![\w.:\"])([A-Za-z_]\w*)(?:\[[^\]\n]*\])?(?:\.\w+)*[ \t]*=(?!=)")
_PASSED = re.compile(r"\b(?:call\s+(?:\w+:)?\w+|setFrame|pointToJoint|toNum|taskCreate\w*[^\n]*?\w+)\s*\(([^\n]*)\)")
_TASK = re.compile(r"\btaskCreate(?:Sync)?\s+(\"[^\"\n]*\"|\w+)\s*,[^\n]*?(\w+)\s*\(")
_WORD = re.compile(r"[A-Za-z_]\w*")


@dataclass(frozen=True, slots=True)
class Declared:
    """A parameter or local datum: name, kind, the elements of each dimension (0: as many as are given), and whether it
    is a reference."""

    name: str
    kind: str
    sizes: tuple[int, ...] = (1,)
    reference: bool = False


@dataclass(frozen=True, slots=True)
class Header:
    """A program: its name, parameters and local data; where its code begins and ends in its file; whether the code
    stands as it is (CDATA) or with the signs of XML written as words (`&lt;`)."""

    name: str
    parameters: tuple[Declared, ...]
    locals: tuple[Declared, ...]
    start: int
    end: int
    plain: bool


@dataclass(slots=True)
class Facts:
    """What is known of an application. outputs: names of dio and aio that something sets or that are wired to outputs;
    assigned: names that something may change; tasks: name of a task, or of the text that holds it -> its program."""

    data: dict[str, Datum] = field(default_factory=dict)
    programs: dict[str, Header] = field(default_factory=dict)
    assigned: frozenset[str] = frozenset()
    tasks: Mapping[str, str] = field(default_factory=dict)


def headers_of(source: Source) -> tuple[Header, ...]:
    """The programs of a file."""
    return tuple(
        Header(
            found[1],
            tuple(_declared(part[1]) for part in _PARAMETER.finditer(found[2])),
            tuple(_declared(part[1]) for part in _LOCAL.finditer(found[2])),
            found.start(4),
            found.end(4),
            found[3] is not None,
        )
        for found in _PROGRAM.finditer(source.text)
    )


def _declared(text: str) -> Declared:
    """One parameter or local of its XML attributes."""
    given: dict[str, str] = dict(_ATTRIBUTE.findall(text))
    word = given.get("type", "num")
    sizes = tuple(map(int, re.findall(r"\d+", given.get("size", "1")))) or (1,)
    if given.get("xsi:type") == "array" and "size" not in given:
        sizes = (0,) * int(given.get("dimensions", "1"))
    reference = given.get("use") == "reference" or "false" in (given.get("byVal"), given.get("byValue"))
    return Declared(given.get("name", ""), KINDS.get(word, word), sizes, reference)


def facts_of(sources: Iterable[Source], data: Iterable[Datum]) -> Facts:
    facts = Facts({datum.name: datum for datum in data})
    assigned: set[str] = set()
    tasks: dict[str, str] = {}
    for source in sources:
        for header in headers_of(source):
            facts.programs[header.name] = header
            code = source.text[header.start : header.end]
            assigned.update(found[1] for found in _ASSIGNED.finditer(code))
            for found in _PASSED.finditer(code):
                assigned.update(_WORD.findall(found[1]))
            for found in _TASK.finditer(code):
                tasks[found[1].strip('"')] = found[2]
    facts.assigned = frozenset(assigned)
    for name, program in list(tasks.items()):
        datum = facts.data.get(name)
        if datum is not None and datum.kind == "string":
            tasks[datum.values.get(0, {}).get("value", name)] = program
    facts.tasks = tasks
    return facts
