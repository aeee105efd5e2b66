"""What has to be on the controller beside the modules: the signals, as lines of its I/O configuration (EIO.cfg).

Without a device a signal is a virtual one: the configuration loads, the program runs, and whoever wires the cell adds
-Device and -DeviceMap. Form of the file: technical reference, system parameters, topic I/O System, type Signal.
"""

from __future__ import annotations

from collections.abc import Mapping

from rpl import ir
from rpl.ir.standing import Standing
from rpl.passes.legalise.kinds import walk_for
from rpl.writing.target import OutputFile

from .tables import PREFIXES

_HEADER = "EIO:CFG_1.0:6:0::\n#\nEIO_SIGNAL:\n"
_KINDS = tuple(PREFIXES)


def setup(program: ir.Program, there: Standing, numbers: Mapping[tuple[str, int], str]) -> list[OutputFile]:
    """The configuration with the signals of the program that are not `there` already; none: no file. numbers: (kind,
    number) of the source -> name of a signal, which its label says."""
    used: dict[tuple[int, str], str] = {}
    for node in walk_for({"Signal"}, *program.modules):
        if isinstance(node, ir.Signal) and node.name is not None and node.name.lower() not in there.names:
            used.setdefault((_KINDS.index(node.kind), node.name.lower()), node.name)
    if not used:
        return []
    labels = {name.lower(): f"{kind.replace('_', ' ')} {number}" for (kind, number), name in numbers.items()}
    lines = [_line(_KINDS[at], name, labels.get(folded, "")) for (at, folded), name in sorted(used.items())]
    return [OutputFile("EIO.cfg", (_HEADER + "".join(lines)).encode("latin-1", "replace"))]


def _line(kind: str, name: str, label: str) -> str:
    told = f' -Label "{label}"' if label else ""
    return f'\n      -Name "{name}" -SignalType "{PREFIXES[kind].upper()}"{told}\n'
