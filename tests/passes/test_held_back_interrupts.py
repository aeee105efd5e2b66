"""What comes and goes while interrupts are locked or disabled is remembered, and acts when they may act again.

V+ Language User's Guide, REACT: an event that comes while its priority is not above the program's waits until the
priority goes down. KUKA Expert Programming, INTERRUPT DISABLE: an interrupt that is detected while it is disabled is
stored and executed when it is enabled again. M: both from memory, to be looked up.
"""

from __future__ import annotations

import pytest

from rpl.cell import parse_cell
from tests.there_and_back import there_and_back

LOCKED = """.PROGRAM main()
        REACT 1001, hit, 5
        WAIT.EVENT , 0.5
        LOCK 10
        WAIT.EVENT , 1
        LOCK 0
        WAIT.EVENT , 0.5
        IGNORE 1001
        REACT 1001, hit, 5
        WAIT.EVENT , 0.5
.END
.PROGRAM hit()
        SIGNAL 1
        WAIT.EVENT , 0.05
        SIGNAL -1
.END
"""
DISABLED = """DEF main()
INTERRUPT DECL 5 WHEN $IN[1]==TRUE DO hit()
INTERRUPT ON 5
WAIT SEC 0.5
INTERRUPT DISABLE
WAIT SEC 1
INTERRUPT ENABLE
WAIT SEC 0.5
INTERRUPT OFF 5
INTERRUPT ON 5
WAIT SEC 0.5
END
DEF hit()
$OUT[1]=TRUE
WAIT SEC 0.05
$OUT[1]=FALSE
END
"""
PROGRAMS = {"vplus": ("main.v2", LOCKED, "1001"), "krl": ("main.src", DISABLED, "$IN[1]")}


@pytest.mark.parametrize("language", PROGRAMS)
@pytest.mark.parametrize("target", ["rapid", "krl", "vplus", "rpl"])
def test_what_comes_and_goes_is_remembered(language: str, target: str) -> None:
    name, text, signal = PROGRAMS[language]
    given = there_and_back({name: text}, language, target)
    assert not given.losses
    cell = parse_cell(f'[[input]]\ntime = 1.0\nsignal = "{signal}"\nvalue = true\nduration = 0.1\n')
    times = [(round(t, 1), value) for t, _, value in given.run(cell=cell).outputs]
    assert times == [(1.5, True), (1.6, False)] or times == [(1.5, True), (1.5, False)]


@pytest.mark.parametrize("language", PROGRAMS)
def test_a_program_that_looks_itself_says_that_it_does_not(language: str) -> None:
    name, text, _ = PROGRAMS[language]
    given = there_and_back({name: text}, language, "urscript")
    assert not given.losses and "interrupt-not-noted" in {item.code.name for item in given.found}
