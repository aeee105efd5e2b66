"""What a URScript value can be, before it becomes a type of the IR. Kinds only grow together: a name that gets 1 and
1.5 is a real number, a list of changing length has no fixed length.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rpl import ir


@dataclass(frozen=True, slots=True)
class Kind:
    """word: bool int real text pose list struct thread handle. A list has the kind of its elements and, where it never
    changes, its length; `joints`: six angles that come from or go to the arm. threads: what a handle may stand for."""

    word: str
    element: Kind | None = None
    length: int | None = None
    joints: bool = False
    fields: tuple[tuple[str, Kind | None], ...] = ()
    threads: frozenset[str] = frozenset()


BOOL, INT, REAL, TEXT, POSE, HANDLE = (Kind(word) for word in ("bool", "int", "real", "text", "pose", "handle"))
LIST = Kind("list")
JOINTS = Kind("list", REAL, 6, joints=True)


def list_of(element: Kind | None, length: int | None) -> Kind:
    return Kind("list", element, length)


def is_number(kind: Kind | None) -> bool:
    return kind is not None and kind.word in ("int", "real")


def is_joints(kind: Kind | None) -> bool:
    """Six numbers, so possibly a place of the arm."""
    if kind is None or kind.word != "list" or kind.length != 6:
        return False
    return kind.element is None or is_number(kind.element)


def joined(one: Kind | None, other: Kind | None) -> tuple[Kind | None, bool]:
    """The kind that holds both, and whether there is one; otherwise the first stays."""
    if one is None or other is None or one == other:
        return (other if one is None else one), True
    words = {one.word, other.word}
    if words == {"int", "real"}:
        return REAL, True
    if words == {"thread", "int"}:
        return (one if one.word == "thread" else other), True
    if len(words) > 1:
        return one, False
    if one.word == "thread":
        return replace(one, threads=one.threads | other.threads), True
    if one.word == "list":
        element, fits = joined(one.element, other.element)
        length = one.length if one.length == other.length else None
        if one == LIST or other == LIST:
            length = other.length if one == LIST else one.length
        return Kind("list", element, length, one.joints or other.joints), fits
    if one.word == "struct":
        return _joined_structs(one, other)
    return one, True


def _joined_structs(one: Kind, other: Kind) -> tuple[Kind, bool]:
    if [name for name, _ in one.fields] != [name for name, _ in other.fields]:
        return one, False
    pairs = [(name, joined(kind, other.fields[place][1])) for place, (name, kind) in enumerate(one.fields)]
    return replace(one, fields=tuple((name, kind) for name, (kind, _) in pairs)), all(fits for _, (_, fits) in pairs)


def field_kind(kind: Kind, name: str) -> Kind | None:
    return dict(kind.fields).get(name)


def word_of(kind: Kind | None) -> str:
    """The kind in words, for reports."""
    if kind is None:
        return "an unknown value"
    names = {"int": "a whole number", "real": "a number", "text": "a string", "struct": "a struct"}
    return names.get(kind.word, f"a {kind.word}")


def type_of(kind: Kind | None, records: dict[tuple[str, ...], str]) -> ir.Type:
    """The IR's type. `records`: names of the structs by their members. What nothing tells is taken for a number."""
    if kind is None:
        return ir.RealType()
    match kind.word:
        case "bool":
            return ir.BoolType()
        case "int" | "thread":
            return ir.IntType()
        case "text":
            return ir.StringType()
        case "pose":
            return ir.PoseType()
        case "list":
            bounds: list[ir.Expression | None] = []
            inner: Kind | None = kind
            while inner is not None and inner.word == "list":
                bounds.append(ir.IntLiteral(inner.length - 1) if inner.length is not None else None)
                inner = inner.element
            return ir.ArrayType(type_of(inner, records), tuple(bounds), 0)
        case "struct":
            return ir.NamedType(records[tuple(name for name, _ in kind.fields)])
        case "handle":
            return ir.VendorType("urscript", "handle")
    return ir.RealType()
