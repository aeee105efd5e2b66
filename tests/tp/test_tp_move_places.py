"""A shift by constants is said at the move, on the taught point; a place in a named frame is one in that user frame."""

from __future__ import annotations

from tests.tp.tp_translating_helpers import same_in_tp

RAPID = """MODULE cell
  PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  CONST robtarget pA:=[[300,0,200],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST num nAbove:=40;
  VAR num nSide:=5;
  PROC main()
    MoveJ Offs(pA,0,0,nAbove),v200,fine,tGrip;
    MoveL pA,v200,fine,tGrip;
    MoveL RelTool(pA,0,0,-25),v200,fine,tGrip;
    MoveL Offs(pA,0,0,nAbove),v200,fine,tGrip;
    nSide:=nSide+1;
    MoveL Offs(pA,nSide,0,0),v200,fine,tGrip;
  ENDPROC
ENDMODULE
"""
VPLUS = """.PROGRAM main()
TOOL TRANS(0,0,50)
SET table = TRANS(300,20,100,0,0,0)
MOVE #PPOINT(0,-90,180,0,45,0)
BREAK
MOVE table:place
BREAK
CALL again()
MOVES SHIFT(world BY 0,0,10)
BREAK
.END
.PROGRAM again()
MOVES table:place
BREAK
.END
.LOCATIONS
table 300 20 100 0 0 0
place 50 0 100 0 180 0
world 350 20 200 0 180 0
.END
"""


def moves(listing: str) -> list[str]:
    lines = [line.partition(":")[2].removesuffix(" ;").strip() for line in listing.splitlines()]
    return [line for line in lines if line.startswith(("L P", "J P"))]


def test_a_constant_shift_is_an_offset_of_the_taught_point() -> None:
    files, _ = same_in_tp("rapid", RAPID)
    first, second, third, fourth, last = moves(files["MAIN.LS"])
    assert first.startswith("J P[1:pA] ") and first.endswith("Offset,PR[1:shift_z40]")
    assert second == "L P[1:pA] 200mm/sec FINE"
    assert third.endswith("FINE Tool_Offset,PR[2:shift_zm25]")
    assert fourth == "L P[1:pA] 200mm/sec FINE Offset,PR[1:shift_z40]"
    assert last.startswith("L PR[")  # the run decides how far


def test_a_place_seen_from_a_named_frame_is_in_that_user_frame() -> None:
    files, _ = same_in_tp("vplus", VPLUS.replace("SET table = TRANS(300,20,100,0,0,0)\n", ""))
    assert "UFRAME_NUM=1" in files["AGAIN.LS"] and "UFRAME_NUM=0" in files["MAIN.LS"]
    assert not any("COMPOSE" in name for name in files)


def test_where_the_robot_is_looked_at_the_world_stays_in_force() -> None:
    looking = VPLUS.replace("SET table = TRANS(300,20,100,0,0,0)", "HERE now").replace(
        "BREAK\n.END", "BREAK\nHERE now\n.END"
    )
    files, _ = same_in_tp("vplus", looking)
    assert "UFRAME_NUM=1" not in files["AGAIN.LS"]
