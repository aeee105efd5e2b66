"""A register of TP whose comment is a word has it as its name elsewhere, with its number as the remark.

With that remark it has its number again. A remark that says more than a number stays a remark."""

import re

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.tp.tp_translating_helpers import same_in_tp

RAPID = """MODULE n
  PERS num count:=0; !R7
  PERS num total:=0; !R9 is another one
  VAR num other:=2; !R7
  PERS num inner:=3; !R12
  PERS robtarget above:=[[300,0,200],[0,1,0,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]]; !PR10
  PROC main()
    VAR num inner:=1;
    count:=count+1;
    total:=total+other+inner;
    MoveL above,v200,fine,tool0;
  ENDPROC
ENDMODULE
"""
TP = """/PROG  COUNTING
/MN
   1:  UFRAME_NUM=0 ;
   2:  UTOOL_NUM=1 ;
   3:  R[12:Parts]=R[12:Parts]+1 ;
   4:  R[3:Limit]=20 ;
   5:  IF (R[12:Parts]>R[3:Limit]) THEN ;
   6:  R[12:Parts]=0 ;
   7:  ENDIF ;
/POS
/END
"""


def test_a_remark_that_is_a_number_is_the_number() -> None:
    files, _ = same_in_tp("rapid", RAPID)
    text = "".join(files.values())
    assert set(re.findall(r"R\[(\d+):(\w+)\]", text)) >= {("7", "count"), ("10", "above")}
    assert not {"7", "9", "12"} & {
        number for number, name in re.findall(r"\bR\[(\d+):(\w+)\]", text) if name != "count"
    }
    assert "PR[10:above] 200mm/sec FINE" in text


def test_registers_keep_their_numbers_there_and_back() -> None:
    read = read_sources([source_from_text("counting.ls", TP)], "tp", Diagnostics())
    for between in ("krl", "rapid"):
        there = translate_program(read, between, "fanuc_m10ia", None, Diagnostics())
        written = [source_from_bytes(file.path, file.data) for file in there.files if not file.path.endswith(".toml")]
        back = translate_program(
            read_sources(written, between, Diagnostics()), "tp", "fanuc_m10ia", None, Diagnostics()
        )
        text = "".join(file.data.decode("ascii") for file in back.files if file.path.endswith(".LS"))
        assert set(re.findall(r"\bR\[(\d+):(\w+)\]", text)) == {("12", "Parts"), ("3", "Limit")}, between


KEPT = """MODULE n
  PERS num R51:=0;
  PERS num limit:=0; !R9
  PERS num fixed:=40;
  PROC main()
    SpeedRefresh R51;
    IF limit<fixed THEN
      SetDO do1,1;
    ENDIF
  ENDPROC
ENDMODULE
"""


def test_registers_that_nothing_sets_stay_registers() -> None:
    """People set them on the controller; data that says no number is its value."""
    read = read_sources([source_from_text("n.mod", KEPT)], "rapid", Diagnostics())
    written = translate_program(read, "tp", "fanuc_m10ia", None, Diagnostics())
    (text,) = (file.data.decode("ascii") for file in written.files if file.path == "MAIN.LS")
    assert "OVERRIDE=R[51:R51]" in text and "R[9:limit]<40" in text
