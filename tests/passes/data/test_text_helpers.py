"""Functions of texts that a target lacks: by its own reading of numbers, by characters, by formatted writes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rpl.diagnostics import Diagnostics, Severity, code
from rpl.passes.capabilities import RoutineRule
from rpl.passes.legalise.statements.calls import rewrite_calls
from rpl.source import Origin, source_from_text

from .executed import EVERYTHING, context, read, run

LACKED = {"text_value", "from_code", "character_code", "format", "text_part"}
BY_VALUE = replace(EVERYTHING, functions=EVERYTHING.functions - LACKED | {"text_part"})
BY_STATEMENT = replace(
    EVERYTHING,
    functions=EVERYTHING.functions - LACKED | {"format"},
    routines=replace(EVERYTHING.routines, rules=EVERYTHING.routines.rules - {RoutineRule.TEXT_RESULTS}),
)
PROGRAM = """.PROGRAM main()
        AUTO $s
        AUTO REAL n
        n = 66
        $s = "A"+$CHR(n)+$CHR(67)+$CHR(34)
        TYPE $s
        TYPE VAL($MID("12345",2,3))+1
        TYPE ASC("x")+ASC($s,2)
        TYPE "n is ", /F7.2, n/7, /I5, n
        IF $CHR(n) == "B" THEN
            TYPE "B"
        END
.END
"""


@pytest.mark.parametrize("target", [BY_VALUE, BY_STATEMENT])
def test_same_messages(target: object) -> None:
    program = read(PROGRAM, "vplus")
    given = context(program, target)  # type: ignore[arg-type]
    after = rewrite_calls(program, given)
    wanted = run(program).messages
    assert len(wanted) == 5
    assert run(after).messages == wanted


STOPPING = code("test-stops", Severity.LOSS, "no {what}", stops=True)
GUARD = code("test-guard", Severity.LOSS, "cannot say this: {what}")


def test_a_loss_is_named_once() -> None:
    source = source_from_text("a.txt", "one\ntwo\n")
    first, second = Origin(source, 0, 3), Origin(source, 4, 7)
    found = Diagnostics()
    found.report(STOPPING, first, what="tasks")
    written = len(found)
    for place, what in ((first, "TaskControl"), (second, "Move"), (second, "Move"), (second, "Wait")):
        found.report(GUARD, place, what=what)
    found.drop_repeated(0, written)
    assert [item.message for item in found] == ["no tasks", "cannot say this: Move", "cannot say this: Wait"]
