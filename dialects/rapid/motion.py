"""RAPID's motion instructions: moves, path events, searches, and the modal settings that motion obeys.

Each maker gets the arguments and gives statements, or None when an option has no neutral form (then the instruction is
kept as a vendor statement). Sources: RAPID reference manuals, instructions MoveL, TriggIO, SearchL, ConfJ, AccSet...
"""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.source import Origin

from .arguments import Arguments
from .expressions import Expressions, as_bool

Made = ir.Statement | tuple[ir.Statement, ...] | None
Make = Callable[[Arguments, Expressions, Origin], Made]

_MOVE_OPTIONS = frozenset(("conc", "id", "v", "t", "z", "inpos", "wobj", "tload", "noeoffs"))
_WORLD = ir.Name("wobj0")
_SET_VALUES = ("value", "dvalue")  # of a group, MoveLGO
_EVENTS = ("t2", "t3", "t4", "t5", "t6", "t7", "t8")


def _speed(profile: ir.Expression, options: dict[str, ir.Expression | None]) -> ir.Speed:
    return ir.Speed(profile=profile, path=options.get("v"), duration=options.get("t"))


def _zone(zone: ir.Expression, options: dict[str, ir.Expression | None]) -> ir.BlendZone:
    return ir.BlendZone(zone, options.get("z"), options.get("inpos"))


def _move(
    kind: str,
    positional: list[ir.Expression],
    options: dict[str, ir.Expression | None],
    origin: Origin,
    triggers: tuple[ir.Expression | ir.Trigger, ...] = (),
) -> ir.Move:
    """positional: [via,] target, speed, zone, tool"""
    via, *rest = positional if kind == "circular" else (None, *positional)
    target, speed, zone, tool = rest
    assert target is not None and speed is not None and zone is not None  # lengths are checked by the makers
    return ir.Move(
        kind,
        target,
        via=via,
        tool=tool,
        frame=options.get("wobj") or _WORLD,
        load=options.get("tload"),
        speed=_speed(speed, options),
        blend=_zone(zone, options),
        triggers=triggers,
        concurrent="conc" in options,
        without_offsets="noeoffs" in options,
        identity=options.get("id"),
        origin=origin,
    )


def _points(kind: str) -> int:
    return 2 if kind == "circular" else 1


def _plain(kind: str) -> Make:
    """MoveAbsJ, MoveJ, MoveL: target, speed, zone, tool. MoveC: via, target, speed, zone, tool."""

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        positional = arguments.need(3 + _points(kind))
        if set(arguments.options) - _MOVE_OPTIONS:
            return None
        return _move(kind, positional, arguments.options, origin)

    return make


def _with_output(kind: str, signal_kind: str) -> Make:
    """MoveLDO and the like set an output in the middle of the corner path."""

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        given = [value for name in _SET_VALUES if (value := arguments.options.get(name)) is not None]
        if signal_kind != "group_out" and given:
            return None
        positional = [*arguments.need(5 + _points(kind) - len(given)), *given]
        if set(arguments.options) - _MOVE_OPTIONS - set(_SET_VALUES):
            return None
        signal = expressions.signal(positional[-2], signal_kind)
        value = as_bool(positional[-1]) if signal_kind == "digital_out" else positional[-1]
        trigger = ir.Trigger("middle", ir.Assign(signal, value, origin=origin), origin=origin)
        return _move(kind, positional[:-2], arguments.options, origin, (trigger,))

    return make


def _with_call(kind: str) -> Make:
    """MoveLSync and the like call a procedure in the middle of the corner path."""

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        positional = arguments.need(4 + _points(kind))
        if set(arguments.options) - _MOVE_OPTIONS:
            return None
        match positional[-1]:
            case ir.TextLiteral(value=name):
                action = ir.CallRoutine(name, origin=origin)
            case text:
                action = ir.CallRoutine("", (), text, origin=origin)
        trigger = ir.Trigger("middle", action, origin=origin)
        return _move(kind, positional[:-1], arguments.options, origin, (trigger,))

    return make


def _with_events(kind: str) -> Make:
    """TriggL target, speed, event [\\T2...], zone, tool"""

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        positional = arguments.need(4 + _points(kind))
        options = arguments.options
        if set(options) - _MOVE_OPTIONS - set(_EVENTS):
            return None
        events = (positional[-3], *(event for name in _EVENTS if (event := options.get(name)) is not None))
        return _move(kind, [*positional[:-3], *positional[-2:]], options, origin, events)

    return make


