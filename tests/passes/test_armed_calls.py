"""Only what runs while a resuming interrupt may be on is left by it."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.interrupts.resumes import left_by_resumes
from rpl.project import read_sources
from rpl.source import source_from_text

KRL = """DEF T( )
DECL INT I
INTERRUPT DECL 12 WHEN $FLAG[1] DO FOUND( )
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}}
{body}
END
DEF QUIET( )
LIN_REL {{X 10.0}}
LIN_REL {{X -10.0}}
END
DEF LOUD( )
$FLAG[1]=TRUE
WAIT SEC 0.2
$OUT[2]=TRUE
END
DEF FOUND( )
INTERRUPT OFF 12
BRAKE
$FLAG[1]=FALSE
$OUT[1]=TRUE
RESUME
END
"""
ARM = "DEF ARM( )\nINTERRUPT ON 12\nEND\n"
PLAIN = "QUIET( )\nINTERRUPT ON 12\nLOUD( )\nINTERRUPT OFF 12"


@pytest.mark.parametrize(
    ("body", "asks"),
    [
        (PLAIN, False),
        (f"{PLAIN}\nQUIET( )", False),
        ("INTERRUPT ON 12\nLOUD( )\nQUIET( )", True),
        ("ARM( )\nLOUD( )\nINTERRUPT OFF 12\nQUIET( )", True),
        ("FOR I=1 TO 2\nQUIET( )\nINTERRUPT ON 12\nLOUD( )\nENDFOR", True),
        ("FOR I=1 TO 2\nQUIET( )\nINTERRUPT ON 12\nLOUD( )\nINTERRUPT OFF 12\nENDFOR", False),
        ("INTERRUPT ON 12\nLOUD( )\nIF $IN[1] THEN\nINTERRUPT OFF 12\nENDIF\nQUIET( )", True),
        ("LOOP\nINTERRUPT ON 12\nLOUD( )\nIF $IN[1] THEN\nEXIT\nENDIF\nINTERRUPT OFF 12\nENDLOOP\nQUIET( )", True),
        ("INTERRUPT ON 12\nLOUD( )\nI=12\nINTERRUPT OFF I\nQUIET( )", True),
        ("INTERRUPT ON\nLOUD( )\nINTERRUPT OFF\nQUIET( )", False),
        ("GOTO ON1\nON1:\nINTERRUPT ON 12\nLOUD( )\nINTERRUPT OFF 12\nQUIET( )", True),
    ],
)
def test_who_is_left(body: str, asks: bool) -> None:
    read = read_sources(
        [source_from_text("t.src", KRL.format(body=body) + (ARM if "ARM" in body else ""))], "krl", Diagnostics()
    )
    left = left_by_resumes(read.program)
    assert ("quiet" in left) is asks
    assert "loud" in left
