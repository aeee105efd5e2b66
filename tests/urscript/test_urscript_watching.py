"""Path events, searches and interrupts of other languages as threads that watch: written, read back, run, compared."""

from __future__ import annotations

import pytest
from test_urscript_from_others import equal, translated

KRL = """DEF MAIN()
DECL INT N
N=0
$VEL.CP=0.2
$ACC.CP=1.2
$ADVANCE=3
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}}
LIN {{X 400,Y 0,Z 400,A 0,B 90,C 0}}
{lines}
$OUT[9]=TRUE
END

DEF COUNT(K:IN)
DECL INT K
$OUT[K]=TRUE
END
"""
AWAY = """
DEF AWAY()
LIN_REL {Z 10}
END
"""
LIN = "LIN {X 400,Y 100,Z 400,A 0,B 90,C 0}"
BACK = "LIN {X 400,Y 0,Z 400,A 0,B 90,C 0}"
ARC = "CIRC {X 400,Y 50,Z 450,A 0,B 90,C 0},{X 400,Y 100,Z 400,A 0,B 90,C 0}"


@pytest.mark.parametrize(
    "lines",
    [
        f"TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE\n{LIN}",
        f"TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[1]=TRUE\n{LIN}",
        f"TRIGGER WHEN DISTANCE=0 DELAY=200 DO $OUT[1]=TRUE\n{LIN}",
        f"TRIGGER WHEN DISTANCE=1 DELAY=200 DO $OUT[1]=TRUE\n{LIN}\nWAIT SEC 0.5",
        f"TRIGGER WHEN PATH=30 ONSTART DELAY=0 DO $OUT[1]=TRUE\n{LIN}",
        f"TRIGGER WHEN PATH=-30 DELAY=0 DO $OUT[1]=TRUE\n{LIN}",
        f"TRIGGER WHEN PATH=-30 DELAY=0 DO $OUT[1]=TRUE\nTRIGGER WHEN PATH=-10 DELAY=0 DO $OUT[1]=FALSE\n{LIN}",
        f"TRIGGER WHEN DISTANCE=1 DELAY=-50 DO $OUT[1]=TRUE\n{LIN}",
        f"TRIGGER WHEN DISTANCE=1 DELAY=-300 DO $OUT[1]=TRUE\n{LIN}",
        f"TRIGGER WHEN PATH=30 ONSTART DELAY=0 DO $OUT[1]=TRUE\n{ARC}",
        f"TRIGGER WHEN PATH=-30 DELAY=0 DO $OUT[1]=TRUE\n{ARC}",
        f"TRIGGER WHEN PATH=-300 DELAY=0 DO $OUT[1]=TRUE\n{LIN}",
        f"N=3\nTRIGGER WHEN PATH=-30 DELAY=0 DO COUNT(N) PRIO=-1\n{LIN}",
        f"FOR N=1 TO 2\nTRIGGER WHEN PATH=-30 DELAY=0 DO $OUT[1]=TRUE\n{LIN}\n{BACK}\n$OUT[1]=FALSE\nENDFOR",
        "$APO.CDIS=10\nTRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[1]=TRUE\n"
        f"{LIN} C_DIS\nLIN {{X 500,Y 100,Z 400,A 0,B 90,C 0}}",
        f"$APO.CDIS=10\n{LIN} C_DIS\nTRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE\n"
        "LIN {X 500,Y 100,Z 400,A 0,B 90,C 0}",
    ],
)
def test_actions_come_at_their_place_on_the_path(lines: str) -> None:
    equal("krl", KRL.format(lines=lines))


def test_an_action_that_moves_is_refused_by_name() -> None:
    lines = f"TRIGGER WHEN PATH=-30 DELAY=0 DO AWAY() PRIO=-1\n{LIN}"
    _, losses, proof = translated("krl", KRL.format(lines=lines) + AWAY)
    assert "path-event-lost" in losses and not proof.equal
