"""Values of registers and frames before the start, as the variable dumps (`.VA`) that a controller saves.

Programs that were read together with dumps have such values. A program of another language sets its registers itself;
its constant tools and frames stand here, by the numbers that the listings select.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from rpl import ir
from rpl.passes.scope import ProgramScope, Scope
from rpl.writing.statements import CannotSayError
from rpl.writing.target import OutputFile
from rpl.writing.text import number_text

from . import tables
from .configuration import config_text
from .expressions import constant
from .frames import Frames
from .positions import Position, position_of
from .texts import comment, register_comment

Names = Mapping[tuple[str, int], str]
_ELEMENT = re.compile(r"(R|SR|PR)(\d+)", re.IGNORECASE)
_ACTIVE = {"UFRAME_NUM": ("$MNUFRAMENUM", 0), "UTOOL_NUM": ("$MNUTOOLNUM", 1)}
_BANKS = {"R": "NUMREG", "SR": "STRREG", "PR": "POSREG"}


def dump_files(program: ir.Program, names: Names, frames: Frames) -> list[OutputFile]:
    """The dumps that a program needs; none when everything begins as on a controller without any values. `frames`: the
    constant tools and frames that its listings select."""
    scopes = ProgramScope(program)
    values: dict[str, dict[int, ir.Expression]] = {"R": {}, "SR": {}, "PR": {}, "UFRAME": {}, "UTOOL": {}}
    active: dict[str, int] = {}
    scope: Scope | None = None
    for module in program.modules:
        for declaration in module.declarations:
            if isinstance(declaration, ir.Variable) and declaration.initial is not None:
                _note(declaration, declaration.initial, values, active)
                scope = scope or scopes.module(module)
    given = frames.chosen_values()
    if scope is None:
        if not given:
            return []
        scope = scopes.module(program.modules[0])
    made = [_numbers(values["R"], names), _texts(values["SR"], names), _positions(values["PR"], names, scope)]
    tables_of = {
        bank: {**_given(values[bank], scope), **{n: one for (word, n), one in given.items() if word == bank}}
        for bank in ("UFRAME", "UTOOL")
    }
    made.append(_frames(tables_of, active))
    return [file for file in made if file is not None]


def _note(
    variable: ir.Variable,
    initial: ir.Expression,
    values: dict[str, dict[int, ir.Expression]],
    active: dict[str, int],
) -> None:
    name = variable.name.upper()
    one = _ELEMENT.fullmatch(name)
    if one is not None:
        values[one[1]][int(one[2])] = initial
    elif name in values and isinstance(initial, ir.Aggregate) and isinstance(variable.type, ir.ArrayType):
        base = variable.type.base
        values[name].update({base + at: value for at, (_, value) in enumerate(initial.entries)})
    elif name in _ACTIVE:
        number = constant(initial)
        if number is not None and number != _ACTIVE[name][1]:
            active[name] = int(number)


def _file(name: str, lines: list[str]) -> OutputFile:
    return OutputFile(f"{name}.VA", ("\r\n".join(lines) + "\r\n").encode("ascii"))


def _numbers(values: Mapping[int, ir.Expression], names: Names) -> OutputFile | None:
    given = {number: constant(value) for number, value in values.items()}
    if not any(given.values()):
        return None
    lines = [f"[*NUMREG*]$NUMREG  Storage: SHADOW  Access: RW  : ARRAY[{tables.R.last}] OF Numeric Reg"]
    for number, value in sorted(given.items()):
        if value or ("R", number) in names:
            shown = number_text(value or 0, style=tables.NUMBERS)
            lines.append(f"  [{number}] = {shown}  '{comment(names.get(('R', number), ''))}'")
    return _file("NUMREG", lines)


def _texts(values: Mapping[int, ir.Expression], names: Names) -> OutputFile | None:
    given = {number: value.value for number, value in values.items() if isinstance(value, ir.TextLiteral)}
    if not any(given.values()):
        return None
    lines = [f"[*STRREG*]$STRREG  Storage: SHADOW  Access: RW  : ARRAY[{tables.SR.last}] OF String Reg"]
    for number, text in sorted(given.items()):
        lines.append(f"  [{number}] = '{text}'  '{comment(names.get(('SR', number), ''))}'")
    return _file("STRREG", lines)


def _positions(values: Mapping[int, ir.Expression], names: Names, scope: Scope) -> OutputFile | None:
    lines = [f"[*POSREG*]$POSREG  Storage: SHADOW  Access: RW  : ARRAY[1,{tables.PR.last}] OF Position Reg"]
    for number, value in sorted(values.items()):
        if isinstance(value, ir.VendorValue):
            continue  # it stands on the controller only
        label = register_comment("PR", names.get(("PR", number), ""))
        lines.extend((f"    [1,{number}] =   '{label}'", *_position(value, scope)))
    return _file("POSREG", lines) if len(lines) > 1 else None


def _given(values: Mapping[int, ir.Expression], scope: Scope) -> dict[int, Position]:
    """The frames that are none of nothing."""
    found: dict[int, Position] = {}
    for number, value in values.items():
        try:
            position = position_of(value, scope)
        except CannotSayError:
            continue
        if number > 0 and any(position.values):
            found[number] = position
    return found


def _frames(given: Mapping[str, Mapping[int, Position]], active: Mapping[str, int]) -> OutputFile | None:
    lines: list[str] = []
    for name, bank, last in (("$MNUFRAME", "UFRAME", 9), ("$MNUTOOL", "UTOOL", 10)):
        if given[bank]:
            lines.append(f"[*SYSTEM*]{name}  Storage: SHADOW  Access: RW  : ARRAY[1,{last}] OF POSITION")
        for number, position in sorted(given[bank].items()):
            lines.extend((f"     [1,{number}] =", *_shown(position)))
    for name, number in active.items():
        lines.append(f"[*SYSTEM*]{_ACTIVE[name][0]}  Storage: SHADOW  Access: RW  : ARRAY[8] OF BYTE")
        lines.append(f"     [1] = {number}")
    return _file("SYSFRAME", lines) if lines else None


def _position(value: ir.Expression, scope: Scope) -> Iterator[str]:
    return _shown(position_of(value, scope))


def _shown(position: Position) -> Iterator[str]:
    if position.kind == "joints":
        yield "  Group: 1"
        shown = [f"  J{number} = {_value(one)} deg" for number, one in enumerate(position.values, 1)]
        yield " ".join(shown[:3])
        yield " ".join(shown[3:])
    else:
        yield f"  Group: 1   Config: {config_text(position.flags)}"
        x, y, z, a, b, c = position.values
        yield "".join(f"  {name}: {_value(one)} " for name, one in (("X", x), ("Y", y), ("Z", z))).rstrip()
        yield "".join(f"  {name}: {_value(one)} " for name, one in (("W", c), ("P", b), ("R", a))).rstrip()
    if position.external:
        yield "".join(f"  E{number}: {_value(one)} " for number, one in enumerate(position.external, 1)).rstrip()


def _value(number: float) -> str:
    text = number_text(float(number), 6, tables.NUMBERS)
    whole, _, places = text.partition(".")
    return f"{whole}.{places.ljust(3, '0')}".rjust(9)
