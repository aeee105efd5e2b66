"""Path events, searches and interrupts of other languages as threads that watch: written, read back, run, compared."""

from __future__ import annotations

import pytest
from test_urscript_from_others import equal, translated

from rpl.cell import Cell, Input

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
    assert "path-event-lost" in losses and not proof.agrees


def cell(*inputs: tuple[float, str, bool]) -> Cell:
    return Cell(inputs=tuple(Input(time, signal, value) for time, signal, value in inputs))


INTERRUPTED = """DEF MAIN()
DECL INT N
N=0
$VEL.CP=0.02
$ACC.CP=1.2
$ADVANCE=3
$APO.CDIS=10
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}}
{declared}
INTERRUPT ON 10
{lines}
INTERRUPT OFF 10
LIN {{X 400,Y 0,Z 400,A 0,B 90,C 0}}
$OUT[9]=TRUE
END

DEF WAY()
LIN {{X 400,Y 0,Z 400,A 0,B 90,C 0}}
LIN {{X 400,Y 200,Z 400,A 0,B 90,C 0}}
$OUT[8]=TRUE
END

DEF CORNERS()
LIN {{X 400,Y 0,Z 400,A 0,B 90,C 0}}
LIN {{X 400,Y 100,Z 400,A 0,B 90,C 0}} C_DIS
LIN {{X 500,Y 100,Z 400,A 0,B 90,C 0}}
$OUT[8]=TRUE
END

DEF WAITING()
WAIT SEC 8
WAIT FOR $IN[2]
$OUT[8]=TRUE
END
"""


def same_events(language: str, text: str, inputs: Cell) -> str:
    """The script of a program that does the same in the same order; where the robot is when a signal comes depends on
    how fast each controller accelerates."""
    script, losses, proof = translated(language, text, inputs)
    assert not losses, script
    assert proof.level == "geometry" or (proof.difference is not None and proof.difference.kind == "place"), (
        f"{proof.as_text()}\n{script}"
    )
    return script


HANDLERS = {
    "LIT": "$OUT[1]=NOT $OUT[1]",
    "HELD": "$OUT[1]=TRUE\nWAIT FOR NOT $IN[1]\n$OUT[1]=FALSE",
    "BRAKED": "BRAKE\n$OUT[1]=TRUE\nWAIT SEC 0.5\n$OUT[1]=FALSE",
    "LEFT": "BRAKE\n$OUT[1]=TRUE\nRESUME",
}


def handled(handler: str, lines: str) -> str:
    """A program whose interrupt 10 is on around these lines."""
    declared = f"INTERRUPT DECL 10 WHEN $IN[1] DO {handler}()"
    return INTERRUPTED.format(declared=declared, lines=lines) + f"\nDEF {handler}()\n{HANDLERS[handler]}\nEND\n"


PULSE = cell((12.0, "$IN[1]", True), (13.0, "$IN[1]", False), (30.0, "$IN[2]", True))
TWICE = cell((12.0, "$IN[1]", True), (13.0, "$IN[1]", False), (14.0, "$IN[1]", True))


ACTS = [("LIT", "WAY"), ("LIT", "CORNERS"), ("LEFT", "WAY"), ("LEFT", "CORNERS")]
WAITS = [(handler, "WAITING") for handler in HANDLERS]


@pytest.mark.parametrize(("handler", "routine"), [*ACTS, *WAITS])
def test_interrupts_act_while_the_program_waits(handler: str, routine: str) -> None:
    same_events("krl", handled(handler, f"{routine}()"), PULSE)


@pytest.mark.parametrize("routine", ["WAY", "CORNERS"])
def test_an_interrupt_acts_although_its_signal_is_gone_when_the_robot_stands(routine: str) -> None:
    short = cell((12.0, "$IN[1]", True), (12.003, "$IN[1]", False), (30.0, "$IN[2]", True))
    same_events("krl", handled("LEFT", f"{routine}()"), short)


@pytest.mark.parametrize("handler", ["HELD", "BRAKED"])
@pytest.mark.parametrize("routine", ["WAY", "CORNERS"])
def test_one_that_takes_time_or_stops_a_move_that_goes_on_is_refused_where_it_is_declared(
    handler: str, routine: str
) -> None:
    script, losses, _ = translated("krl", handled(handler, f"{routine}()"), PULSE)
    assert losses == ["interrupt-not-watched"] and script.count("halt") == 1, script


@pytest.mark.parametrize(
    "lines",
    [
        "WAY()",
        "INTERRUPT OFF 10\nWAY()\nINTERRUPT ON 10",
    ],
)
def test_an_interrupt_comes_at_each_edge_while_it_is_on(lines: str) -> None:
    script = same_events("krl", handled("LIT", lines), TWICE)
    assert "enter_critical" in script


RAPID = """MODULE M
VAR robtarget pFound;
CONST robtarget pFar:=[[300,200,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget pNear:=[[300,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
  MoveAbsJ [[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
  MoveL pNear,v50,fine,tool0;
  {search}
  Set do2;
  IF pFound.trans.y > 20 AND pFound.trans.y < 190 Set do3;
ERROR
  IF ERRNO=ERR_WHLSEARCH THEN
    Set do4;
    TRYNEXT;
  ELSEIF ERRNO=ERR_SIGSUPSEARCH THEN
    Set do5;
    TRYNEXT;
  ENDIF
ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("stop", ["\\Stop,", "\\PStop,", "\\SStop,", " "])
@pytest.mark.parametrize(
    "inputs", [((25.0, "di1", True),), (), ((0.1, "di1", True),)], ids=["found", "nothing", "already"]
)
def test_searches_keep_the_place(stop: str, inputs: tuple[tuple[float, str, bool], ...]) -> None:
    equal("rapid", RAPID.format(search=f"SearchL{stop}di1,pFound,pFar,v10,tool0;"), cell(*inputs))


def test_a_task_gets_its_arguments_by_data() -> None:
    text = """.PROGRAM main()
        beats = 0
        EXECUTE 2 beat(3)
        WAIT beats == 3
        SIGNAL 1
.END
.PROGRAM beat(count)
        AUTO REAL i
        FOR i = 1 TO count
            WAIT.EVENT , 0.2
            beats = beats+1
        END
.END
"""
    assert "thread beat():" in equal("vplus", text)
