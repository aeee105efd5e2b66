"""Tools and bases that programs use and that stand in `$config.dat` alone: without that file they are as on a new
controller, the identity, which is said once for each."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import Origin, Source

NOT_GIVEN = code(
    "krl-not-given",
    Severity.WARNING,
    "the data of {name} stands in $config.dat, which is not among what was read: it is taken as identity",
    'add $config.dat to the project; a run also takes it from the cell file: [variables] "{name}" = ...',
)
# What a remark says is passed over. Number 0 is the flange or the world.
_USED = re.compile(r";[^\n]*|\b(TOOL|BASE)_(?:DATA[ \t]*\[[ \t]*|NO[ \t]+)0*([1-9]\d*)\b", re.IGNORECASE)
_SET = re.compile(
    r"^[ \t]*(TOOL|BASE)_DATA[ \t]*\[[ \t]*([^\n=]*?)\][ \t]*(?:\.[ \t]*\w+[ \t]*)?=(?!=)",
    re.IGNORECASE | re.MULTILINE,
)
_DECLARED = re.compile(r"^[^;\n]*\bFRAME[ \t][^;\n]*\b(TOOL|BASE)_DATA[ \t]*\[", re.IGNORECASE | re.MULTILINE)


def tell_what_is_not_given(sources: Sequence[Source], diagnostics: Diagnostics) -> None:
    """Elements of TOOL_DATA and BASE_DATA that statements or inline forms (TOOL_NO, BASE_NO) name by number, of lists
    that no file declares, and that no statement sets, by its number or a computed one."""
    known: set[str] = set()
    named = [source for source in sources if any(word in source.text.upper() for word in ("TOOL_", "BASE_"))]
    for source in named:
        known.update(found[1].upper() for found in _DECLARED.finditer(source.text))
        for found in _SET.finditer(source.text):
            number = found[2].strip()
            known.add(f"{found[1].upper()} {int(number)}" if number.isdecimal() else found[1].upper())
    for source in named:
        for found in _USED.finditer(source.text):
            if found[1] is None:
                continue
            bank, number = found[1].upper(), int(found[2])
            if bank in known or f"{bank} {number}" in known:
                continue
            known.add(f"{bank} {number}")
            origin = Origin(source, found.start(), found.end())
            diagnostics.report(NOT_GIVEN, origin, name=f"{bank}_DATA[{number}]")


__all__ = ["tell_what_is_not_given"]
