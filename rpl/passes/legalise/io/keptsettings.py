"""Settings of the motion that a program reads back, for targets that have no word to ask for them: accelerations,
turning speeds, speeds of single axes, the look-ahead, the frame in force. A variable keeps what was set last.

Before the first setting it holds what the source's controller starts with. A setting of single axes is an array.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping

from rpl import ir
from rpl.passes.capabilities import SettingRule
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.shadows import NO_SHIFT, Shadow, with_shadows
from rpl.passes.legalise.stages import legalising

_SINGLE = frozenset(
    ("path_acceleration", "swivel_speed", "twist_speed", "swivel_acceleration", "twist_acceleration", "advance")
)
_OF_AXES = frozenset(("joint_speed", "joint_acceleration", "external_speed", "external_acceleration"))
_FRAME = "base"


@legalising(unless=lambda context: context.capabilities.carries_rules, sees=("System",))
def kept_settings(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that do not carry the source's settings, and for the settings that a program reads."""
    can = context.capabilities
    nodes = list(walk_for({"Assign", "Move", "System"}, *program.modules))
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
    defaults = rules_of(context.source).system_defaults
    return with_shadows(program, context, {name: _shadow(name, context, defaults) for name in sorted(wanted)})


def _shadow(name: str, context: Context, defaults: Mapping[str, object]) -> Shadow:
    """The variable of a setting, which begins as the source's controller does."""
    given = defaults.get(name)
    first = ir.RealLiteral(float(given) if isinstance(given, int | float) else 0.0)
    variable = ir.Name(context.fresh(f"rpl_{name}"))
    return Shadow(variable, NO_SHIFT if name == _FRAME else first, of_axes=name in _OF_AXES)


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


__all__ = ["kept_settings"]