def _external(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """MoveExtJ target, speed, zone"""
    target, speed, zone = arguments.need(3)
    if set(arguments.options) - {"t", "inpos"}:
        return None
    return ir.MoveExternal(target, _speed(speed, arguments.options), _zone(zone, arguments.options), origin=origin)


def _search(kind: str) -> Make:
    """SearchL signal, found, target, speed, tool; SearchC has the circle point before the target. It always stops at
    the end of the path; without a stop option it does so only there. A level (\\HighLevel) may be there already:
    then the robot stays."""
    stops = {"stop": "stop", "pstop": "path", "sstop": "soft", "sup": "none"}
    edges = {"flanks": "either", "posflank": "rising", "negflank": "falling"}
    levels = {"highlevel": "rising", "lowlevel": "falling"}
    edges |= levels
    known = _MOVE_OPTIONS | set(stops) | set(edges)

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        signal, found, *rest = arguments.need(4 + _points(kind))
        options = arguments.options
        if set(options) - known:
            return None
        stop = next((stops[name] for name in stops if name in options), "none")
        edge = next((edges[name] for name in edges if name in options), "rising")
        condition = expressions.signal(signal, "digital_in")
        via, (target, speed, tool) = (rest[0], rest[1:]) if kind == "circular" else (None, rest)
        move = ir.Move(
            kind,
            target,
            via=via,
            tool=tool,
            frame=options.get("wobj") or _WORLD,
            load=options.get("tload"),
            speed=_speed(speed, options),
            blend=ir.BlendStop(),
            search=ir.Search(condition, found, stop, edge),
            identity=options.get("id"),
            origin=origin,
        )
        if not set(options) & set(levels):
            return move
        here = ir.Assign(found, ir.Builtin("current_target", (tool, options.get("wobj") or _WORLD)), origin=origin)
        there = condition if edge == "rising" else ir.Unary("not", condition)
        return ir.If(((there, (here,)),), (move,), origin=origin)

    return make


# ---- stored path events


def negated(value: ir.Expression) -> ir.Expression:
    match value:
        case ir.IntLiteral(value=0):
            return value
        case ir.Unary(op="-", operand=operand):
            return operand
    return ir.Unary("-", value)


def _place(
    distance: ir.Expression, options: dict[str, ir.Expression | None]
) -> tuple[str, ir.Expression | None, ir.Expression | None]:
    """reference, distance, delay: before the end in mm, behind the start in mm, or before the end in s."""
    if "start" in options:
        return "start", distance, None
    if "time" in options:
        return "end", None, negated(distance)
    return "end", negated(distance), None


def _output_action(
    arguments: Arguments, expressions: Expressions, value: ir.Expression, origin: Origin
) -> ir.Assign | None:
    for option, kind in (("dop", "digital_out"), ("gop", "group_out"), ("aop", "analog_out")):
        signal = arguments.options.get(option)
        if signal is not None:
            written = as_bool(value) if kind == "digital_out" else value
            return ir.Assign(expressions.signal(signal, kind), written, origin=origin)
    return None


def _trigg_io(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """TriggIO data, distance [\\Start|\\Time] [\\DOp|\\GOp|\\AOp], value [\\DODelay]"""
    target, distance, value = arguments.need(3)
    options = arguments.options
    if set(options) - {"start", "time", "dop", "gop", "aop", "dodelay"}:
        return None
    reference, millimetres, delay = _place(distance, options)
    later = options.get("dodelay")
    if later is not None:
        if delay is not None:
            return None
        delay = later
    action = _output_action(arguments, expressions, value, origin)
    if action is None:
        return None
    return ir.DefineTrigger(target, ir.Trigger(reference, action, millimetres, delay, origin=origin), origin=origin)


def _trigg_equip(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """TriggEquip data, distance [\\Start], lag [\\DOp|\\GOp|\\AOp], value: `lag` s before the robot is there."""
    target, distance, lag, value = arguments.need(4)
    if set(arguments.options) - {"start", "dop", "gop", "aop"}:
        return None
    reference, millimetres, _ = _place(distance, arguments.options)
    action = _output_action(arguments, expressions, value, origin)
    if action is None:
        return None
    trigger = ir.Trigger(reference, action, millimetres, negated(lag), origin=origin)
    return ir.DefineTrigger(target, trigger, origin=origin)


def _trigg_int(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """TriggInt data, distance [\\Start|\\Time], interrupt. The trap it is connected to is called at the place."""
    target, distance, interrupt = arguments.need(3)
    if set(arguments.options) - {"start", "time"}:
        return None
    reference, millimetres, delay = _place(distance, arguments.options)
    trigger = ir.Trigger(reference, ir.CallRoutine("", origin=origin), millimetres, delay, origin=origin)
    return ir.DefineTrigger(target, trigger, interrupt, origin=origin)


# ---- modal settings


def _assign(name: str, value: ir.Expression, origin: Origin) -> ir.Assign:
    return ir.Assign(ir.System(name), value, origin=origin)


def _on_off(system: str) -> Make:
    """ConfJ and ConfL: `\\On` is the default."""

    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        arguments.need(0)
        if set(arguments.options) - {"on", "off"}:
            return None
        return _assign(system, ir.BoolLiteral("off" not in arguments.options), origin)

    return make


def _mode(system: str, modes: dict[str, str], default: str | None) -> Make:
    def make(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
        arguments.need(0)
        chosen = [modes.get(option) for option in arguments.options] or [default]
        if len(chosen) != 1 or chosen[0] is None:
            return None
        return _assign(system, ir.EnumLiteral(chosen[0]), origin)

    return make


def _vel_set(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    percent, limit = arguments.need(2)
    if arguments.options:
        return None
    return (_assign("speed_percent", percent, origin), _assign("speed_limit", limit, origin))


def _acc_set(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    percent, ramp = arguments.need(2)
    options = arguments.options
    if set(options) - {"finepointramp"}:
        return None
    made = (_assign("acceleration_percent", percent, origin), _assign("acceleration_ramp", ramp, origin))
    fine = options.get("finepointramp") or ir.IntLiteral(100, origin=origin)
    return (*made, _assign("stop_ramp", fine, origin))


def _grip_load(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    return _assign("load", arguments.need(1)[0], origin)


_DISPLACEMENT = ir.System("displacement")


def _displace(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """PDispSet pose: from now on between work object and targets."""
    return None if arguments.options else _assign("displacement", arguments.need(1)[0], origin)


def _displace_off(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    arguments.need(0)
    return _assign("displacement", ir.System("null_frame"), origin)


def _displace_on(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    r"""PDispOn [\Rot] [\ExeP] point, tool [\WObj]: the point comes to lie where ExeP is (the present place when left
    out), without \Rot moved only. Several of them add up: ExeP is read in the displacement that is in force."""
    point, tool = arguments.need(2)
    options = arguments.options
    if set(options) - {"rot", "exep", "wobj"}:
        return None
    there = options.get("exep") or ir.Builtin("current_target", (tool, options.get("wobj") or _WORLD))
    moved: ir.Expression
    if "rot" in options:
        moved = ir.Builtin("compose", (_place_of(there), ir.Builtin("inverse", (_place_of(point),))))
    else:
        way = ir.Binary("-", ir.Field(there, "trans"), ir.Field(point, "trans"))
        moved = ir.Aggregate((("trans", way), ("rot", _STRAIGHT)), type_name="pose")
    return _assign("displacement", ir.Builtin("compose", (_DISPLACEMENT, moved)), origin)


_STRAIGHT = ir.Builtin("rotation_zyx", (ir.IntLiteral(0), ir.IntLiteral(0), ir.IntLiteral(0)))


def _place_of(target: ir.Expression) -> ir.Expression:
    return ir.Builtin("pose_of", (target,))


def _speed_refresh(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    return None if arguments.options else _assign("override", arguments.need(1)[0], origin)


def _stop_move(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    if set(arguments.options) - {"quick", "allmotiontasks"}:
        return None
    return ir.StopMotion("quick" in arguments.options, origin=origin)


def _start_move(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    return None if set(arguments.options) - {"allmotiontasks"} else ir.StartMotion(origin=origin)


def _wait_rob(arguments: Arguments, expressions: Expressions, origin: Origin) -> Made:
    """WaitRob \\InPos or \\ZeroSpeed: both wait until the robot stands."""
    arguments.need(0)
    return ir.WaitForMotion(origin=origin)


_KINDS = {"j": "joint", "l": "linear", "c": "circular"}

MOTION: dict[str, Make] = {
    "moveabsj": _plain("joint"),
    **{f"move{letter}": _plain(kind) for letter, kind in _KINDS.items()},
    **{f"move{letter}do": _with_output(kind, "digital_out") for letter, kind in _KINDS.items()},
    **{f"move{letter}ao": _with_output(kind, "analog_out") for letter, kind in _KINDS.items()},
    **{f"move{letter}go": _with_output(kind, "group_out") for letter, kind in _KINDS.items()},
    **{f"move{letter}sync": _with_call(kind) for letter, kind in _KINDS.items()},
    **{f"trigg{letter}": _with_events(kind) for letter, kind in _KINDS.items()},
    "moveextj": _external,
    "searchl": _search("linear"),
    "searchc": _search("circular"),
    "triggio": _trigg_io,
    "triggequip": _trigg_equip,
    "triggint": _trigg_int,
    "confj": _on_off("joint_configuration_check"),
    "confl": _on_off("path_configuration_check"),
    "singarea": _mode("singularity_mode", {"wrist": "wrist", "off": "off", "lockaxis4": "lock_axis_4"}, "off"),
    "cirpathmode": _mode("circle_orientation", {"pathframe": "path", "objectframe": "base"}, "path"),
    "velset": _vel_set,
    "accset": _acc_set,
    "gripload": _grip_load,
    "pdispset": _displace,
    "pdispon": _displace_on,
    "pdispoff": _displace_off,
    "speedrefresh": _speed_refresh,
    "stopmove": _stop_move,
    "startmove": _start_move,
    "startmoveretry": lambda arguments, expressions, origin: (ir.StartMotion(origin=origin), ir.Retry(origin=origin)),
    "clearpath": lambda arguments, expressions, origin: ir.ClearMotion(origin=origin),
    "storepath": lambda arguments, expressions, origin: None if arguments.options else ir.StoreMotion(origin=origin),
    "restopath": lambda arguments, expressions, origin: ir.StoreMotion(restore=True, origin=origin),
    "waitrob": _wait_rob,
}
