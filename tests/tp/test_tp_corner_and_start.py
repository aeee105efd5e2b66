"""Joint corners whose distance is computed, actions where a way begins, joints as places, deep blocks."""

from __future__ import annotations

from tp_translating_helpers import ROBOTS, same_in_tp

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

CORNER = """DEF corner( )
DECL REAL WIDE
WIDE = 20.0
PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}
$APO.CPTP = 0
$APO.CDIS = WIDE
PTP {A1 20,A2 -90,A3 90,A4 0,A5 0,A6 0} C_DIS
PTP {A1 20,A2 -80,A3 90,A4 0,A5 0,A6 0}
$OUT[1] = TRUE
END
"""


def test_the_corner_of_a_joint_move_is_a_register_within_its_range() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.src", CORNER)], "krl", diagnostics)
    written = translate_program(read, "tp", ROBOTS["krl"], None, diagnostics)
    codes = [item.code.name for item in diagnostics]
    text = next(file.data.decode() for file in written.files if file.path == "CORNER.LS")
    assert not written.losses and "R[200:corner]=" in text
    assert "IF (R[200:corner]>100),R[200:corner]=(100) ;" in text and "CNT R[200:corner]" in text
    assert "tp-joint-corner" in codes


START = """DEF start( )
DECL FRAME THERE
PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
THERE = $POS_ACT
THERE.Z = THERE.Z + 40
TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE
LIN THERE
TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[2]=TRUE
LIN_REL {Z -30}
$OUT[3] = TRUE
END
"""


def test_actions_where_a_way_begins() -> None:
    files, _ = same_in_tp("krl", START)
    text = files["START.LS"]
    lines = [line.partition(":")[2].strip() for line in text.splitlines()]
    at = next(n for n, line in enumerate(lines) if line.startswith("DO[1]=ON"))
    assert lines[at + 1].startswith("L PR[")  # the length of this way is not known: in front of the move
    assert "DB 30.0mm,DO[2]=ON" in text


IN_A_CORNER = """DEF corner( )
DECL FRAME THERE
BAS(#INITMOV,0)
PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
PTP {A1 10,A2 -90,A3 90,A4 0,A5 30,A6 0} C_PTP
TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE
PTP {A1 20,A2 -90,A3 90,A4 0,A5 30,A6 0}
THERE = $POS_ACT
THERE.Z = THERE.Z - 40
LIN THERE C_DIS
THERE.Y = THERE.Y + 40
$OUT_C[2]=TRUE
TRIGGER WHEN DISTANCE=0 DELAY=-50 DO $OUT[3]=TRUE
LIN THERE
WAIT SEC 0
END
"""


def test_actions_where_a_way_of_unknown_length_begins_in_a_corner_stand_at_the_move_before() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.src", IN_A_CORNER)], "krl", diagnostics)
    written = translate_program(read, "tp", ROBOTS["krl"], None, diagnostics)
    assert not written.losses
    text = next(file.data.decode() for file in written.files if file.path == "CORNER.LS")
    moves = [line.partition(":")[2] for line in text.splitlines() if line.partition(":")[2][:2] in ("J ", "L ")]
    assert [move.count("DO[1]=ON") for move in moves] == [0, 1, 0, 0, 0]
    assert [move.count("DO[2]=ON") for move in moves] == [0, 0, 0, 1, 0]
    assert "TB 0.05sec,DO[3]=ON" in moves[3]


JOINTS_AS_PLACES = """CONST ready: JOINTS = {{j1: 0, j2: -90, j3: 90, j4: 0, j5: 60, j6: 0}}
PROCEDURE main()
    VAR t: TARGET
    t = joints_to_target(ready)
    MOVE TO t JOINT SPEED 30 %
    {then}
END PROCEDURE
"""


def test_registers_with_joints_in_place_of_a_pose_are_only_moved_to() -> None:
    """Where an element is asked for, which would be a joint, the assignment is refused: TP calculates no place."""
    refused = "the place of joint values and the joints of a place are not calculated"
    for then, told in (("SET do[1] TO TRUE", []), ("SET do[1] TO t.x > 100", [(4, refused)])):
        diagnostics = Diagnostics()
        read = read_sources([source_from_text("p.rpl", JOINTS_AS_PLACES.format(then=then))], "rpl", diagnostics)
        written = translate_program(read, "tp", ROBOTS["krl"], None, diagnostics)
        assert [(loss.origin.line, dict(loss.arguments)["reason"]) for loss in written.losses] == told
        main = next(file.data.decode() for file in written.files if file.path == "MAIN.LS")
        assert ("PAUSE ;" in main) == bool(told)
        assert ("PR[1:t]=P[1:ready] ;" in main) != bool(told)


def test_blocks_deeper_than_ten_are_jumps() -> None:
    deep = "".join(f"IF $IN[{n}]==FALSE THEN\n" for n in range(1, 13))
    back = "".join(f"ELSE\nK = {n}\nENDIF\n" if n % 2 else "ENDIF\n" for n in range(12, 0, -1))
    files, _ = same_in_tp("krl", f"DEF deep( )\nINT K\n{deep}K = 1\n{back}$OUT[1]=(K==1)\nEND\n")
    text = files["DEEP.LS"]
    assert text.count(") THEN ;") == 10 and "IF (!(DI[11]=OFF)),JMP LBL[1] ;" in text and "LBL[1:else] ;" in text
