"""Interrupts on a number that the program counts: IPers of the number or its array, and the trap acts once each time
that the condition becomes true."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

DATA = """DEFDAT p PUBLIC
DECL GLOBAL INT count = 0
DECL GLOBAL INT many[3]
DECL GLOBAL INT hits = 0
ENDDAT
"""
# The condition becomes true three times: at 6, at 9 behind 2, and while the interrupt is on again.
PROGRAM = """&ACCESS RVP
DEF p()
many[1] = 0
many[2] = 0
many[3] = 0
{place} = 0
hits = 0
GLOBAL INTERRUPT DECL 20 WHEN {condition} DO hit()
INTERRUPT ON 20
{place} = 3
many[1] = 1
{place} = 6
WAIT SEC 0.1
{place} = 7
many[1] = 2
WAIT SEC 0.1
{place} = 2
WAIT SEC 0.1
{place} = 9
WAIT SEC 0.1
INTERRUPT OFF 20
{place} = 1
{place} = 8
WAIT SEC 0.1
INTERRUPT ON 20
many[3] = 4
WAIT SEC 0.1
{place} = 0
{place} = 6
WAIT SEC 0.1
$OUT[1] = hits == 3
END
DEF hit()
hits = hits + 1
END
"""


@pytest.mark.parametrize(
    ("place", "condition", "watched"),
    [("count", "count > 5", "IPers count,"), ("many[2]", "many[2] >= 6", "IPers many{2},"), ("count", "5 < count", "")],
)
def test_an_interrupt_comes_when_the_number_passes_the_limit(place: str, condition: str, watched: str) -> None:
    diagnostics = Diagnostics()
    program = PROGRAM.format(place=place, condition=condition)
    given = [source_from_text("p.src", program), source_from_text("p.dat", DATA)]
    read = read_sources(given, "krl", diagnostics)
    assert [each[2] for each in run_program(read.program, "kuka_kr6r900sixx").outputs] == [True]
    written = translate_program(read, "rapid", "kuka_kr6r900sixx", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert "interrupt-at-any-change" in {item.code.name for item in diagnostics}
    sources = [source_from_bytes(file.path, file.data) for file in written.files]
    assert watched in "".join(source.text for source in sources)
    back = read_sources(sources, "rapid", Diagnostics()).program
    result = run_program(back, "kuka_kr6r900sixx", entry=written.renamed.get("p", "p"))
    assert (result.status, [each[2] for each in result.outputs]) == ("finished", [True])
