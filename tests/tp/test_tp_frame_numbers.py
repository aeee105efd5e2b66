"""Named tools and frames are numbers of the controller's tables, selected once where they begin to hold."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program
from rpl.writing.namemap import NameMap
from tests.tp.tp_translating_helpers import same_in_tp

RAPID = """MODULE cell
  PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wobj3:=[FALSE,TRUE,"",[[0,20,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  TASK PERS wobjdata wobjBelt:=[FALSE,TRUE,"",[[0,-20,5],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget pA:=[[300,0,200],[0,1,0,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ pA,v200,fine,tGrip\\WObj:=wobj3;
    take;
    MoveL Offs(pA,0,0,50),v200,fine,tGrip\\WObj:=wobj3;
    belt;
    MoveL pA,v200,fine,tGrip\\WObj:=wobj3;
  ENDPROC
  PROC take()
    WaitTime 0.1;
    MoveL Offs(pA,0,0,20),v200,fine,tGrip\\WObj:=wobj3;
  ENDPROC
  PROC belt()
    MoveL pA,v200,fine,tGrip\\WObj:=wobjBelt;
  ENDPROC
ENDMODULE
"""


def selections(listing: str) -> list[str]:
    lines = [line.partition(":")[2].removesuffix(" ;").strip() for line in listing.splitlines()]
    return [
        line if "_NUM=" in line else "move" for line in lines if "_NUM=" in line or "mm/sec" in line or "% " in line
    ]


def test_a_number_is_selected_where_it_begins_to_hold() -> None:
    files, _ = same_in_tp("rapid", RAPID)
    both = ["UFRAME_NUM=3", "UTOOL_NUM=1", "move"]
    assert selections(files["MAIN.LS"]) == [*both, "move", "UFRAME_NUM=3", "move"]
    assert selections(files["TAKE.LS"]) == both
    assert selections(files["BELT.LS"]) == ["UFRAME_NUM=1", *both[1:]]
    assert "UF : 3, UT : 1" in files["MAIN.LS"] and "UF : 1, UT : 1" in files["BELT.LS"]
    assert not any("]=LPOS" in text or "UFRAME[" in text or "UTOOL[" in text for text in files.values())


def test_the_values_stand_in_the_dump_of_frames() -> None:
    read = read_sources([source_from_text("cell.mod", RAPID)], "rapid", Diagnostics())
    written = translate_program(read, "tp", "fanuc_lrmate200id", None, Diagnostics())
    (dump,) = (file.data.decode("ascii") for file in written.files if file.path == "SYSFRAME.VA")
    assert "[1,3]" in dump and "Y:    20.000" in dump and "Z:   120.000" in dump
    assert {written.registers[one] for one in (("UFRAME", 1), ("UFRAME", 3))} == {"wobjBelt", "wobj3"}
    assert written.registers["UTOOL", 1] == "tGrip"
    kept = translate_program(
        read, "tp", "fanuc_lrmate200id", None, Diagnostics(), NameMap(numbers={("UTOOL", 4): "tGrip"})
    )
    assert kept.registers["UTOOL", 4] == "tGrip"


CHANGED = RAPID.replace("    belt;\n", "    wobjBelt.uframe.trans.y:=-10;\n    belt;\n")


def test_a_frame_that_the_program_changes_is_handed_over_where_it_is_selected() -> None:
    files, _ = same_in_tp("rapid", CHANGED)
    assert "UFRAME[1]=PR[" in files["BELT.LS"] and "UFRAME_NUM=3" in files["MAIN.LS"]
