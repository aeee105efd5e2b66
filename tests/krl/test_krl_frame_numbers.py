"""Named tools and bases of other languages are numbers of the controller's tables, whose values and names stand in
`$config.dat`; the numbers are those of the source where it has some, and stay."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import Translation, translate_program
from rpl.writing.namemap import NameMap, map_text, parse_map

RAPID = """MODULE cell
  ! One part, two stations
  PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  ! the fixture of station three
  TASK PERS wobjdata wobj3:=[FALSE,TRUE,"",[[0,20,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  TASK PERS wobjdata wobjBelt:=[FALSE,TRUE,"",[[0,-20,5],[0.7071068,0,0,0.7071068]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget pA:=[[300,0,200],[0,1,0,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ pA,v200,fine,tGrip\\WObj:=wobj3;
    MoveL pA,v200,fine,tGrip\\WObj:=wobjBelt;
  ENDPROC
ENDMODULE
"""
TP = """/PROG P
/MN
   1:  UFRAME_NUM=2 ;
   2:  UTOOL_NUM=4 ;
   3:J P[1] 50% FINE ;
/POS
P[1]{
   GP1:
        UF : 2, UT : 4,  CONFIG : 'N U T, 0, 0, 0',
        X = 500 mm, Y = 0 mm, Z = 400 mm, W = 180 deg, P = 0 deg, R = 0 deg
};
/END
"""


def krl(
    language: str, name: str, text: str, earlier: NameMap | None = None
) -> tuple[dict[str, list[str]], Translation]:
    read = read_sources([source_from_text(name, text)], language, Diagnostics())
    found = Diagnostics()
    done = translate_program(read, "krl", None, None, found, *([earlier] if earlier else []))
    return {one.path: one.data.decode("cp1252").splitlines() for one in done.files}, done


def test_values_and_names_stand_in_the_controllers_list() -> None:
    files, done = krl("rapid", "cell.mod", RAPID)
    assert files["$config.dat"] == [
        "DEFDAT $config PUBLIC",
        ";For the tables of the controller's own $config.dat",
        "TOOL_DATA[1]={X 0.0,Y 0.0,Z 120.0,A 0.0,B 0.0,C 0.0}",
        'TOOL_NAME[1,]="tGrip"',
        "BASE_DATA[1]={X 0.0,Y -20.0,Z 5.0,A 90.0,B 0.0,C 0.0}",
        'BASE_NAME[1,]="wobjBelt"',
        "; the fixture of station three",
        "BASE_DATA[3]={X 0.0,Y 20.0,Z 0.0,A 0.0,B 0.0,C 0.0}",
        'BASE_NAME[3,]="wobj3"',
        "ENDDAT",
    ]
    program = [line for line in files["cell.src"] if line.startswith(("$TOOL", "$BASE"))]
    assert program == ["$BASE=BASE_DATA[1]"]  # the tool and the other base are those of the form in front of it
    data = "\n".join(files["cell.dat"])
    assert "DECL FDAT FA={TOOL_NO 1,BASE_NO 3," in data
    assert "; One part, two stations" in data and "tGrip" not in data and "STRUC" not in data
    assert done.registers["TOOL_DATA", 1] == "tGrip" and "TOOL_DATA" not in done.map.names


def test_a_map_keeps_the_numbers() -> None:
    given = krl("rapid", "cell.mod", RAPID)[1].map
    moved = parse_map(map_text(given).replace('1 = "tGrip"', '7 = "tGrip"'))
    files, again = krl("rapid", "cell.mod", RAPID, moved)
    assert again.registers["TOOL_DATA", 7] == "tGrip"
    assert any(line.startswith("DECL FDAT FA={TOOL_NO 7,BASE_NO 3,") for line in files["cell.dat"])
    assert krl("rapid", "cell.mod", RAPID, again.map)[0] == files


def test_numbers_of_the_source_stay_and_are_noted_nowhere_else() -> None:
    files, _ = krl("tp", "p.ls", TP)
    lines = [line for text in files.values() for line in text]
    assert any(line.startswith("DECL FDAT FP1={TOOL_NO 4,BASE_NO 2,") for line in lines)
    assert not any(line.startswith(("UFRAME", "UTOOL")) or "UFRAME=" in line for line in lines)


CHANGED = RAPID.replace("    MoveL", "    wobjBelt.uframe.trans.y:=-10;\n    MoveL")


def test_a_frame_that_the_program_changes_stays_data() -> None:
    files, _ = krl("rapid", "cell.mod", CHANGED)
    assert "$BASE=wobjBelt.user_frame:wobjBelt.object_frame" in files["cell.src"]
    assert "$BASE=BASE_DATA[3]" in files["cell.src"]


@pytest.mark.parametrize("name", ["tool_data", "base_name"])
def test_a_programs_own_name_of_a_table_gets_another(name: str) -> None:
    files, done = krl("rapid", "cell.mod", RAPID.replace("tGrip", name))
    assert f'TOOL_NAME[2,]="{name}_2"' in files["$config.dat"]
    again = read_sources([source_from_bytes(one.path, one.data) for one in done.files], "krl", Diagnostics())
    assert len(again.program.modules) >= 2


SCRIPT = """def p():
  home = [0, -1.5708, -1.5708, -1.5708, 1.5708, 0]
  movej(home, a=1.4, v=1.05)
end
"""


def test_what_is_worked_out_has_the_digits_that_the_controller_holds() -> None:
    lines = [line for text in krl("urscript", "p.script", SCRIPT)[0].values() for line in text]
    assert "BAS(#VEL_PTP,33.42)" in lines
    assert any("{A1 0.0,A2 -90.00021,A3 -90.00021,A4 -90.00021,A5 90.00021,A6 0.0}" in line for line in lines)
