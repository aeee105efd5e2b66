"""Programs as a plant writes them, which switch an output per expectation, on their own arm and in each target."""

from __future__ import annotations

import pytest
from test_krl_in_targets import TARGETS, missed, missed_in

from rpl.cell import Cell, parse_cell

# Inline forms as KSS 5 writes them: path data without APO_MODE.
OLDER_DATA: str | dict[str, str] = {
    "checks.src": """DEF CHECKS( )
BAS(#INITMOV,0)
PDAT_ACT=PPDAT1
FDAT_ACT=FP1
BAS(#PTP_PARAMS,60)
PTP XP1 C_PTP
LDAT_ACT=LCPDAT1
FDAT_ACT=FP1
BAS(#CP_PARAMS,0.2)
LIN XP2
WAIT SEC 0
IF (ABS($POS_ACT.X-500.0)<0.5) AND (ABS($VEL.CP-0.2)<0.001) THEN
  $OUT[1]=TRUE
ENDIF
END
""",
    "checks.dat": """DEFDAT CHECKS
DECL PDAT PPDAT1={VEL 100.0,ACC 100.0,APO_DIST 50.0}
DECL LDAT LCPDAT1={VEL 2.0,ACC 100.0,APO_DIST 20.0,APO_FAC 50.0,ORI_TYP #VAR}
DECL FDAT FP1={TOOL_NO 0,BASE_NO 0,IPO_FRAME #BASE,POINT2[] " "}
DECL E6POS XP1={X 480.0,Y 20.0,Z 340.0,A 180.0,B 0.0,C 180.0}
DECL E6POS XP2={X 500.0,Y 20.0,Z 300.0,A 180.0,B 0.0,C 180.0}
ENDDAT
""",
}
PULSE_ON_THE_WAY = """DEF CHECKS( )
DECL BOOL DURING
BAS(#INITMOV,0)
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
$VEL.CP=0.1
TRIGGER WHEN DISTANCE=1 DELAY=-200 DO PULSE($OUT[5],TRUE,0.4)
LIN_REL {Y 100.0}
WAIT SEC 0.1
DURING=$OUT[5]
WAIT SEC 0.6
IF DURING AND NOT $OUT[5] THEN
  $OUT[1]=TRUE
ENDIF
END
"""
# A door that opens stops a relative move; it goes on to the same end when the door is shut.
DOOR = """DEF CHECKS( )
INTERRUPT DECL 12 WHEN $IN[21]==TRUE DO OPENED( )
BAS(#INITMOV,0)
$OUT[10]=FALSE
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
WAIT SEC 0
BEGAN=$POS_ACT.Y
$VEL.CP=0.05
INTERRUPT ON 12
$OUT[38]=TRUE
LIN_REL {Y 120.0}
WAIT SEC 0
INTERRUPT OFF 12
IF (DOORS==1) AND (STOOD-BEGAN>10.0) AND (STOOD-BEGAN<100.0) AND (ABS($POS_ACT.Y-BEGAN-120.0)<0.5) THEN
  $OUT[1]=TRUE
ENDIF
END
DEF OPENED( )
BRAKE
STOOD=$POS_ACT.Y
DOORS=DOORS+1
$OUT[38]=FALSE
WAIT FOR NOT $IN[21]
END
"""
# A search: the routine of the interrupt asks where the robot was, brakes, and leaves the move.
CONTACT = """DEF CHECKS( )
DECL E6AXIS STAND
INTERRUPT DECL 10 WHEN $IN[22]==TRUE DO TOUCHED( )
BAS(#INITMOV,0)
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
WAIT SEC 0
BEGAN=$POS_ACT.Z
$VEL.CP=0.05
INTERRUPT ON 10
DOWN( )
INTERRUPT OFF 10
STAND=$AXIS_ACT
IF (BEGAN-TOUCH>20.0) AND (BEGAN-TOUCH<70.0) AND (ABS(TOUCH-$POS_ACT.Z)<5.0) THEN
  $OUT[1]=TRUE
ENDIF
IF ABS(TOUCH_A2-STAND.A2)<2.0 THEN
  $OUT[2]=TRUE
ENDIF
END
DEF DOWN( )
$OUT[39]=TRUE
LIN_REL {Z -100.0}
WAIT SEC 0
END
DEF TOUCHED( )
BRAKE
TOUCH=$POS_INT.Z
TOUCH_A2=$AXIS_INT.A2
RESUME
END
"""
CONTACT_DATA = "DEFDAT CHECKS\nDECL REAL BEGAN=0.0\nDECL REAL TOUCH=0.0\nDECL REAL TOUCH_A2=0.0\nENDDAT\n"
# A call some time behind the start of a move, and an output at a place of the path.
ON_THE_WAY = """DEF CHECKS( )
BAS(#INITMOV,0)
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
LIN {X 500.0,Y 0.0,Z 400.0,A 180.0,B 0.0,C 180.0}
WAIT SEC 0
$VEL.CP=0.1
TRIGGER WHEN PATH=-30.0 DELAY=0 DO $OUT[5]=TRUE
TRIGGER WHEN DISTANCE=0 DELAY=500 DO NOTE_PLACE( ) PRIO=-1
LIN {X 500.0,Y 120.0,Z 400.0}
WAIT SEC 0
IF (NOTED>30.0) AND (NOTED<60.0) AND $OUT[5] THEN
  $OUT[1]=TRUE
ENDIF
END
DEF NOTE_PLACE( )
NOTED=$POS_ACT.Y
END
"""
ON_THE_WAY_DATA = "DEFDAT CHECKS\nDECL REAL NOTED=0.0\nENDDAT\n"
# Timers that are stopped, read, and started again; by a routine, and where a choice decides whether they run.
STOPPED_TIMERS = """DEF CHECKS( )
DECL BOOL A
BAS(#INITMOV,0)
$TIMER[1]=-500
$TIMER_STOP[1]=FALSE
WAIT FOR $TIMER_FLAG[1]
$TIMER_STOP[1]=TRUE
WAIT SEC 0.7
IF ($TIMER[1]>=0) AND ($TIMER[1]<200) THEN
  $OUT[1]=TRUE
ENDIF
$TIMER_STOP[1]=FALSE
WAIT SEC 0.4
$TIMER_STOP[1]=TRUE
WAIT SEC 0.4
IF ($TIMER[1]>350) AND ($TIMER[1]<650) THEN
  $OUT[2]=TRUE
ENDIF
BEGIN_AT(1000)
WAIT SEC 0.3
IF ($TIMER[2]>1250) AND ($TIMER[2]<1400) THEN
  $OUT[3]=TRUE
ENDIF
A=$OUT[3]
IF A THEN
  $TIMER_STOP[2]=TRUE
ENDIF
WAIT SEC 0.5
IF ($TIMER[2]>1250) AND ($TIMER[2]<1450) THEN
  $OUT[4]=TRUE
ENDIF
$TIMER_STOP[2]=NOT A
WAIT SEC 0.5
IF $TIMER[2]>1700 THEN
  $OUT[5]=TRUE
ENDIF
END
DEF BEGIN_AT(MS:IN)
DECL INT MS
$TIMER[2]=MS
$TIMER_STOP[2]=FALSE
END
"""
# Timers count whole milliseconds: questions of equality, whole divisions, arguments, and a choice by them.
COUNTED_TIMERS = """DEF CHECKS( )
DECL INT I,N,K
DECL REAL S,R
BAS(#INITMOV,0)
$TIMER[6]=0
$TIMER_STOP[6]=FALSE
WAIT SEC 1.2304
$TIMER_STOP[6]=TRUE
I=$TIMER[6]
$OUT[1]=($TIMER[6]==I) AND NOT ($TIMER[6]<>I)
S=$TIMER[6]/1000
$OUT[2]=(S==1.0)
R=$TIMER[6]/1000.0
$OUT[3]=(ABS(R-1.23)<0.02)
S=$TIMER[6]
N=250
K=$TIMER[6]/N
$OUT[4]=(S==I) AND (K==4)
$OUT[5]=($TIMER[6]>=I) AND ($TIMER[6]<=I)
$TIMER[6]=-2500
$OUT[6]=($TIMER[6]/1000==-2) AND ($TIMER[6]==-2500)
$TIMER[6]=1999
$OUT[7]=(SECONDS($TIMER[6])==1)
SWITCH $TIMER[6]/1000
CASE 1
  $OUT[8]=TRUE
ENDSWITCH
$TIMER[7]=$TIMER[6]/2
$OUT[9]=($TIMER[7]==999)
N=$ROB_TIMER
WAIT SEC 0.55
K=($ROB_TIMER-N)/100
$OUT[10]=(K==5)
END
DEFFCT INT SECONDS(MS:IN)
DECL INT MS
RETURN MS/1000
ENDFCT
"""
# Timers that are set from what they show, while they run and while they are stopped.
CHANGED_TIMERS = """DEF CHECKS( )
DECL BOOL B
BAS(#INITMOV,0)
; what a running timer shows goes into what it gets
$TIMER[1]=0
$TIMER_STOP[1]=FALSE
WAIT SEC 0.6
$TIMER[1]=$TIMER[1]-500
WAIT SEC 0.3
$OUT[1]=($TIMER[1]>350) AND ($TIMER[1]<500)
$TIMER_STOP[1]=TRUE
$TIMER[1]=$TIMER[1]*2
WAIT SEC 0.5
$OUT[2]=($TIMER[1]>700) AND ($TIMER[1]<1000)
; set while it is stopped, and started later; set while it runs
$TIMER_STOP[2]=TRUE
$TIMER[2]=-200
WAIT SEC 0.3
$OUT[3]=($TIMER[2]==-200)
$TIMER_STOP[2]=FALSE
$TIMER[2]=-100
WAIT SEC 0.4
$OUT[4]=($TIMER[2]>250) AND ($TIMER[2]<400)
; a routine sets it
SET_IT(1000)
WAIT SEC 0.2
$OUT[5]=($TIMER[2]>1150) AND ($TIMER[2]<1350)
B=$OUT[5]
$TIMER_STOP[2]=B
SET_IT(50)
WAIT SEC 0.2
$OUT[6]=($TIMER[2]==50)
; one from another
$TIMER[3]=$TIMER[1]+$TIMER[2]
$OUT[7]=($TIMER[3]==$TIMER[1]+$TIMER[2])
$TIMER_STOP[2]=FALSE
$TIMER[2]=ABS($TIMER[2]-5000)
WAIT SEC 0.1
$OUT[8]=($TIMER[2]>5000) AND ($TIMER[2]<5200)
END
DEF SET_IT(MS:IN)
DECL INT MS
$TIMER[2]=MS
END
"""
DOOR_DATA = "DEFDAT CHECKS\nDECL REAL BEGAN=0.0\nDECL REAL STOOD=0.0\nDECL INT DOORS=0\nENDDAT\n"


