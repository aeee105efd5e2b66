"""The data of an application (.dtx) as neutral records, of both forms: typed sections (before s7) and `Data` elements.

A datum is an array; a value left out has the type's default. Points, frames and tools name their father, tools and
signals what they are wired to.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as Xml
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import prod

from rpl.source import Source

# What the words of the file mean; the Rx and Rs forms are those of six-axis and SCARA arms.
KINDS = {
    "pointRx": "point", "pointRs": "point", "jointRx": "joint", "jointRs": "joint",
    "configRx": "config", "configRs": "config",
}  # fmt: skip
POSE = ("x", "y", "z", "rx", "ry", "rz")
FLAGS = ("shoulder", "elbow", "wrist")
JOINTS = ("j1", "j2", "j3", "j4", "j5", "j6")
_MDESC = {"tmax": "tvel", "rmax": "rvel"}
_FATHER = re.compile(r"([A-Za-z_]\w*)(?:\[(\d+)\])?$")


@dataclass(frozen=True, slots=True)
class Datum:
    """One datum. sizes: of each dimension; values: attributes of each element by its number, the last dimension first,
    with neutral names; father: name and number of the frame or tool that points, frames and tools are given in (empty:
    world or flange); start, end: its place."""

    name: str
    kind: str
    sizes: tuple[int, ...]
    values: Mapping[int, Mapping[str, str]] = field(default_factory=dict)
    father: tuple[str, int] = ("", 0)
    start: int = 0
    end: int = 0

    @property
    def size(self) -> int:
        """How many elements there are."""
        return prod(self.sizes)


def data_of(source: Source) -> Iterator[Datum]:
    """The data of a file, in its order. Raises ParseError for a file that is no XML."""
    root = Xml.fromstring(source.text.lstrip("\ufeff"))
    at = 0
    for element in root.iter():
        tag = _tag(element)
        if tag == "Data" and element.get("name") is not None:
            made = _new(element)
        elif tag in _OLD and element.get("name") is not None:
            made = _old(element, tag)
        else:
            continue
        start = source.text.find(f'name="{made.name}"', at)
        start = source.text.rfind("<", 0, start) if start >= 0 else at
        at = max(at, start + 1)
        end = _end(source.text, tag, start)
        yield replace(made, start=start, end=end if end > start else start)


def _end(text: str, tag: str, start: int) -> int:
    """Where the element ends that starts there: with its values, where it has some."""
    head = text.find(">", start)
    if head < 0 or text[head - 1] == "/":
        return head + 1
    close = text.find(f"</{tag}>", head)
    return close + len(tag) + 3 if close >= 0 else text.find("\n", start)


_OLD = frozenset(
    (
        *("bool", "num", "string", "trsf", "frame", "tool", "point", "pointRs", "joint", "jointRs", "config"),
        *("configRs", "mdesc", "dio", "aio", "sio"),
    )
)


def _tag(element: Xml.Element) -> str:
    return element.tag.rpartition("}")[2]


def _father(text: str) -> tuple[str, int]:
    found = _FATHER.match(text.strip())
    if found is None or found[1] in ("world", "flange"):
        return ("", 0)
    return found[1], int(found[2] or 0)


def _new(element: Xml.Element) -> Datum:
    """`<Data name type size="n" or "n,m"><Value key="0" or "0,0" .../></Data>`."""
    sizes = tuple(int(part) for part in re.findall(r"\d+", element.get("size", "1"))) or (1,)
    values: dict[int, Mapping[str, str]] = {}
    father = ("", 0)
    for value in element:
        key = value.get("key", "0").split(",")
        if _tag(value) == "Value" and all(part.strip().isdigit() for part in key):
            given = {_MDESC.get(name, name): text for name, text in value.attrib.items()}
            given["link"] = given.pop("ioLink", given.get("link", ""))
            values[_number(tuple(map(int, key)), sizes)] = given
            father = _father(given.get("fatherId", "")) if father[0] == "" else father
    word = element.get("type", "")
    return Datum(element.get("name", ""), KINDS.get(word, word), sizes, values, father)


def _number(key: tuple[int, ...], sizes: tuple[int, ...]) -> int:
    """Which element a key names, counted with the last dimension first; a single number is that already."""
    if len(key) != len(sizes):
        return key[0]
    at = 0
    for part, size in zip(key, sizes, strict=True):
        at = at * size + part
    return at


def _old(element: Xml.Element, tag: str) -> Datum:
    """`<point name><pFather name/><valuePoint index="0"><tpValue .../><cpValue .../></valuePoint></point>`."""
    values: dict[int, Mapping[str, str]] = {}
    father = ("", 0)
    for child in element:
        if _tag(child).endswith("Father"):
            name = child.get("name", "")
            father = ("", 0) if name in ("", "world", "flange") else (name, int(child.get("fatherIndex", "0")))
        elif _tag(child).startswith("value"):
            given = {_MDESC.get(name, name): text for name, text in child.attrib.items()}
            for part in child:
                names = {"name": "link"} if _tag(part) == "io" else {}
                given.update({names.get(_MDESC.get(n, n), _MDESC.get(n, n)): text for n, text in part.attrib.items()})
            values[int(child.get("index", "0"))] = given
    size = element.get("size", "")
    count = int(size) if size.isdigit() else max((*values, 0)) + 1
    return Datum(element.get("name", ""), KINDS.get(tag, tag), (count,), values, father)
