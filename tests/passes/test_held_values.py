"""What variables hold in front of a statement: nothing is known of what may change between any two."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.values.heldvalues import HeldValues, KnownData
from rpl.project import read_sources
from rpl.source import source_from_text

HEAD, ASKED = "DECL INT n\nINTERRUPT ON 3\n", "$OUT[1] = n == 1\n"
MOVE = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"

# lines in front of the question, what the variable holds there
CASES = {
    "a value": ("n = 1\n", 1),
    "a value behind a move": (f"n = 1\n{MOVE}", 1),
    "an interrupt may assign it": ("INTERRUPT DECL 3 WHEN $IN[1] == TRUE DO n = 2\nn = 1\n", None),
    "a trigger assigns it": (f"n = 1\nTRIGGER WHEN DISTANCE=1 DELAY=0 DO n = 2\n{MOVE}", None),
    "a routine assigns it": ("n = 1\nINTERRUPT DECL 3 WHEN $IN[1] == TRUE DO other( )\n", None),
    "one of two ways assigns it": ("n = 1\nIF $IN[2] THEN\nn = 2\nENDIF\n", None),
    "both ways assign the same": ("IF $IN[2] THEN\nn = 1\nELSE\nn = 1\nENDIF\n", 1),
}


@pytest.mark.parametrize(("lines", "expected"), CASES.values(), ids=list(CASES))
def test_what_a_variable_holds(lines: str, expected: int | None) -> None:
    text = f"DEF main( )\n{HEAD}{lines}{ASKED}END\nDEF other( )\nn = 3\nEND\n"
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("main.src", text)], "krl", diagnostics).program
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    values = HeldValues.of(KnownData.of(program), {"n"})
    asked = [one for one in walk(*program.modules) if isinstance(one, ir.Assign) and isinstance(one.target, ir.Signal)]
    held = values.before(asked[-1]).get("n")
    assert (held.value if isinstance(held, ir.IntLiteral) else None) == expected
