"""A cell file for a project that has none: what its programs ask of the world, ready to be edited.

What only people know stands as remarks: when inputs come. Routines that are not there are stubs that take no time, and
data to which nothing in the project gives a value begins with one that is marked as assumed, so that a run with the
file as it is goes on behind them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence

from rpl import ir, registry
from rpl.depth import at_any_depth
from rpl.inventory.contents import Contents, Missing, SignalUse
from rpl.inventory.lacking import lacking
from rpl.inventory.shown import some
from rpl.ir.walk import walk
from rpl.project import ReadProgram

_HEAD = """# What the programs ask of the world. Lines behind # are proposals: take the sign away and say what holds.
# docs/running.md has all that a cell file can say.
"""
_ASSUME = """# Data without a value gets one when it is first read, and the run names each: zero, FALSE, the
# first member, for a place where the arm stands at the start. Without this line a run stops at the first of them.
assume_data = true
"""
_MOST = 3  # places or programs that a remark names
_OUTPUTS = ("digital out", "analog out", "group out")
_INPUTS = ("digital in", "analog in", "group in")


def new_cell(read: ReadProgram, found: Contents) -> str:
    """The text of the file."""
    parts = [
        _HEAD,
        _ASSUME,
        *_inputs(read, found),
        *_outputs(read, found),
        *_routines(found.missing, _functions(read)),
        *_variables(read),
    ]
    return "\n".join(parts)


def _inputs(read: ReadProgram, found: Contents) -> Iterator[str]:
    """Signals that programs read and none of them sets."""
    for one in found.signals:
        if one.readers and not one.writers and one.kind in _INPUTS and one.number != "computed":
            value = "true" if one.kind == "digital in" else "1"
            yield (
                f"# read by {some(one.readers, _MOST)}\n# [[input]]\n# time = 0.0\n"
                f"# signal = {_text(_spelled(read, one))}\n# value = {value}\n"
            )


def _outputs(read: ReadProgram, found: Contents) -> Iterator[str]:
    """Signals that programs set, and who does: the world answers some of them."""
    rows = [
        f"#   {_spelled(read, one)}: set by {some(one.writers, _MOST)}"
        for one in found.signals
        if one.writers and one.kind in _OUTPUTS and one.number != "computed"
    ]
    if rows:
        yield "\n".join(["# Outputs, which a [[reaction]] may answer by an input:", *rows, ""])


def _routines(missing: Sequence[Missing], functions: set[str]) -> Iterator[str]:
    for one in missing:
        if one.kind == "routine":
            gives = "value = 0                  # assumed: it is a function" if one.name.lower() in functions else ""
            yield (
                f"# called at {some(one.places, _MOST)}{_call(one)}\n"
                f"[[routine]]\nname = {_text(one.name)}\nseconds = 0.0\n"
                f"{gives or '# value = 0                # where it is a function'}\n"
                f'# set = [["$IN[1]", true]]  # inputs that it switches\n'
            )


def _functions(read: ReadProgram) -> set[str]:
    """Names of routines whose value the programs use, folded."""
    return {node.name.lower() for node in walk(read.reduced) if isinstance(node, ir.Call)}


def _call(one: Missing) -> str:
    """How it is called, with its arguments, which a stub does not look at."""
    said = "".join(sign if sign.isprintable() else " " for sign in one.example)
    return f", as in: {said}" if said else ""


def _variables(read: ReadProgram) -> Iterator[str]:
    """Data that the controller keeps, data that nothing gives a value, and data that nobody declares."""
    assumed = [
        f"{'# ' if one.left else ''}{_text(one.path)} = {one.value}  # {one.left or 'assumed'}: "
        f"asked for at {some(one.places, _MOST)}"
        for one in at_any_depth(lambda: lacking(read.program))
    ]
    kept = [
        f"# {_text(one.name)} = {shown}  # kept between runs"
        for module in read.reduced.modules
        for one in module.declarations
        if isinstance(one, ir.Variable) and one.storage == "persistent" and one.origin.source
        if (shown := _literal(one.initial)) is not None
    ]
    if assumed or kept:
        yield "\n".join(["[variables]", *assumed, *dict.fromkeys(kept), ""])


def _literal(value: ir.Expression | None) -> str | None:
    """A number, truth value or text as the file has it; None: something else."""
    match value:
        case ir.BoolLiteral(value=truth):
            return "true" if truth else "false"
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
            return f"{number}"
        case ir.TextLiteral(value=text):
            return _text(text)
    return None


def _spelled(read: ReadProgram, one: SignalUse) -> str:
    """As the language of the programs calls it."""
    if one.number.isdigit():
        return registry.dialect(read.dialects[0]).signal_name(one.kind.replace(" ", "_"), int(one.number))
    return one.name or one.number


def _text(text: str) -> str:
    """A basic string of TOML, which takes the escapes of JSON."""
    return json.dumps(text, ensure_ascii=False)
