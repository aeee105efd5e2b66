"""Bases on external kinematics: `$BASE=EK(ROOT,TYPE,OFFSET)` puts the offset frame on a mechanism.

TYPE names the kinematics (#EASYS, #EBSYS .. #EFSYS, #NONE: a base in the room); under this name a robot or cell file
describes the mechanism. ROOT is where its root stands in the world. Where ROOT is read from the machine data
(MACHINE_DEF, EX_AX_DATA, K_ROOT of the inline forms), it is that file's business and not the program's.
"""

from __future__ import annotations

from rpl import ir
from rpl.source import Origin

_COUPLES = "ek"
_ARGUMENTS = 3
_MACHINE_DATA = ("machine_def", "ex_ax_data")
_MACHINE_ROOT = "k_root"


def coupled_base(call: ir.Call, origin: Origin) -> list[tuple[ir.Expression, ir.Expression]] | None:
    """The settings that a call of EK assigned to $BASE stands for; None for another function."""
    if call.name.lower() != _COUPLES or len(call.arguments) != _ARGUMENTS:
        return None
    given = [argument.value for argument in call.arguments]
    if any(one is None for one in given):
        return None
    root, unit, offset = (one for one in given if one is not None)
    found: list[tuple[ir.Expression, ir.Expression]] = [
        (ir.System("base", origin=origin), offset),
        (ir.System("base_unit", origin=origin), _name(unit)),
    ]
    if not _is_machine_data(root):
        found.append((ir.System("base_root", origin=origin), root))
    return found


def _name(unit: ir.Expression) -> ir.Expression:
    """A member of ESYS as the name that it is."""
    return ir.TextLiteral(unit.member, origin=unit.origin) if isinstance(unit, ir.EnumLiteral) else unit


def _is_machine_data(root: ir.Expression) -> bool:
    match root:
        case ir.Call(name=name):
            return name.lower() == _MACHINE_ROOT
        case ir.Field(base=base) | ir.Index(base=base):
            return _is_machine_data(base)
        case ir.Name(id=name):
            return name.lower() in _MACHINE_DATA
    return False
