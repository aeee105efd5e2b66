"""Calls with arguments by interrupts and places on the path."""

from __future__ import annotations

import pytest
from there_and_back import entry_of

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
START = """DEF JOB()
DECL INT N
INTERRUPT DECL 20 WHEN $FLAG[1] DO COUNT(2)
INTERRUPT DECL 21 WHEN $FLAG[2] DO COUNT(10)
BAS(#INITMOV,0)
TOTAL=0
PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
"""
END = """END
DEF COUNT(K:IN)
DECL INT K
TOTAL=TOTAL+K
END
DEF RAISE(K:IN)
DECL INT K
$FLAG[K]=TRUE
WAIT SEC 0.1
$FLAG[K]=FALSE
WAIT SEC 0.1
END
"""
DATA = "DEFDAT JOB\nDECL INT TOTAL=0\nENDDAT\n"
PATHS = {
    "constants": """TRIGGER WHEN DISTANCE=1 DELAY=0 DO COUNT(3) PRIO=-1
LIN_REL {Z -90.0}
WAIT SEC 0.1
$OUT[1]=(TOTAL==3)
""",
    "variables of the routine": """N=4
TRIGGER WHEN DISTANCE=1 DELAY=0 DO COUNT(N+1) PRIO=-1
LIN_REL {Z -90.0}
WAIT SEC 0.1
$OUT[1]=(TOTAL==5) AND (N==4)
""",
    "a pulse": """$OUT[5]=FALSE
TRIGGER WHEN DISTANCE=1 DELAY=0 DO PULSE($OUT[5],TRUE,0.1)
LIN_REL {Z -90.0}
WAIT SEC 0.3
$OUT[1]=NOT $OUT[5]
""",
    "the same call twice": """TRIGGER WHEN DISTANCE=1 DELAY=0 DO COUNT(3) PRIO=-1
LIN_REL {Z -90.0}
TRIGGER WHEN DISTANCE=1 DELAY=0 DO COUNT(3) PRIO=-1
LIN_REL {Z 50.0}
WAIT SEC 0.1
$OUT[1]=(TOTAL==6)
""",
}


def translated(body: str, target: str) -> list[str]:
    """The losses; the translation runs as the source, with every output on."""
    files = [source_from_text("job.src", START + body + END), source_from_text("job.dat", DATA)]
    read = read_sources(files, "krl", Diagnostics())
    told, again = Diagnostics(), Diagnostics()
    written = translate_program(read, target, KUKA, None, told)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, again)
    assert not [item.as_text() for item in again.of(Severity.ERROR)]
    result = prove_programs(read.program, back.program, KUKA, entry="JOB", to_entry=entry_of(written, "JOB"))
    assert result.agrees, result.as_text()
    return [item.as_text() for item in told.of(Severity.LOSS)]


@pytest.mark.parametrize("target", ["rapid", "vplus", "tp", "urscript", "inform"])
@pytest.mark.parametrize("name", PATHS)
def test_calls_on_the_path_have_arguments(name: str, target: str) -> None:
    assert not translated(PATHS[name], target)


@pytest.mark.parametrize(("target", "told"), [("rapid", True), ("urscript", True), ("vplus", False)])
def test_an_interrupt_that_waits_for_another_one_is_told(target: str, told: bool) -> None:
    text = (START + END).replace("DO COUNT(10)", "DO SLOW()") + "DEF SLOW()\nWAIT SEC 0.5\nEND\n"
    files = [source_from_text("job.src", text), source_from_text("job.dat", DATA)]
    found = Diagnostics()
    translate_program(read_sources(files, "krl", Diagnostics()), target, KUKA, None, found)
    assert ("interrupts-not-nested" in [item.code.name for item in found]) is told


ASSIGNED = """DEF JOB()
INTERRUPT DECL 20 WHEN $FLAG[1] DO $OUT[3]=TRUE
$OUT[3]=FALSE
INTERRUPT ON 20
$FLAG[1]=TRUE
WAIT SEC 0.2
INTERRUPT OFF 20
$OUT[1]=$OUT[3]
END
"""


def test_an_assignment_as_the_action_where_reactions_call_programs() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("job.src", ASSIGNED)], "krl", diagnostics)
    translation = translate_program(read, "vplus", KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "vplus", Diagnostics())
    result = run_program(back.program, KUKA, None, entry_name(read.program, None), 10.0)
    assert [(signal, value) for _, signal, value in result.outputs if value][-1] == ("1", True)
