"""Settings of the motion that a program reads back, for targets that have no word to ask for them: accelerations,
turning speeds, speeds of single axes, the look-ahead, the frame in force. A variable keeps what was set last.

Before the first setting it holds what the source's controller starts with. A setting of single axes is an array.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

from rpl import ir, registry
from rpl.ir.walk import walk
from rpl.passes.capabilities import SettingRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_bodies, expansion, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

_SINGLE = frozenset(
    ("path_acceleration", "swivel_speed", "twist_speed", "swivel_acceleration", "twist_acceleration", "advance")
)
_OF_AXES = frozenset(("joint_speed", "joint_acceleration", "external_speed", "external_acceleration"))
_AXES = 6
_FRAME = "base"


@legalising(unless=lambda context: context.capabilities.carries_rules, sees=("System",))
def kept_settings(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that do not carry the source's settings, and for the settings that a program reads."""
    can = context.capabilities
    nodes = list(walk(*program.modules))
    asked = Counter(node.name for node in nodes if isinstance(node, ir.System))
    asked.subtract(
        node.target.name for node in nodes if isinstance(node, ir.Assign) and isinstance(node.target, ir.System)
    )
    read = {name for name in _SINGLE | _OF_AXES | {_FRAME} if asked[name] > 0}
    told = {name for move in nodes if isinstance(move, ir.Move) for name in _named(move)}
    wanted = {name for name in read if name not in can.system_variables and name not in told}
    wanted -= {name for name in wanted & _OF_AXES if _as_a_whole(nodes, name)}
    if SettingRule.ASKED_FRAME not in can.settings.rules and _FRAME in read and _FRAME not in told:
        wanted.add(_FRAME)
    if not wanted:
        return program
    kept = {name: context.fresh(f"rpl_{name}") for name in sorted(wanted)}
    modules = tuple(_Keeper(kept).module(module) for module in program.modules)
    data = tuple(_data(program, kept))
    first = modules[0]
    home = ir.Module(context.fresh("rpl_settings"), first.dialect, data, task=first.task, public=True)
    return replace(program, modules=(*modules, home))


class _Keeper:
    """Puts the variables beside the settings. `kept`: the variable of each setting."""

    def __init__(self, kept: dict[str, str]) -> None:
        self.kept = kept

    def module(self, module: ir.Module) -> ir.Module:
        routines = tuple(edit_bodies(one, lambda body: map_body(body, self.change)) for one in module.routines)
        return replace(module, routines=routines)

    def place(self, setting: ir.System) -> ir.Expression:
        name = ir.Name(self.kept[setting.name], origin=setting.origin)
        if setting.name not in _OF_AXES:
            return name
        return ir.Index(name, tuple(self.value(index) for index in setting.indices), origin=setting.origin)

    def value(self, expression: ir.Expression) -> ir.Expression:
        if isinstance(expression, ir.System) and expression.name in self.kept:
            return self.place(expression)
        return rewrite_parts(expression, self.value)

    def change(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Assign) and isinstance(statement.target, ir.System):
            target, given = statement.target, self.value(statement.value)
            target = replace(target, indices=tuple(self.value(index) for index in target.indices))
            if target.name in self.kept:
                place = self.place(statement.target)
                simple = not any(isinstance(node, ir.Call) or _is(node, place) for node in walk(given))
                setting = replace(statement, target=target, value=given if simple else place)
                return expansion(statement.origin, (ir.Assign(place, _in_base_units(given)), setting))
            return (replace(statement, target=target, value=given),)
        return (rewrite_parts(statement, self.value, lambda body: map_body(body, self.change)),)


def _is(node: object, place: ir.Expression) -> bool:
    """Is this the variable that has just been set? A value that reads it may be worked out only once."""
    variable = place.base if isinstance(place, ir.Index) else place
    return isinstance(node, ir.Name) and node == variable


def _in_base_units(value: ir.Expression) -> ir.Expression:
    """A quantity as the plain number that the variable keeps."""
    if not isinstance(value, ir.Quantity):
        return value
    return ir.Binary("*", value.value, ir.RealLiteral(ir.UNITS[value.unit]), origin=value.origin)


def _named(move: ir.Move) -> Iterator[str]:
    """Settings that a move names itself: they are read where it says so."""
    if move.frame is not None:
        yield _FRAME
    for place, _ in move.settings:
        if isinstance(place, ir.System):
            yield place.name


def _as_a_whole(nodes: list[object], name: str) -> bool:
    """Is a setting of axes set or read for all axes together somewhere?"""
    return any(isinstance(node, ir.System) and node.name == name and len(node.indices) != 1 for node in nodes)


def _data(program: ir.Program, kept: dict[str, str]) -> Iterator[ir.Variable]:
    defaults = registry.dialect(program.modules[0].dialect).rules().system_defaults
    for name, variable in kept.items():
        given = defaults.get(name)
        start = float(given) if isinstance(given, int | float) else 0.0
        number: ir.Expression = ir.RealLiteral(start)
        type: ir.Type = ir.RealType()
        if name == _FRAME:
            type, number = ir.PoseType(), ir.Aggregate(tuple((part, ir.RealLiteral(0.0)) for part in ir.POSE))
        elif name in _OF_AXES:
            type = ir.ArrayType(ir.RealType(), (ir.IntLiteral(_AXES),))
            number = ir.Aggregate(((None, number),) * _AXES)
        yield ir.Variable(variable, type, number, scope="global")


__all__ = ["kept_settings"]
