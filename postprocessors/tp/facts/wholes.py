"""Position registers that only moves look at. Such a register may hold joints in place of a pose: the controller goes
to the same place. An element, a sum or a frame of it would be another value; TP has no kinematics to convert it.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.kinds import walk_for

from .. import tables

_SAME_PLACE = frozenset(("joints_to_target", "target_to_joints"))


def moved_to_only(program: ir.Program) -> frozenset[int]:
    """Numbers of registers that are only copied and moved to, as a whole; none where numbers are computed."""
    parts: set[int] = set()
    seen: set[int] = set()
    copies: dict[int, set[int]] = {}
    for node in walk_for({"Index", "Name", "Assign", "Field", "Builtin", "Binary", "Move"}, program):
        match node:
            case ir.Index(base=ir.Name(id="PR"), indices=(index,)) if not isinstance(index, ir.IntLiteral):
                return frozenset()
            case ir.Assign(target=target, value=value):
                to, source = _number(target), _number(_bare(value))
                if to is not None and source is not None:
                    copies.setdefault(source, set()).add(to)
                elif source is not None:
                    parts.add(source)  # a tool or a frame
            case ir.Field(base=base):
                parts |= _numbers(base)
            case ir.Builtin(function=function, arguments=arguments) if function not in _SAME_PLACE:
                parts |= {number for one in arguments for number in _numbers(one)}
            case ir.Binary(left=left, right=right):
                parts |= _numbers(left) | _numbers(right)
            case ir.Move(tool=tool, frame=frame):
                parts |= _numbers(tool) | _numbers(frame)
        if isinstance(node, ir.Index | ir.Name):
            seen |= _numbers(node)
    while more := {source for source, to in copies.items() if source not in parts and to & parts}:
        parts |= more
    return frozenset(seen - parts)


def _bare(value: ir.Expression) -> ir.Expression:
    match value:
        case ir.Builtin(function=function, arguments=(inner, *_)) if function in _SAME_PLACE:
            return _bare(inner)
    return value


def _numbers(value: ir.Expression | None) -> set[int]:
    number = None if value is None else _number(value)
    return set() if number is None else {number}


def _number(value: ir.Expression) -> int | None:
    """The number of a position register."""
    match value:
        case ir.Index(base=ir.Name(id=tables.PR.name), indices=(ir.IntLiteral(value=number),)):
            return number
        case ir.Name(id=name) if name[:2] == tables.PR.name and name[2:].isdigit():
            return int(name[2:])
    return None


__all__ = ["moved_to_only"]
