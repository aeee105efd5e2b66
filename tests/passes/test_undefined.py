"""Whether a variable has a value yet, in targets that cannot ask: known where it is assigned on every way; else the
question is refused at its place."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.refusing import refused

ROUTINES = {
    "may": ".PROGRAM may(a, b)\n IF b == 1 THEN\n a = 3\n END\n.END\n",
    "passed": ".PROGRAM passed(a, b)\n CALL may(a, b)\n.END\n",
    "both": ".PROGRAM both(a, low, high, done)\n IF DEFINED(low) THEN\n done = done+low\n END\n"
    " IF DEFINED(high) THEN\n done = done+high\n END\n.END\n",
    "given": ".PROGRAM given(a, done)\n done = DEFINED(a)\n.END\n",
}
# Statements, and what holds behind them.
CASES = {
    "assigned": ("n = 1", "DEFINED(n)"),
    "in every branch": ("i = 1\nIF i == 2 THEN\nn = 1\nELSE\nn = 2\nEND", "DEFINED(n)"),
    "counter": ("FOR i = 1 TO 0\nEND", "DEFINED(i)"),
    "of parameters behind one left out": ("m = 0\nCALL both(1, 2, 4, m)\nCALL both(1, , 8, m)", "m == 14"),
}
REFUSED = {
    "in a branch": ("IF q == 2 THEN\nn = 1\nEND", "DEFINED(n)", 6),
    "behind a jump": ("IF q == 1 GOTO 10\nn = 1\n10 q = 2", "DEFINED(n)", 6),
    "set by a routine": ("CALL may(n, 1)", "DEFINED(n)", 4),
    "set by a routine of a routine": ("CALL passed(n, 1)", "DEFINED(n)", 4),
    "an element": ("LOCAL a[9]\na[0] = 4", "NOT DEFINED(a[8])", 5),
    "a parameter": ("CALL given(n, i)", "NOT i", 9),
}


def read(text: str) -> ReadProgram:
    return read_sources([source_from_text("p.v2", text)], "vplus", Diagnostics())


def program(statements: str, holds: str) -> str:
    used = {name for name in ROUTINES if f"CALL {name}(" in statements}
    more = "".join(text for name, text in ROUTINES.items() if name in used or (name == "may" and "passed" in used))
    lines = f"AUTO n, m, i, q, $t\n{statements}\nIF {holds} THEN\nSIGNAL 1\nEND"
    return f".PROGRAM main()\n{lines}\n.END\n{more}"


@pytest.mark.parametrize("target", ["rapid", "krl", "tp", "inform", "urscript", "rpl"])
@pytest.mark.parametrize("name", CASES)
def test_the_answer_is_the_same(name: str, target: str) -> None:
    own = read(program(*CASES[name]))
    assert [value for _, _, value in run_program(own.program, entry="main").outputs] == [True]
    diagnostics = Diagnostics()
    written = translate_program(own, target, None, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS) if item.code.name != "tp-text-case"]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = written.renamed.get("main", "main")
    assert [value for _, _, value in run_program(back.program, entry=entry).outputs] == [True]


@pytest.mark.parametrize("target", ["rapid", "tp", "inform", "urscript"])
@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_followed_is_refused_at_its_place(name: str, target: str) -> None:
    statements, holds, line = REFUSED[name]
    told = refused(program(statements, holds), "vplus", target, "adept_viper_s650")
    assert told == [("value-question-lost", line)]
