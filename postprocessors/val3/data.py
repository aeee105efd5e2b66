"""The data of the application that is written: what the program declares, and what movements need beside it.

A movement names a tool, a movement descriptor and a point that hangs on its frame. Where the program has only values,
data is made for them: one for each value, named after it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import product

from rpl.writing.text import number_text

from . import tables


@dataclass(slots=True)
class Datum:
    """One datum: its type, the attributes of each element as text (the last dimension first), and the frame or tool
    that it hangs on (`fatherId`; an element of a list with its number)."""

    name: str
    type: str
    values: list[str] = field(default_factory=list)
    sizes: tuple[int, ...] = (1,)
    father: str = ""

    @property
    def count(self) -> str:
        return ",".join(map(str, self.sizes))

    @property
    def rows(self) -> list[tuple[str, str]]:
        """The key of each element and its attributes with its father."""
        frame = self.father if self.father.endswith("]") else f"{self.father}[0]"
        hung = f' fatherId="{frame}"' if self.father else ""
        values = self.values or ([""] if self.father else [])
        keys = (",".join(map(str, key)) for key in product(*map(range, self.sizes)))
        return [(key, f"{value}{hung}".strip()) for key, value in zip(keys, values, strict=False)]


class Store:
    """All data of one application. `taken`: names that the program has."""

    def __init__(self, taken: set[str]) -> None:
        self.taken = set(taken)
        self.data: dict[str, Datum] = {}
        self.made: dict[tuple[str, ...], str] = {}
        self.helpers: dict[tuple[str, ...], str] = {}
        self.unlinked: list[str] = []  # signals without a terminal
        self.lost: set[str] = set()  # names of the program that could not be declared
        self.unwritten: set[str] = set()  # routines whose parameters could not be declared

    def fresh(self, wish: str) -> str:
        """A name that nothing has, at most 15 signs long."""
        name, number = wish[: tables.LONGEST_NAME], 1
        while name in self.taken or name in tables.RESERVED:
            number += 1
            name = f"{wish[: tables.LONGEST_NAME - len(str(number))]}{number}"
        self.taken.add(name)
        return name

    def add(self, datum: Datum) -> None:
        self.data[datum.name] = datum

    def once(self, wish: str, type: str, value: str, father: str = "") -> str:
        """The name of a datum of this value, made where there is none."""
        key = (type, value, father)
        if key not in self.made:
            name = self.fresh(wish)
            self.made[key] = name
            self.add(Datum(name, type, [value] if value else [], father=father))
        return self.made[key]

    def helper(self, wish: str, type: str, father: str = "") -> str:
        """A datum that the program sets itself before it uses it: one for each purpose and father."""
        key = (wish, type, father)
        if key not in self.helpers:
            self.helpers[key] = self.fresh(wish)
            self.add(Datum(self.helpers[key], type, father=father))
        return self.helpers[key]

    def signal(self, name: str, kind: str) -> str:
        """A signal that the program names is declared. Which terminal it is only the cell knows: it is linked there."""
        if name not in self.data:
            self.taken.add(name)
            self.add(Datum(name, "dio" if kind.startswith("digital") else "aio"))
            self.unlinked.append(name)
        return name

    def descriptor(self, vel: float, tmax: float, blend: str, leave: float, strengths: tuple[float, float]) -> str:
        """A movement descriptor of these numbers."""
        size, limit = number_text(leave, 4), number_text(tmax, 4)
        share, (up, down) = number_text(vel, 4), (number_text(one, 4) for one in strengths)
        name = f"mJ{share}" if tmax >= UNLIMITED else f"mL{limit}"
        name = (name + (f"B{size}" if blend != "off" else "")).replace(".", "_")
        value = (
            f'accel="{up}" vel="{share}" decel="{down}" tmax="{limit}" rmax="{number_text(UNLIMITED)}" blend="{blend}"'
            f' leave="{size}" reach="{size}"'
        )
        return self.once(name, "mdesc", value)


UNLIMITED = 99999.0
