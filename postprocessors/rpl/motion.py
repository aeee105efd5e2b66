"""Moves, triggers and spline heads as RPL writes them: clauses in one fixed order."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from rpl import ir
from rpl.ir import words

from .expressions import expression_text, name_text, place_text, value_text

ActionText = Callable[[ir.Statement], str]
_RELATIVES = {relative: word.upper() for word, relative in words.RELATIVE_WORDS.items()}


def move_text(move: ir.Move, action: ActionText) -> str:
    """A move on one line."""
    parts = ["MOVE"]
    if move.kind != "joint":
        parts.append(move.kind.upper())
    if move.via is not None:
        parts.append(f"VIA {expression_text(move.via)}")
    parts.append(f"{'TO' if move.relative is None else 'BY'} {expression_text(move.target)}")
    if move.relative is not None and move.relative != "base":
        parts.append(_RELATIVES[move.relative])
    parts.extend(_valued(("ANGLE", move.swept)))
    parts.extend(speed_clauses(move.speed))
    parts.extend(_valued(("ACCELERATION", move.acceleration)))
    parts.extend(blend_clauses(move.blend))
    parts.extend(_valued(("TOOL", move.tool), ("FRAME", move.frame), ("LOAD", move.load)))
    parts.extend(
        f"{word} {name_text(mode)}"
        for word, mode in (
            ("ORIENTATION", move.orientation),
            ("CIRCLE ORIENTATION", move.circle_orientation),
            ("CONFIGURATION", move.configuration),
            ("CLASS", None if move.motion_class == "classic" else move.motion_class),
        )
        if mode is not None
    )
    parts.extend(with_clause(move.settings))
    if move.search is not None:
        parts.append(_search(move.search))
    if move.concurrent:
        parts.append("CONCURRENT")
    if move.without_offsets:
        parts.append("WITHOUT OFFSETS")
    if move.group != 1:
        parts.append(f"GROUP {move.group}")
    parts.extend(_valued(("IDENTITY", move.identity)))
    for trigger in move.triggers:
        if isinstance(trigger, ir.Trigger):
            parts.append(trigger_text(trigger, action))
        else:
            parts.append(f"TRIGGER {expression_text(trigger)}")
    return " ".join(parts)


def _valued(*clauses: tuple[str, ir.Expression | None]) -> Iterator[str]:
    return (f"{word} {expression_text(value)}" for word, value in clauses if value is not None)


def speed_clauses(speed: ir.Speed | None) -> Iterator[str]:
    """The clauses of a speed; an empty one is said too."""
    if speed is None:
        return
    if speed == ir.Speed():
        yield "DEFAULT SPEED"
    yield from _valued(
        ("PROFILE", speed.profile),
        ("SPEED", speed.path),
        ("REORIENT", speed.rotation),
        ("JOINT SPEED", speed.joint),
        ("AXIS SPEED", speed.axis),
        ("PATH ACCELERATION", speed.path_acceleration),
        ("AXIS ACCELERATION", speed.axis_acceleration),
        ("DURATION", speed.duration),
    )


def blend_clauses(blend: ir.Blend | None, prefix: str = "") -> Iterator[str]:
    """The clauses of a blend; `prefix` for the blend on the path that goes with one by percentage."""
    match blend:
        case ir.BlendStop():
            yield "FINE"
        case ir.BlendDistance(distance=None, rotation=None):
            yield f"{prefix}MODAL BLEND"
        case ir.BlendDistance(distance=distance, rotation=rotation):
            yield from _valued((f"{prefix}BLEND", distance), (f"{prefix}BLEND ROTATION", rotation))
        case ir.BlendSpeed(percent=percent):
            yield f"{prefix}BLEND AT SPEED {expression_text(percent)}"
        case ir.BlendPercent(percent=percent, path=path):
            yield f"BLEND PERCENT {expression_text(percent)}"
            yield from blend_clauses(path, "PATH ")
        case ir.BlendLevel(level=level):
            yield f"BLEND AT LEVEL {expression_text(level)}"
        case ir.BlendZone(zone=zone, distance=distance, in_position=in_position):
            yield from _valued(("ZONE", zone), ("RADIUS", distance), ("SETTLED", in_position))


def with_clause(settings: tuple[tuple[ir.Expression, ir.Expression], ...]) -> Iterator[str]:
    if settings:
        yield "WITH " + ", ".join(f"{place_text(target)} = {value_text(value)}" for target, value in settings)


def _search(search: ir.Search) -> str:
    text = f"SEARCH {expression_text(search.condition)}"
    if search.found is not None:
        text += f" INTO {place_text(search.found)}"
    if search.hit is not None:
        text += f" HIT {place_text(search.hit)}"
    if search.stop != "none":
        text += f" STOPPING {name_text(search.stop)}"
    if search.edge != "rising":
        text += f" EDGE {name_text(search.edge)}"
    return text


def trigger_text(trigger: ir.Trigger, action: ActionText) -> str:
    return f"TRIGGER {_trigger(trigger, None, action)}"


def path_rule_text(rule: ir.PathRule) -> str:
    value = f" AT {expression_text(rule.value)}" if rule.value is not None else ""
    return f"PATH RULE {name_text(rule.rule)}{value}{' BEHIND START' if rule.reference == 'start' else ''}"


def define_trigger_text(statement: ir.DefineTrigger, action: ActionText) -> str:
    inner = _trigger(statement.trigger, statement.interrupt, action)
    return f"DEFINE TRIGGER {place_text(statement.target)} {inner}"


def _trigger(trigger: ir.Trigger, interrupt: ir.Expression | None, action: ActionText) -> str:
    clauses = _valued(
        ("DISTANCE", trigger.distance),
        ("DELAY", trigger.delay),
        ("PRIORITY", trigger.priority),
        ("INTERRUPT", interrupt),
    )
    return " ".join([f"AT {name_text(trigger.reference)}", *clauses, f"DO {action(trigger.action)}"])


def move_external_text(move: ir.MoveExternal) -> str:
    target = expression_text(move.target)
    return " ".join([f"MOVE EXTERNAL TO {target}", *speed_clauses(move.speed), *blend_clauses(move.blend)])


def spline_head_text(spline: ir.Spline) -> str:
    kind = [] if spline.kind == "path" else [spline.kind.upper()]
    return " ".join(["SPLINE", *kind, *blend_clauses(spline.blend), *with_clause(spline.settings)])
