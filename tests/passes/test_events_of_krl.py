"""Events before KRL moves as RAPID's stored events: those that are still to come, and early ones by the modal speed."""

import re

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.analog_wiring import WIRED

KUKA = "kuka_kr6r900sixx"
PLACE = "{{X {x},Y {y},Z 400,A 180,B 0,C 180}}"
HEAD = """DEF SEAM( )
DECL INT N
BAS(#INITMOV,0)
$BASE=$NULLFRAME
$TOOL=$NULLFRAME
$APO.CDIS=20
$VEL.CP=0.1
PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}
"""
CALLED = "DEF DOT( )\nDOTS=DOTS+1\n$ANOUT[1]=DOTS*0.1\nEND\n"
DATA = "DEFDAT SEAM\nDECL INT DOTS=0\nENDDAT\n"


def place(x: float, y: float) -> str:
    return PLACE.format(x=x, y=y)


def in_rapid(body: str) -> tuple[str, list[tuple[float, float]]]:
    """The text, and when the analogue output got which share of its 10 V."""
    sources = [source_from_text("seam.src", f"{HEAD}{body}END\n{CALLED}"), source_from_text("seam.dat", DATA)]
    diagnostics = Diagnostics()
    read = read_sources(sources, "krl", diagnostics)
    files = translate_program(read, "rapid", KUKA, None, diagnostics, analog=WIRED).files
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "rapid", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    result = run_program(back.program, KUKA, controller="plain")
    assert result.status == "finished", result.fault
    text = "\n".join(one.data.decode("latin-1") for one in files)
    return text, [(t, float(value) / 10.0) for t, name, value in result.outputs if name == "ao1"]


def test_a_corner_does_not_forget_the_event_of_the_move_before() -> None:
    body = (
        f"LIN {place(500, 0)}\nFOR N=1 TO 3\nTRIGGER WHEN DISTANCE=1 DELAY=0 DO DOT( ) PRIO=-1\n"
        f"LIN_REL {{Y 50}} C_DIS\nENDFOR\nLIN {place(550, 150)}\nWAIT SEC 0\n"
    )
    text, values = in_rapid(body)
    assert [value for _, value in values] == pytest.approx([0.1, 0.2, 0.3])
    connected = re.search(r"IF NOT (\w+) THEN\s+CONNECT \w+ WITH \w+;\s+(\w+):=TRUE;", text)
    assert connected and connected[1] == connected[2]


@pytest.mark.parametrize("event", ["DISTANCE=1 DELAY=-500", "PATH=0 DELAY=-500"])
def test_an_early_event_stands_at_the_place_that_the_modal_speed_says(event: str) -> None:
    # 0.5 s before the end at 100 mm/s: 50 mm, less the millimetre that braking with 5 m/s2 takes away
    text, values = in_rapid(
        f"LIN {place(500, 0)}\nTRIGGER WHEN {event} DO DOT( ) PRIO=-1\nLIN {place(500, 150)}\nWAIT SEC 0\n"
    )
    assert re.search(r"TriggInt \w+,49,", text) and len(values) == 1
