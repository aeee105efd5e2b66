"""Moves, spline blocks and triggers of RPL: parse tree to IR."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TypeVar

from rpl import ir
from rpl.ir import words
from rpl.reading.shapes import Slot, StatementError, SyntaxTree

from .expressions import Reading, expression, first, lvalue, names, tokens, trees, wording
from .statements import STATEMENTS, Lowering, action, options

Value = TypeVar("Value")

# Clause -> field of ir.Move; the rest of the valued clauses go into the speed or the blend.
_MOVE_FIELDS = {
    "angle": "swept",
    "tool": "tool",
    "frame": "frame",
    "load": "load",
    "acceleration": "acceleration",
    "identity": "identity",
}
_SPEED_FIELDS = {
    "profile": "profile",
    "speed": "path",
    "reorient": "rotation",
    "joint speed": "joint",
    "duration": "duration",
    "axis speed": "axis",
    "path acceleration": "path_acceleration",
    "axis acceleration": "axis_acceleration",
}
_MODES = {
    "orientation": "orientation",
    "circle orientation": "circle_orientation",
    "configuration": "configuration",
    "class": "motion_class",
}


@dataclass(slots=True)
class Settings:
    """The clauses of one motion statement, sorted by what they set: values, words and switches of the move."""

    values: dict[str, ir.Expression] = field(default_factory=dict)
    modes: dict[str, str] = field(default_factory=dict)
    switches: dict[str, bool] = field(default_factory=dict)
    group: dict[str, int] = field(default_factory=dict)
    search: dict[str, ir.Search] = field(default_factory=dict)
    speed: dict[str, ir.Expression] = field(default_factory=dict)
    blend: dict[str, ir.Expression | None] = field(default_factory=dict)
    path_blend: dict[str, ir.Expression | None] = field(default_factory=dict)
    triggers: list[ir.Expression | ir.Trigger] = field(default_factory=list)
    bindings: list[tuple[ir.Expression, ir.Expression]] = field(default_factory=list)
    default_speed: bool = False

    def speed_node(self) -> ir.Speed | None:
        return ir.Speed(**self.speed) if self.speed or self.default_speed else None

    def blend_node(self) -> ir.Blend | None:
        """The one blend that the clauses together say."""
        given = self.blend
        if not given:
            if self.path_blend:
                raise StatementError("PATH BLEND needs BLEND PERCENT before it", 0)
            return None
        kinds = {_blend_kind(word) for word in given}
        if len(kinds) > 1:
            raise StatementError("these blends exclude each other: " + ", ".join(word.upper() for word in given), 0)
        percent = given.get("blend percent")
        if percent is not None:
            path = _path_blend(self.path_blend)
            if path is None or isinstance(path, ir.BlendDistance | ir.BlendSpeed):
                return ir.BlendPercent(percent, path)
        zone = given.get("zone")
        if zone is not None:
            return ir.BlendZone(zone, given.get("radius"), given.get("settled"))
        level = given.get("blend at level")
        if level is not None:
            return ir.BlendLevel(level)
        if "fine" in given:
            return ir.BlendStop()
        return _path_blend(given)


def _blend_kind(word: str) -> str:
    if word in ("zone", "radius", "settled"):
        return "zone"
    return "distance" if word in ("blend", "blend rotation", "modal blend") else word


def _path_blend(given: dict[str, ir.Expression | None]) -> ir.BlendDistance | ir.BlendSpeed | None:
    if not given:
        return None
    percent = given.get("blend at speed")
    if percent is not None:
        return ir.BlendSpeed(percent)
    if "radius" in given or "settled" in given:
        raise StatementError("RADIUS and SETTLED need ZONE", 0)
    return ir.BlendDistance(given.get("blend"), given.get("blend rotation"))


def settings(parts: Iterable[SyntaxTree], at: Reading) -> Settings:
    """Sort the clauses of a motion statement."""
    found = Settings()
    for part in parts:
        _setting(part, found, at)
    return found


def _setting(part: SyntaxTree, found: Settings, at: Reading) -> None:
    match part.data:
        case "valued":
            _valued(wording(next(tokens(part, "SETTING"))), first(part, at), found)
        case "blend":
            _once(found.blend, "blend", first(part, at))
        case "modal_blend":
            word = wording(next(tokens(part, "MODAL_BLEND")))
            place = found.path_blend if word.startswith("path") else found.blend
            _once(place, "modal blend", None)
        case "mode":
            _once(found.modes, _MODES[wording(next(tokens(part, "MODE")))], names(part)[0])
        case "switch":
            _switch(wording(next(tokens(part, "MOVE_FLAG"))), found)
        case "group":
            number = next(child for child in part.children if isinstance(child, Slot))
            _once(found.group, "group", at.integer(number))
        case "with_":
            found.bindings.extend(_binding(binding, at) for binding in trees(part))
        case "stored_trigger":
            found.triggers.append(first(part, at))
        case "trigger":
            found.triggers.append(trigger(part, at))
        case "search":
            _once(found.search, "search", _search(part, at))


def _once(place: dict[str, Value], key: str, value: Value) -> None:
    if key in place:
        raise StatementError(f"{key.replace('_', ' ').upper()} is given twice", 0)
    place[key] = value


def _valued(word: str, value: ir.Expression, found: Settings) -> None:
    if word in _MOVE_FIELDS:
        _once(found.values, _MOVE_FIELDS[word], value)
    elif word in _SPEED_FIELDS:
        if _SPEED_FIELDS[word] in found.speed:
            raise StatementError(f"{word.upper()} is given twice", 0)
        found.speed[_SPEED_FIELDS[word]] = value
    elif word.startswith("path "):
        _once(found.path_blend, word.removeprefix("path "), value)
    else:
        _once(found.blend, word, value)


def _switch(word: str, found: Settings) -> None:
    if word == "fine":
        _once(found.blend, word, None)
    elif word == "default speed":
        found.default_speed = True
    else:
        _once(found.switches, word.replace(" ", "_"), True)


def _binding(tree: SyntaxTree, at: Reading) -> tuple[ir.Expression, ir.Expression]:
    target, value = trees(tree)
    return lvalue(target, at), expression(value, at)


def _search(tree: SyntaxTree, at: Reading) -> ir.Search:
    condition, *rest = trees(tree)
    given = options(rest)
    return ir.Search(
        expression(condition, at),
        lvalue(next(trees(given["into"])), at) if "into" in given else None,
        names(given["stopping"])[0] if "stopping" in given else "none",
        names(given["edge"])[0] if "edge" in given else "rising",
        lvalue(next(trees(given["hit"])), at) if "hit" in given else None,
    )


def trigger(tree: SyntaxTree, at: Reading) -> ir.Trigger:
    """A trigger with its action."""
    *rest, done = trees(tree)
    given = _trigger_settings(rest, at)
    if "interrupt" in given:
        raise StatementError("INTERRUPT belongs to DEFINE TRIGGER", 0)
    return _trigger(names(tree)[0], given, done, at)


def _trigger(reference: str, given: dict[str, ir.Expression], done: SyntaxTree, at: Reading) -> ir.Trigger:
    return ir.Trigger(
        reference.lower(),
        action(done, at),
        given.get("distance"),
        given.get("delay"),
        given.get("priority"),
        origin=at.origin,
    )


def _trigger_settings(parts: list[SyntaxTree], at: Reading) -> dict[str, ir.Expression]:
    given: dict[str, ir.Expression] = {}
    for part in parts:
        word = wording(next(tokens(part, "TRIGGER_SETTING")))
        if word in given:
            raise StatementError(f"{word.upper()} is given twice", 0)
        given[word] = first(part, at)
    return given


def _path_rule(tree: SyntaxTree, at: Reading) -> ir.PathRule:
    """How a spline block is driven from a place on."""
    value = next((expression(part, at) for part in trees(tree)), None)
    reference = "start" if next(tokens(tree, "BEHIND_START"), None) is not None else "end"
    return ir.PathRule(names(tree)[0].lower(), value, reference, origin=at.origin)


def _define_trigger(tree: SyntaxTree, at: Reading) -> ir.Statement:
    target, *rest, done = trees(tree)
    given = _trigger_settings(rest, at)
    inner = _trigger(names(tree)[0], given, done, at)
    return ir.DefineTrigger(lvalue(target, at), inner, given.get("interrupt"), origin=at.origin)


def _move(tree: SyntaxTree, at: Reading) -> ir.Statement:
    kind = next((wording(token) for token in tokens(tree, "MOVE_KIND")), "joint")
    via, destination, relative = None, None, None
    clauses = []
    for part in trees(tree):
        match part.data:
            case "via":
                via = first(part, at)
            case "to":
                destination = first(part, at)
            case "by":
                destination = first(part, at)
                frame = next((wording(token) for token in tokens(part, "IN_FRAME")), "in base")
                relative = words.RELATIVE_WORDS[frame]
            case _:
                clauses.append(part)
    found = settings(clauses, at)
    if destination is None:
        raise StatementError("MOVE needs TO or BY", 0)
    return ir.Move(
        kind,
        destination,
        via,
        relative=relative,
        speed=found.speed_node(),
        blend=found.blend_node(),
        triggers=tuple(found.triggers),
        settings=tuple(found.bindings),
        swept=found.values.get("swept"),
        tool=found.values.get("tool"),
        frame=found.values.get("frame"),
        load=found.values.get("load"),
        acceleration=found.values.get("acceleration"),
        identity=found.values.get("identity"),
        orientation=found.modes.get("orientation"),
        circle_orientation=found.modes.get("circle_orientation"),
        configuration=found.modes.get("configuration"),
        motion_class=found.modes.get("motion_class", "classic"),
        concurrent=found.switches.get("concurrent", False),
        without_offsets=found.switches.get("without_offsets", False),
        group=found.group.get("group", 1),
        search=found.search.get("search"),
        origin=at.origin,
    )


def _only(found: Settings, *allowed: str) -> None:
    """Refuse clauses that the statement has no place for."""
    given = {
        **dict.fromkeys((*found.values, *found.modes, *found.switches, *found.group, *found.search), True),
        **({"triggers": True} if found.triggers else {}),
        **({"with": True} if found.bindings else {}),
        **({"speed": True} if found.speed or found.default_speed else {}),
    }
    for name in given:
        if name not in allowed:
            raise StatementError(f"{name.replace('_', ' ').upper()} cannot stand here", 0)


def _move_external(tree: SyntaxTree, at: Reading) -> ir.Statement:
    target, *clauses = trees(tree)
    found = settings(clauses, at)
    _only(found, "speed")
    return ir.MoveExternal(expression(target, at), found.speed_node(), found.blend_node(), origin=at.origin)


def spline_head(tree: SyntaxTree, at: Reading) -> ir.Spline:
    """The first line of a spline block."""
    kind = next((wording(token) for token in tokens(tree, "PATH_KIND")), "path")
    found = settings(trees(tree), at)
    _only(found, "with")
    return ir.Spline(kind, (), found.blend_node(), tuple(found.bindings), origin=at.origin)


MOTION: dict[str, Lowering] = {
    "move": _move,
    "move_external": _move_external,
    "trigger": trigger,
    "path_rule": _path_rule,
    "define_trigger": _define_trigger,
}
ALL_STATEMENTS: dict[str, Lowering] = {**STATEMENTS, **MOTION}
