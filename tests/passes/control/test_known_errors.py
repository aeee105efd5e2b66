"""The question of a handler for the only error that can be raised there is not asked."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.statements.knownerrors import settled
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

NUMBER, LATE, OTHER = ir.Name("error_number"), ir.Name("late"), ir.Name("other")
YES, NO, MORE = (
    ir.Message("notify", ir.TextLiteral("yes")),
    ir.Message("notify", ir.TextLiteral("no")),
    ir.Message("notify", ir.TextLiteral("more")),
)


def asked(*codes: ir.Expression) -> ir.Expression:
    condition: ir.Expression = ir.Binary("=", NUMBER, codes[0])
    for one in codes[1:]:
        condition = ir.Binary("or", condition, ir.Binary("=", one, NUMBER))
    return condition


@pytest.mark.parametrize(
    ("body", "code", "expected"),
    [
        ((ir.If(((asked(LATE), (YES,)),), (NO,)), MORE), LATE, (YES, MORE)),
        ((ir.If(((asked(OTHER, LATE), (YES,)),), (NO,)), MORE), LATE, (YES, MORE)),
        ((MORE, ir.If(((asked(LATE), (YES,)), (asked(OTHER), (NO,))))), LATE, (MORE, YES)),
        ((ir.If(((asked(OTHER), (YES,)),), (NO,)),), LATE, None),  # two names may be one number
        ((ir.CallRoutine("sort"), ir.If(((asked(LATE), (YES,)),))), LATE, None),  # the call may raise and handle
        ((ir.Assign(NUMBER, OTHER), ir.If(((asked(LATE), (YES,)),))), LATE, None),
        ((ir.If(((asked(LATE), (YES,)),), (ir.Label("again"),)),), LATE, None),
        ((ir.If(((asked(LATE), (YES,)),)),), ir.Binary("+", LATE, OTHER), None),
    ],
)
def test_settled(body: ir.Body, code: ir.Expression, expected: ir.Body | None) -> None:
    assert settled(body, NUMBER, code) == (body if expected is None else expected)


PROGRAM = """MODULE Main
  VAR num resets;
  PROC main()
    WaitDI di1,1\\MaxTime:=1.5;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      ! Once more
      resets:=resets+1;
      RETRY;
    ELSE
      RAISE;
    ENDIF
  ENDPROC
ENDMODULE
"""


def test_a_wait_beside_its_handler() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Main.mod", PROGRAM)], "rapid", diagnostics)
    done = translate_program(read, "krl", "abb_irb1200_5_90", None, diagnostics)
    text = "".join(file.data.decode("latin-1") for file in done.files)
    assert "; Once more" in text and "resets=resets+1" in text
    assert "error_number==" not in text
