"""The words of motion: moves with all that is attached to them, searches, stored path events."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.typing import type_of
from rpl.writing.statements import CannotSayError

from .expressions import Expressions

_WORLD = ir.Name("wobj0")
_LETTERS = {"joint": "J", "linear": "L", "circular": "C"}
_STOPS = {"stop": "\\Stop", "path": "\\PStop", "soft": "\\SStop", "none": ""}
_EDGES = {"rising": "", "falling": "\\NegFlank", "either": "\\Flanks"}
_OUTPUTS = {"digital_out": "DO", "analog_out": "AO", "group_out": "GO"}
_OPTIONS = {"digital_out": "DOp", "analog_out": "AOp", "group_out": "GOp"}


Words = dict[str, object]  # of a macro


def move(statement: ir.Move, expressions: Expressions) -> tuple[str, Words]:
    """The macro of a move and its words. Raises CannotSayError for a setting that RAPID has not."""
    _refuse(statement)
    letter = _LETTERS.get(statement.kind)
    if letter is None:
        raise CannotSayError(f"there is no {statement.kind} move")
    if statement.search is not None:
        return "search", _search(statement, statement.search, letter, expressions)
    return "move", _words(statement, letter, expressions)


def _words(statement: ir.Move, letter: str, expressions: Expressions) -> Words:
    name = f"Move{letter}"
    if isinstance(type_of(statement.target, expressions.scope), ir.JointsType):
        if statement.kind != "joint":
            raise CannotSayError("only a joint move goes to joint values")
        name = "MoveAbsJ"
    words: Words = {
        "word": name,
        "options": "\\Conc" if statement.concurrent else "",
        **_points(statement, expressions),
        "speed": _speed(statement.speed, expressions),
        "zone": _zone(statement.blend, expressions),
        **_tool(statement, expressions),
        "events": "",
        "actions": (),
    }
    triggers = statement.triggers
    if not triggers:
        return words
    if len(triggers) == 1 and isinstance(triggers[0], ir.Trigger):
        suffix, words["actions"] = _middle_action(triggers[0], expressions)
        if name == "MoveAbsJ":
            raise CannotSayError("a move to joint values has no action on its path")
        words["word"] = f"{name}{suffix}"
        return words
    events = []
    for trigger in triggers:
        if isinstance(trigger, ir.Trigger):
            raise CannotSayError("an event on the path has to be stored before")
        events.append(expressions.text(trigger))
    words["events"] = events[0] + "".join(f"\\T{number}:={event}" for number, event in enumerate(events[1:], 2))
    if len(events) > 8 or name == "MoveAbsJ":
        raise CannotSayError("these events cannot be attached to the move")
    words["word"] = f"Trigg{letter}"
    return words


def _refuse(statement: ir.Move) -> None:
    for what, found in (
        ("a relative move", statement.relative),
        ("a circle by its angle", statement.swept),
        ("an acceleration of one move", statement.acceleration),
        ("an orientation rule of one move", statement.orientation not in (None, "variable")),
        ("a circle's orientation rule of one move", statement.circle_orientation not in (None, "base")),
        ("a configuration rule of one move", statement.configuration),
        ("settings of one move", statement.settings),
        ("a motion group", statement.group != 1),
    ):
        if found:
            raise CannotSayError(f"{what} is not known")


def _points(statement: ir.Move, expressions: Expressions) -> Words:
    target = expressions.text(statement.target) + ("\\NoEOffs" if statement.without_offsets else "")
    if statement.identity is not None:
        target += f"\\ID:={expressions.text(statement.identity)}"
    if statement.kind != "circular":
        return {"via": "", "target": target}
    if statement.via is None:
        raise CannotSayError("a circle needs its point on the way")
    return {"via": expressions.text(statement.via), "target": target}


def _speed(speed: ir.Speed | None, expressions: Expressions) -> str:
    if speed is None or speed.joint is not None or (speed.profile is None and speed.path is None):
        raise CannotSayError("the move has no speed of its own")
    if speed.rotation is not None:
        raise CannotSayError("a move has no rotation speed beside its speed data")
    own = "" if speed.path is None else f"\\V:={expressions.text(speed.path)}"
    if speed.profile is None:
        assert speed.path is not None  # checked above
        profile, own = f"[{expressions.text(speed.path)},500,5000,1000]", ""
    else:
        profile = expressions.text(speed.profile)
    time = "" if speed.duration is None else f"\\T:={expressions.text(speed.duration)}"
    return f"{profile}{own}{time}"


def _zone(blend: ir.Blend | None, expressions: Expressions) -> str:
    match blend:
        case None | ir.BlendStop():
            return "fine"
        case ir.BlendZone(zone=zone, distance=distance, in_position=in_position):
            size = "" if distance is None else f"\\Z:={expressions.text(distance)}"
            stop = "" if in_position is None else f"\\Inpos:={expressions.text(in_position)}"
            return f"{expressions.text(zone)}{size}{stop}"
    raise CannotSayError("corners are given by zone data only")


def _tool(statement: ir.Move, expressions: Expressions) -> Words:
    tool, frame, load = statement.tool, statement.frame, statement.load
    return {
        "tool": "tool0" if tool is None else _persistent(tool, expressions, "tool"),
        "frame": "" if frame is None or frame == _WORLD else _persistent(frame, expressions, "work object"),
        "load": "" if load is None else _persistent(load, expressions, "load"),
    }


def _persistent(value: ir.Expression, expressions: Expressions, what: str) -> str:
    """The name of the data. A pose is none: its record has more components."""
    is_pose = isinstance(type_of(value, expressions.scope), ir.PoseType | ir.TargetType)
    if isinstance(value, ir.Name | ir.Index | ir.Field) and not is_pose:
        return expressions.text(value)
    raise CannotSayError(f"the {what} of a move has to be persistent data")


def _middle_action(trigger: ir.Trigger, expressions: Expressions) -> tuple[str, tuple[str, ...]]:
    """Suffix and further arguments of an instruction that acts in the middle of the corner path."""
    if trigger.reference != "middle" or trigger.distance is not None or trigger.delay is not None:
        raise CannotSayError("an event on the path has to be stored before")
    match trigger.action:
        case ir.Assign(target=ir.Signal(kind=kind) as signal, value=value) if kind in _OUTPUTS:
            return _OUTPUTS[kind], (expressions.signal(signal), output_value(kind, value, expressions))
        case ir.CallRoutine(dynamic=None, name=name, arguments=()):
            return "Sync", (f'"{name}"',)
        case ir.CallRoutine(dynamic=text, arguments=()) if text is not None:
            return "Sync", (expressions.text(text),)
    raise CannotSayError("this action cannot be attached to a move")


def output_value(kind: str, value: ir.Expression, expressions: Expressions) -> str:
    """The number written to an output. Raises CannotSayError for a BOOL that is not a literal or a signal."""
    if kind != "digital_out":
        return expressions.text(value)
    match value:
        case ir.BoolLiteral(value=truth):
            return "1" if truth else "0"
        case ir.Convert(how="truth", operand=operand):
            return expressions.text(operand)
        case ir.Signal():
            return expressions.value_of_signal(value)
    raise CannotSayError("a digital output takes a number")


def _search(statement: ir.Move, search: ir.Search, letter: str, expressions: Expressions) -> Words:
    if statement.kind == "joint" or statement.triggers:
        raise CannotSayError("a search goes on a line or circle and carries no events")
    watched, edge = _watched(search)
    if not isinstance(watched, ir.Signal | ir.Name):
        raise CannotSayError("a search watches one signal")
    if search.found is None:
        raise CannotSayError("a search gives the place where it found something")
    return {
        "word": f"Search{letter}",
        "stop": _STOPS[search.stop],
        "signal": expressions.signal(watched),
        "edge": _EDGES[edge],
        **_points(statement, expressions),
        "speed": _speed(statement.speed, expressions),
        **_tool(statement, expressions),
        "found": expressions.text(search.found),
    }


def _watched(search: ir.Search) -> tuple[ir.Expression, str]:
    """What a search watches and for which edge: a signal that goes off is watched for the other one."""
    watched, edge = search.condition, search.edge
    while True:
        match watched:
            case ir.Unary(op="not", operand=inner):
                other = True
            case ir.Binary(op="==" | "<>" as op, left=ir.Signal() as inner, right=ir.BoolLiteral(value=value)):
                other = (op == "==") != value
            case _:
                return watched, edge
        watched = inner
        if other and edge != "either":
            edge = "falling" if edge == "rising" else "rising"


def move_external(statement: ir.MoveExternal, expressions: Expressions) -> Words:
    return {
        "target": expressions.text(statement.target),
        "speed": _speed(statement.speed, expressions),
        "zone": _zone(statement.blend, expressions),
    }


def define_trigger(statement: ir.DefineTrigger, expressions: Expressions) -> tuple[str, Words]:
    """The macro of TriggIO, TriggEquip or TriggInt and its words."""
    trigger = statement.trigger
    target = expressions.text(statement.target)
    place, switch = _place(trigger, expressions)
    words: Words = {"target": target, "place": place, "switch": switch}
    if statement.interrupt is not None:
        if trigger.delay is not None and switch != "\\Time":
            raise CannotSayError("an interrupt at a time before a place on the path")
        return "trigger_interrupt", words | {"interrupt": expressions.text(statement.interrupt)}
    match trigger.action:
        case ir.Assign(target=ir.Signal(kind=kind) as signal, value=value) if kind in _OPTIONS:
            words |= {"option": _OPTIONS[kind], "signal": expressions.signal(signal)}
            words["value"] = output_value(kind, value, expressions)
        case _:
            raise CannotSayError("a path event writes an output")
    if switch == "\\Time" or trigger.delay is None:
        return "trigger_output", words | {"delay": ""}
    lag = negative_of(trigger.delay)
    if lag is None and isinstance(trigger.delay, ir.IntLiteral | ir.RealLiteral):
        return "trigger_output", words | {"delay": expressions.text(trigger.delay)}
    # A computed delay may have either sign, which only the lag of an equipment may have.
    lag = lag if lag is not None else ir.Unary("-", trigger.delay)
    return "trigger_equipment", words | {"lag": expressions.text(lag)}


def _place(trigger: ir.Trigger, expressions: Expressions) -> tuple[str, str]:
    """The distance or time and its switch. A delay stands elsewhere unless it is all there is before the end."""
    match trigger.reference, trigger.distance:
        case "start", distance:
            return ("0" if distance is None else expressions.text(distance)), "\\Start"
        case "end" | "middle", None:  # at a fly-by point the end counts in the middle of the corner path
            before = None if trigger.delay is None else negative_of(trigger.delay)
            return ("0", "") if before is None else (expressions.text(before), "\\Time")
        case "end" | "middle", distance if distance is not None:
            before = negative_of(distance)
            if before is None and isinstance(distance, ir.IntLiteral | ir.RealLiteral):
                raise CannotSayError("a path event cannot lie behind the end of its move")
            return expressions.text(before if before is not None else ir.Unary("-", distance)), ""
    raise CannotSayError("there is no path event at this place")


def negative_of(value: ir.Expression) -> ir.Expression | None:
    """What a value is the negative of; None when it is not written as one."""
    match value:
        case ir.Unary(op="-", operand=operand):
            return operand
        case ir.Quantity(value=inner) if (positive := negative_of(inner)) is not None:
            return replace(value, value=positive)
        case ir.IntLiteral(value=number) if number <= 0:
            return value if number == 0 else ir.IntLiteral(-number)
        case ir.RealLiteral(value=number) if number <= 0:
            return value if number == 0 else ir.RealLiteral(-number)
    return None
