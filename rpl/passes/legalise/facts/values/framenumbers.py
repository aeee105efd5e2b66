"""Tools and user frames by the numbers of a controller's tables: which data has which number, and its value.

Data that nothing assigns and that stands as a tool or frame gets a number of its own: the one that an earlier
translation gave, the one under which the controller has it, the one that its name says, else the next that is free.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context
from rpl.passes.scope import Scope
from rpl.passes.values import pose_of

_NO_NAME = "frame"  # how a literal is called
_DIGITS = re.compile(r"(\d+)\D*\Z")

# Data as a program says it, and which declarations its names mean there.
Key = tuple[ir.Expression, tuple[int, ...]]
# Kind (`tool`, `base`) -> the controller's bank and its last number.
Banks = Mapping[str, tuple[str, int]]
Element = tuple[str, int]  # folded name of a table, index


@dataclass(slots=True)
class Table:
    """The numbers of one kind: those of data, and the value behind each."""

    bank: str
    most: int
    numbers: dict[Key, int] = field(default_factory=dict)
    values: dict[int, rigid.Pose] = field(default_factory=dict)

    def number(self, value: ir.Expression, scope: Scope) -> int | None:
        return self.numbers.get(key_of(value, scope))

    def element(self, number: int) -> ir.Index:
        """What stands for a number: `UFRAME[2]`."""
        return ir.Index(ir.Name(self.bank), (ir.IntLiteral(number),))

    def declaration(self) -> ir.Variable:
        """The controller's table. Its values come behind it, where it is not taken for data that the program sets."""
        type = ir.ArrayType(ir.PoseType(), (ir.IntLiteral(self.most),), 1)
        return ir.Variable(self.bank, type, storage="persistent", scope="global")

    def initials(self) -> list[ir.Initialise]:
        return [ir.Initialise(ir.Assign(self.element(number), _pose(pose))) for number, pose in self.values.items()]


def tables_of(
    uses: Iterable[tuple[str, ir.Expression, Scope]], banks: Banks, unchanged: Unchanged, context: Context
) -> dict[str, Table]:
    """The numbers of tools and frames, in the order in which the program uses them (kind, what it says, where). Frame 0
    is the world."""
    found: dict[str, dict[Key, rigid.Pose]] = {name: {} for name in banks}
    changing: dict[str, set[Key]] = {name: set() for name in banks}
    world: set[Key] = set()
    for name, value, scope in uses:
        if is_none(value):
            continue
        pose = pose_of(constant(value, scope, unchanged)) if is_shared(value, scope) else None
        if pose == rigid.IDENTITY and name == "base" and names_in(value) & unchanged.assigned:
            world.add(key_of(value, scope))
        elif pose is None:
            changing[name].add(key_of(value, scope))
        else:
            found[name][key_of(value, scope)] = pose
    made = {name: _numbered(banks[name], found[name], len(changing[name]), context) for name in banks}
    made["base"].numbers.update(dict.fromkeys(world, 0))
    return made


def _numbered(bank: tuple[str, int], found: Mapping[Key, rigid.Pose], changing: int, context: Context) -> Table:
    """`changing`: as many numbers are left for what the run decides, and one for the flange."""
    name, most = bank
    earlier = {label: number for (kind, number), label in context.registers.items() if kind == name}
    there = context.there
    mine = {number for kind, number in context.registers if kind == name}
    in_use = there.of(name) - mine
    wanted = {
        key: earlier.get(label_of(key) or _NO_NAME) or there.like(name, _values(pose)) or own_number(key)
        for key, pose in found.items()
    }
    table = Table(name, most)
    for key in sorted(found, key=lambda one: not wanted[one]):
        if len(table.values) >= most - 1 - changing:
            break
        own = wanted[key] not in in_use or there.like(name, _values(found[key])) == wanted[key]
        others = (number for number in range(1, most + 1) if number not in in_use)
        free = (number for number in (wanted[key] if own else 0, *others) if number and number not in table.values)
        number = next((one for one in free if one <= most), 0)
        if not number:
            break
        table.numbers[key], table.values[number] = number, found[key]
        context.register_names[name, number] = label_of(key) or _NO_NAME
    return table


def label_of(key: Key) -> str:
    """The datum's name; an element with its index; empty: a literal."""
    names = [node.id for node in walk(key[0]) if isinstance(node, ir.Name)]
    indices = [str(node.value) for node in walk(key[0]) if isinstance(node, ir.IntLiteral)]
    return "".join((*names[:1], *indices)) if names else ""


def own_number(key: Key) -> int:
    """The number that its name ends with, or its index in a table of the source; 0: it says none."""
    found = _DIGITS.search(label_of(key))
    return int(found[1]) if found and key[1] else 0


def is_none(value: ir.Expression) -> bool:
    return isinstance(value, ir.System) and value.name in ("null_frame", "world")


def key_of(value: ir.Expression, scope: Scope) -> Key:
    symbols = [scope.value(node.id) for node in walk(value) if isinstance(node, ir.Name)]
    return value, tuple(0 if one is None else id(one.declaration) for one in symbols)


def names_in(value: ir.Expression) -> set[str]:
    return {node.id.lower() for node in walk(value) if isinstance(node, ir.Name)}


def is_shared(value: ir.Expression, scope: Scope) -> bool:
    """Is it of the whole program, not of a routine?"""
    symbols = [scope.value(node.id) for node in walk(value) if isinstance(node, ir.Name)]
    return all(one is not None and one.routine is None for one in symbols)


def _values(pose: rigid.Pose) -> tuple[float, ...]:
    place = pose.position
    return (place.x, place.y, place.z, *pose.rotation.zyx)


def _pose(pose: rigid.Pose) -> ir.Aggregate:
    parts = zip(ir.POSE, _values(pose), strict=True)
    return ir.Aggregate(tuple((part, ir.RealLiteral(value + 0.0)) for part, value in parts), type_name="pose")


def element_of(place: object) -> Element | None:
    """The element of a table that is said by a number."""
    match place:
        case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=at),)):
            return name.lower(), at
    return None


def said_numbers(nodes: Iterable[object]) -> dict[Element, int]:
    """The number by which the program calls an element where it selects it, if it notes that one just before:
    UFRAME_NUM=0 goes with the first element of UFRAME."""
    found: dict[Element, int] = {}
    noted: tuple[str, int] | None = None
    for node in nodes:
        match node:
            case ir.Assign(target=ir.Name(id=name), value=ir.IntLiteral(value=number)):
                noted = name.lower(), number
            case ir.Assign(target=ir.System(name="tool" | "base"), value=value):
                element = element_of(value)
                if element is not None and noted is not None and noted[0].startswith(element[0]):
                    found[element] = noted[1]
                noted = None
    return found
