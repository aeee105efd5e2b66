"""Values of constant tools and user frames, as the files TOOL.CND and UFRAME.CND that a controller loads beside jobs.

Layouts as `dialects/inform/dumps.py` has them; a tool without data of its load has its centre of gravity and its weight
at zero, as a controller writes them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from rpl.writing.target import OutputFile

from . import tables
from .cell import Cell
from .places import Values
from .texts import ascii_text, fixed

_LONGEST_NAME = 16  # M
_NO_LOAD = ("0.000,0.000,0.000", "0.000", "0.000,0.000,0.000")  # centre of gravity, weight, inertia


def condition_files(cell: Cell, names: Mapping[str, str]) -> list[OutputFile]:
    """The files that the program needs; none when it has no constant tool or frame that the controller has not.
    `names`: the source's, by bank and number."""
    made = (("TOOL.CND", tables.TL, _tool), ("UFRAME.CND", tables.UF, _frame))
    files = []
    for file, bank, say in made:
        lines = [line for n, one in cell.conditions(bank).items() for line in say(n, names.get(f"{bank}{n}", ""), one)]
        if lines:
            files.append(OutputFile(file, "\r\n".join((*lines, "")).encode("ascii")))
    return files


def _tool(number: int, name: str, value: Values) -> Iterator[str]:
    yield from (f"//TOOL {number}", _name(name), _shown(value), *_NO_LOAD)


def _frame(number: int, name: str, value: Values) -> Iterator[str]:
    yield from (f"//UFRAME {number}", _name(name), "///TOOL 0", f"////BUSER {_shown(value)}")


def _name(name: str) -> str:
    return f"///NAME {ascii_text(name).upper()[:_LONGEST_NAME].strip()}".rstrip()


def _shown(value: Iterable[float]) -> str:
    x, y, z, a, b, c = value
    return ",".join((*(fixed(one, 3) for one in (x, y, z)), *(fixed(one, 4) for one in (c, b, a))))