def answers(output: int, signal: int, after: float) -> str:
    """A cell whose input follows an output."""
    return "".join(
        f'[[reaction]]\nwhen = "do{output}"\nbecomes = {value}\nafter = {after}\nsignal = "$IN[{signal}]"\n'
        f"value = {value}\n"
        for value in ("true", "false")
    )


PROGRAMS: dict[str, tuple[str | dict[str, str], int]] = {
    "older path data": (OLDER_DATA, 1),
    "a pulse on the way": (PULSE_ON_THE_WAY, 1),
    "a contact": ({"checks.src": CONTACT, "checks.dat": CONTACT_DATA}, 2),
    "a call on the way": ({"checks.src": ON_THE_WAY, "checks.dat": ON_THE_WAY_DATA}, 1),
    "stopped timers": (STOPPED_TIMERS, 5),
    "changed timers": (CHANGED_TIMERS, 8),
    "counted timers": (COUNTED_TIMERS, 10),
    "a door": ({"checks.src": DOOR, "checks.dat": DOOR_DATA}, 1),
}
CELLS = {"a door": answers(38, 21, 0.9), "a contact": answers(39, 22, 0.9)}
# What a language cannot say: (program, target) -> expectations that are missed, losses that say so.
REFUSED: dict[tuple[str, str], tuple[set[int], set[str]]] = {
    ("a call on the way", "vplus"): ({1}, {"vplus-guarded-stop"}),
    # The interrupt brakes a move that goes on behind it: only the robot's own interrupts do that.
    **{("a door", target): ({1}, {"interrupt-not-watched"}) for target in ("inform", "tp", "urscript")},
    ("a door", "vplus"): ({1}, {"braked-move-lost"}),
}


def cell_of(name: str) -> Cell | None:
    return parse_cell(CELLS[name]) if name in CELLS else None


@pytest.mark.parametrize("name", PROGRAMS)
def test_every_expectation_is_met_on_the_own_arm(name: str) -> None:
    assert missed(*PROGRAMS[name], cell_of(name)) == set()


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", PROGRAMS)
def test_every_expectation_is_met_in_other_languages(name: str, target: str) -> None:
    assert missed_in(*PROGRAMS[name], target, cell_of(name)) == REFUSED.get((name, target), (set(), set()))
