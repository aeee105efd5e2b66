"""Tools and frames that a TP program selects by their numbers: data with names, a number of the target, or the robot's
own coordinates, and nothing of the table that the program does not use."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

POINT = "X = 800 mm, Y = 0 mm, Z = 600 mm, W = 180 deg, P = 0 deg, R = 0 deg"
PROGRAM = """/PROG MAIN
/MN
   1:  UFRAME_NUM={frame} ;
   2:  UTOOL_NUM=1 ;
   3:L P[1] 100mm/sec FINE ;
/POS
P[1]{{
 GP1:
 UF : {frame}, UT : 1, CONFIG : 'N U T, 0, 0, 0',
 {point}
}};
/END
"""


def translated(target: str, frame: int) -> str:
    text = PROGRAM.format(frame=frame, point=POINT)
    read = read_sources([source_from_text("MAIN.LS", text)], "tp", Diagnostics())
    done = translate_program(read, target, "fanuc_m10ia", None, Diagnostics())
    return "\n".join(source_from_bytes(file.path, file.data).text for file in done.files)


# target, lines with frame 0 (the robot's own), lines with frame 2
CASES = [
    ("krl", ("FP1={TOOL_NO 1,BASE_NO 0,", "Tool[1]"), ("FP1={TOOL_NO 1,BASE_NO 2,", "Tool[1]")),
    ("rapid", ("MoveL P1,v100,fine,tool1;",), ("MoveL P1,v100,fine,tool1\\WObj:=wobj2;",)),
    ("urscript", ("set_tcp(tool1)", "movel(p1,"), ("set_tcp(tool1)", "movel(pose_trans(frame2, p1),")),
    ("vplus", ("TOOL tool1", "MOVES p1"), ("TOOL tool1", "MOVES frame2:p1")),
    ("inform", ("///TOOL 1", "MOVL C00000 V=100.0 PL=0"), ("///TOOL 1", "///USER 2", "MOVL C00000 V=100.0 PL=0")),
]


@pytest.mark.parametrize(("target", "own", "second"), CASES, ids=[case[0] for case in CASES])
def test_what_the_program_selects(target: str, own: tuple[str, ...], second: tuple[str, ...]) -> None:
    for frame, lines in ((0, own), (2, second)):
        text = translated(target, frame)
        for line in lines:
            assert line in text, (frame, line)
        for gone in ("uframe[1]", "uframe[3]", "uframe_num", "utool_num"):
            assert gone not in text.lower()


def test_nothing_is_stored_at_the_start_of_an_inform_job() -> None:
    """What a register holds stands on the controller only, here as there."""
    text = "/PROG MAIN\n/MN\n   1:  R[1]=R[2]+1 ;\n   2:  R[2]=R[1] ;\n/POS\n/END\n"
    read = read_sources([source_from_text("MAIN.LS", text)], "tp", Diagnostics())
    done = translate_program(read, "inform", None, None, Diagnostics())
    job = next(source_from_bytes(file.path, file.data).text for file in done.files if file.path.endswith(".JBI"))
    assert "SET R002 0" not in job and "SET R001 0" not in job
