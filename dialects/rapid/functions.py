"""RAPID's installed functions as neutral built-ins. What is not in this table is a call of a predefined routine.

Sources: RAPID reference manuals, system functions; see docs/rapid.md for what is a hypothesis.
"""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir

from .arguments import Arguments, Signals
from .texts import BASES, digits_calculated, digits_compared, formatted, part_of_time, text_of_byte

Make = Callable[[Arguments, Signals], ir.Expression | None]
"""make(arguments, expressions): the expression, or None when an option has no neutral form. May raise
StatementError."""

MOTION_TASK = "T_ROB1"  # the task of the robot on every controller that has one
_ZERO, _ONE, _BYTE = ir.IntLiteral(0), ir.IntLiteral(1), ir.IntLiteral(255)


def _plain(function: str, least: int, most: int | None = None) -> Make:
    def make(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
        positional = arguments.need(least, most)
        return None if arguments.options else ir.Builtin(function, tuple(positional))

    return make


def _either(function: str, least: int, option: str, other: str) -> Make:
    """Another function where the option is given."""

    def make(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
        given = tuple(arguments.need(least))
        if set(arguments.options) - {option}:
            return None
        return ir.Builtin(other if arguments.options else function, given)

    return make


def _in_base(base: int, other: int) -> Make:
    """DecToHex, HexToDec: the digits of a whole number in another base."""

    def make(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
        (text,) = arguments.need(1)
        bases = ir.IntLiteral(base), ir.IntLiteral(other)
        return None if arguments.options else ir.Builtin("digits_in_base", (text, *bases))

    return make


def _with_option(function: str, least: int, option: str) -> Make:
    """The option's value follows the positional arguments."""

    def make(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
        positional = arguments.need(least)
        rest = dict(arguments.options)
        value = rest.pop(option, None)
        if rest:
            return None
        return ir.Builtin(function, (*positional, value) if value is not None else tuple(positional))

    return make


def _binary(op: str) -> Make:
    def make(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
        left, right = arguments.need(2)
        return ir.Binary(op, left, right)

    return make


def bit_mask(number: ir.Expression) -> ir.Expression:
    """The number whose only bit is the n-th, counted from 1 (the least)."""
    if isinstance(number, ir.IntLiteral):
        return ir.IntLiteral(1 << max(number.value - 1, 0))
    return ir.Builtin("bit_shift_left", (_ONE, ir.Binary("-", number, _ONE)))


def _bit_check(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    """BitCheck data, position (1 ... 8; of a dnum 1 ... 52)"""
    value, number = arguments.need(2)
    return ir.Binary("<>", ir.Binary("band", value, bit_mask(number)), _ZERO)


def _bit_shift_left(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    """BitLSh of a byte: what leaves it on the left is lost."""
    return ir.Binary("band", ir.Builtin("bit_shift_left", tuple(arguments.need(2))), _BYTE)


def _bit_negated(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    return ir.Binary("bxor", arguments.need(1)[0], _BYTE)


def _byte_of_text(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    r"""StrToByte text [\Hex] | [\Okt] | [\Bin] | [\Char]: a number of eight bits in a base, or a character's code."""
    (text,) = arguments.need(1)
    option = next(iter(arguments.options), "")
    if option == "char":
        return ir.Builtin("character_code", (text,))
    if option in BASES and len(arguments.options) == 1:
        return ir.Binary("band", ir.Builtin("based_number", (text, ir.IntLiteral(BASES[option][0]))), _BYTE)
    return None if arguments.options else ir.Binary("band", ir.Builtin("text_value", (text,)), _BYTE)


def _same(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    """NumToDnum and DnumToNum: num and dnum are one type here."""
    value = arguments.need(1)[0]
    return None if set(arguments.options) - {"integer"} else value


def _signal_value(kind: str) -> Make:
    def make(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
        signal = expressions.signal(arguments.need(1)[0], kind)
        return ir.Convert("bit", signal) if kind.startswith("digital") else signal

    return make


def _test_signal(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    return expressions.signal(arguments.need(1)[0], "digital_in")


def _rel_tool(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    """RelTool(p, dx, dy, dz \\Rx \\Ry \\Rz)"""
    positional = arguments.need(4)
    options = arguments.options
    if set(options) - {"rx", "ry", "rz"}:
        return None
    turns = [options.get(name) or _ZERO for name in ("rx", "ry", "rz")]
    while turns and turns[-1] is _ZERO:
        turns.pop()
    return ir.Builtin("tool_offset", (*positional, *turns))


def _of_motion_task(options: dict[str, ir.Expression | None]) -> dict[str, ir.Expression | None]:
    """The options without the task, where that is the only robot's."""
    robots = (("taskname", ir.TextLiteral(MOTION_TASK)), ("taskref", ir.Name(f"{MOTION_TASK}Id")))
    named = [name for name, task in robots if options.get(name) == task]
    return {name: value for name, value in options.items() if name not in named}


def _joints_now(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    """CJointT, of the only robot also by its task."""
    arguments.need(0)
    return None if _of_motion_task(arguments.options) else ir.Builtin("current_joints", ())


def _current(function: str) -> Make:
    """CRobT and CPos: `\\Tool`, `\\WObj`; what is left out is the one in use."""

    def make(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
        arguments.need(0)
        options = _of_motion_task(arguments.options)
        if set(options) - {"tool", "wobj"}:
            return None
        tool, frame = options.get("tool"), options.get("wobj")
        if tool is None and frame is None:
            return ir.Builtin(function, ())
        tool = tool or ir.Builtin("current_tool", ())
        return ir.Builtin(function, (tool,) if frame is None else (tool, frame))

    return make


def _kinematics(function: str) -> Make:
    """CalcRobT(joints, tool \\WObj) and CalcJointT(target, tool \\WObj); the work object is wobj0 when left out."""

    def make(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
        position, tool = arguments.need(2)
        if set(arguments.options) - {"wobj"}:
            return None
        return ir.Builtin(function, (position, tool, arguments.options.get("wobj") or ir.Name("wobj0")))

    return make


def _euler(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    rotation = arguments.need(1)[0]
    for option in ("x", "y", "z"):
        if set(arguments.options) == {option}:
            return ir.Builtin(f"euler_{option}", (rotation,))
    return None


def _place_of(target: ir.Expression) -> ir.Expression:
    """Where a robtarget is (typing takes the place out of one that is written out)."""
    return ir.Field(target, "trans")


def _def_frame(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    points = [_place_of(point) for point in arguments.need(3)]
    if set(arguments.options) - {"origin"}:
        return None
    origin = arguments.options.get("origin")
    return ir.Builtin("frame_from_points", (*points, origin) if origin is not None else tuple(points))


def _moved_frame(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    """DefDFrame old1, old2, old3, new1, new2, new3: the displacement that carries the old points to the new ones."""
    points = [_place_of(point) for point in arguments.need(6)]
    if arguments.options:
        return None
    old, new = (ir.Builtin("frame_from_points", tuple(three)) for three in (points[:3], points[3:]))
    return ir.Builtin("compose", (new, ir.Builtin("inverse", (old,))))


def _without_displacement(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    r"""ORobT point [\InPDisp | \InEOffs]: the point seen from the work object, not from the program displacement.
    There are no offsets of external axes here, so \InPDisp is the point as it is."""
    (point,) = arguments.need(1)
    if set(arguments.options) == {"inpdisp"}:
        return point
    if set(arguments.options) - {"ineoffs"}:
        return None
    return ir.Builtin("displaced", (point, ir.System("displacement")))


def _speed_override(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    arguments.need(0)
    return None if set(arguments.options) - {"ctask"} else ir.System("override")


def _greatest_speed(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    """MaxRobSpeed: the tool's greatest speed, which is that of vmax."""
    arguments.need(0)
    return ir.Field(ir.Name("vmax"), "v_tcp")


def _present(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    match arguments.need(1)[0]:
        case ir.Name(id=name):
            return ir.Present(name)
    return None


FUNCTIONS: dict[str, Make] = {
    # mathematics
    **{name: _plain(name, 1) for name in ("abs", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp")},
    **{f"{name}dnum": _plain(name, 1) for name in ("abs", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan")},
    "atan2": _plain("atan2", 2),
    "atan2dnum": _plain("atan2", 2),
    "pow": _plain("power", 2),
    "powdnum": _plain("power", 2),
    "min": _plain("min", 2),
    "max": _plain("max", 2),
    "round": _with_option("round", 1, "dec"),
    "rounddnum": _with_option("round", 1, "dec"),
    "trunc": _with_option("trunc", 1, "dec"),
    "truncdnum": _with_option("trunc", 1, "dec"),
    "numtodnum": _same,
    "dnumtonum": _same,
    "bitand": _binary("band"),
    "bitor": _binary("bor"),
    "bitxor": _binary("bxor"),
    "bitanddnum": _binary("band"),
    "bitordnum": _binary("bor"),
    "bitxordnum": _binary("bxor"),
    "bitrsh": _plain("bit_shift_right", 2),
    "bitlsh": _bit_shift_left,
    "bitneg": _bit_negated,
    "bitcheck": _bit_check,
    "bitcheckdnum": _bit_check,
    "bitrshdnum": _plain("bit_shift_right", 2),
    "dim": _plain("dimension", 2),
    # geometry
    "offs": _plain("offset", 4),
    "reltool": _rel_tool,
    "crobt": _current("current_target"),
    "cpos": _current("current_position"),
    "cjointt": _joints_now,
    "ctool": _plain("current_tool", 0),
    "cwobj": _plain("current_frame", 0),
    "calcrobt": _kinematics("joints_to_target"),
    "calcjointt": _kinematics("target_to_joints"),
    "posemult": _plain("compose", 2),
    "poseinv": _plain("inverse", 1),
    "posevect": _plain("transform", 2),
    "eulerzyx": _euler,
    "orientzyx": _plain("rotation_zyx", 3),
    "defframe": _def_frame,
    "defdframe": _moved_frame,
    "orobt": _without_displacement,
    "distance": _plain("distance", 2),
    "vectmagn": _plain("magnitude", 1),
    "dotprod": _plain("dot", 2),
    "norient": _plain("normalise", 1),
    # texts
    "strlen": _plain("text_length", 1),
    "strpart": _plain("text_part", 3),
    "strfind": _either("text_find_any", 3, "notinset", "text_find_none"),
    "strmatch": _plain("text_match", 3),
    "strmemb": _plain("text_member", 3),
    "strmap": _plain("text_map", 3),
    "strorder": _plain("text_order", 3),
    "numtostr": _either("number_text", 2, "exp", "power_text"),
    "dnumtostr": _either("number_text", 2, "exp", "power_text"),
    "valtostr": _plain("value_text", 1),
    "strtoval": _plain("parse_value", 2),
    "strtobyte": _byte_of_text,
    "dectohex": _in_base(10, 16),
    "hextodec": _in_base(16, 10),
    "strdigcmp": digits_compared,
    "strdigcalc": digits_calculated,
    "bytetostr": text_of_byte,
    "strformat": formatted,
    "gettime": part_of_time,
    "ctime": _plain("time_text", 0),
    "cdate": _plain("date_text", 0),
    # signals, clocks, the rest
    "dinput": _signal_value("digital_in"),
    "doutput": _signal_value("digital_out"),
    "ainput": _signal_value("analog_in"),
    "aoutput": _signal_value("analog_out"),
    "ginput": _signal_value("group_in"),
    "ginputdnum": _signal_value("group_in"),
    "goutput": _signal_value("group_out"),
    "goutputdnum": _signal_value("group_out"),
    "testdi": _test_signal,
    "clkread": _with_option("clock_seconds", 1, "highres"),
    "present": _present,
    "cspeedoverride": _speed_override,
    "maxrobspeed": _greatest_speed,
}
