"""Where data that moves name is declared: at the head of the program's module, as people have it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir


def with_data(program: ir.Program, added: Sequence[ir.Declaration]) -> ir.Program:
    """Data of moves at the head of the program's module: of the first one with routines, among those of its first
    task."""
    task = program.modules[0].task
    home = next((one for one in program.modules if one.routines and one.task == task), program.modules[0])
    own = replace(home, declarations=(*added, *home.declarations))
    return replace(program, modules=tuple(own if one is home else one for one in program.modules))
