"""Moves to taught points come out as inline forms of the pendant, and mean what the expert lines meant."""

from __future__ import annotations

import re

import pytest

from rpl.diagnostics import Diagnostics
from rpl.errors import UsageError
from rpl.project import read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import Translation, translate_program
from rpl.writing.namemap import map_text, parse_map
from tests.there_and_back import there_and_back

HEAD = """MODULE cell
  PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wobjTray:=[FALSE,TRUE,"",[[0,20,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  TASK PERS wobjdata wobjBelt:=[FALSE,TRUE,"",[[0,-20,5],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget pPick:=[[300,0,200],[0,1,0,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget Xtop:=[[300,0,300],[0,1,0,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p10:=[[400,0,300],[0,1,0,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR robtarget pSet:=[[400,0,300],[0,1,0,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jRest:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num nFast:=100;
"""
ALSO = "    MoveL Xtop,v200,fine,tGrip\\WObj:=wobjTray;\n"  # one more that is surely a form


def written(body: str, head: str = HEAD, map_of: str = "", moves: str = "") -> tuple[dict[str, str], Translation]:
    text = f"{head}  PROC main()\n{body}  ENDPROC\nENDMODULE\n"
    read = read_sources([source_from_text("cell.mod", text)], "rapid", Diagnostics())
    earlier = [parse_map(map_of)] if map_of else []
    options = {"moves": moves} if moves else {}
    done = translate_program(read, "krl", None, None, Diagnostics(), *earlier, options=options)
    return {one.path: one.data.decode("cp1252").replace("\r\n", "\n") for one in done.files}, done


def folds(text: str) -> list[str]:
    return [
        line.split(";%")[0] for line in map(str.strip, text.splitlines()) if line.startswith((";FOLD PTP", ";FOLD LIN"))
    ]


@pytest.mark.parametrize(
    ("line", "fold"),
    [
        ("MoveJ pPick,v1000,fine,tGrip\\WObj:=wobjTray;", "PTP Pick Vel=20 % PDAT1 Tool[1]:tGrip Base[1]:wobjTray"),
        ("MoveL pPick,v200,fine,tGrip\\WObj:=wobjTray;", "LIN Pick Vel=0.2 m/s CPDAT1 Tool[1]:tGrip Base[1]:wobjTray"),
        (
            "MoveL pPick,v200,z50,tGrip\\WObj:=wobjTray;",
            "LIN Pick CONT Vel=0.2 m/s CPDAT1 Tool[1]:tGrip Base[1]:wobjTray",
        ),
        ("MoveL pPick,v200,fine,tool0;", "LIN Pick Vel=0.2 m/s CPDAT1 Tool[0] Base[0]"),
        ("MoveL p10,v200,fine,tool0;", "LIN P10 Vel=0.2 m/s CPDAT1 Tool[0] Base[0]"),
        ("MoveAbsJ jRest,v1000,fine,tool0;", "PTP Rest Vel=20 % PDAT1 Tool[0] Base[0]"),
    ],
)
def test_a_move_to_a_taught_point_is_a_form(line: str, fold: str) -> None:
    assert folds(written(f"    {line}\n")[0]["cell.src"]) == [f";FOLD {fold}"]


@pytest.mark.parametrize(
    "line",
    [
        "MoveL Offs(pPick,0,0,50),v200,fine,tGrip\\WObj:=wobjTray;",  # a place beside the point
        "MoveL pSet,v200,fine,tGrip\\WObj:=wobjTray;",  # the program sets it
        "MoveL [[300,0,250],[0,1,0,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tGrip\\WObj:=wobjTray;",
        "MoveC pPick,p10,v200,fine,tGrip\\WObj:=wobjTray;",
        "MoveL pPick,v4000,fine,tGrip\\WObj:=wobjTray;",  # BAS limits the speed of a form to 2 m/s
        "MoveL pPick,[nFast,500,5000,1000],fine,tGrip\\WObj:=wobjTray;",  # the speed is a variable
    ],
)
def test_what_a_form_cannot_say_stays_an_expert_line(line: str) -> None:
    files, _ = written(f"    pSet.trans.z:=310;\n    nFast:=nFast+1;\n{ALSO * 3}    {line}\n")
    assert [fold.split()[2] for fold in folds(files["cell.src"])] == ["top"] * 3


def test_an_option_asks_for_forms_wherever_there_can_be_one_or_for_none() -> None:
    beside = "    MoveL Offs(pPick,0,0,nFast),v200,fine,tGrip\\WObj:=wobjTray;\n" * 2
    computed = f"    nFast:=nFast+1;\n{ALSO}{beside}"
    assert folds(written(computed)[0]["cell.src"]) == []
    assert [fold.split()[2] for fold in folds(written(computed, moves="forms")[0]["cell.src"])] == ["top"]
    assert folds(written(ALSO * 3, moves="lines")[0]["cell.src"]) == []
    with pytest.raises(UsageError, match="moves=curves"):
        written(ALSO, moves="curves")


def test_a_program_of_computed_places_stays_an_expert_program() -> None:
    beside = "    MoveL Offs(pPick,0,0,nFast),v200,fine,tGrip\\WObj:=wobjTray;\n"
    files, done = written(f"    nFast:=nFast+1;\n{ALSO * 5}{beside * 2}")
    assert not folds(files["cell.src"]) and "INITMOV" not in files["cell.src"] and "&ACCESS" not in files["cell.src"]
    assert "DECL FDAT" not in files["cell.dat"] and done.map.names["pPick"] == "pPick"


def test_a_form_has_its_data_and_sets_what_the_lines_in_front_of_it_set() -> None:
    files, done = written(f"    MoveJ pPick,v1000,z50,tGrip\\WObj:=wobjTray;\n{ALSO}")
    assert files["cell.src"].splitlines() == [
        "&ACCESS RVP",
        "&REL 1",
        "DEF cell( )",
        ";FOLD INI",
        "BAS(#INITMOV,0)",
        ";ENDFOLD (INI)",
        "$CP_VEL_TYPE=#VAR_ALL",
        ";FOLD PTP Pick CONT Vel=20 % PDAT1 Tool[1]:tGrip Base[1]:wobjTray;%{PE}%R 8.3.22,%MKUKATPBASIS,%CMOVE,%VPTP,"
        "%P 1:PTP, 2:Pick, 3:C_PTP, 5:20, 7:PDAT1",
        "$BWDSTART=FALSE",
        "PDAT_ACT=PPDAT1",
        "FDAT_ACT=FPick",
        "BAS(#PTP_PARAMS,20)",
        "PTP XPick C_PTP",
        ";ENDFOLD",
        ";FOLD LIN top Vel=0.2 m/s CPDAT1 Tool[1]:tGrip Base[1]:wobjTray;%{PE}%R 8.3.22,%MKUKATPBASIS,%CMOVE,%VLIN,"
        "%P 1:LIN, 2:top, 3:, 5:0.2, 7:CPDAT1",
        "$BWDSTART=FALSE",
        "LDAT_ACT=LCPDAT1",
        "FDAT_ACT=Ftop",
        "BAS(#CP_PARAMS,0.2)",
        "LIN Xtop",
        ";ENDFOLD",
        "END",
    ]
    data = files["cell.dat"]
    assert 'DECL FDAT FPick={TOOL_NO 1,BASE_NO 1,IPO_FRAME #BASE,POINT2[] " ",TQ_STATE FALSE}' in data
    assert "DECL PDAT PPDAT1={VEL 20.0,ACC 100.0,APO_DIST 12.5,APO_MODE #CPTP}" in data
    assert "DECL LDAT LCPDAT1={VEL 0.2,ACC 100.0,APO_DIST 100.0," in data
    assert re.search(r"^DECL E6POS XPick=", data, re.MULTILINE)  # the pendant touches it up: no constant
    assert done.map.names["pPick"] == "XPick" and "BAS" not in done.map.names


def test_a_point_has_one_tool_and_base_in_forms() -> None:
    belt = "    MoveL pPick,v200,fine,tGrip\\WObj:=wobjBelt;\n"
    files, _ = written(f"{belt}{belt}    MoveL pPick,v200,fine,tGrip\\WObj:=wobjTray;\n")
    assert [fold.split()[-1] for fold in folds(files["cell.src"])] == ["Base[1]:wobjBelt"] * 2
    assert "$BASE=BASE_DATA[2]\nLIN XPick\nEND" in files["cell.src"]


def test_a_corner_of_an_expert_line_keeps_its_size_behind_a_form() -> None:
    near = "    MoveL Offs(pPick,0,0,50),v200,z20,tGrip\\WObj:=wobjTray;\n"
    files, _ = written(f"{near}{ALSO}{ALSO}{near}{ALSO}")
    sizes = re.findall(r"LCPDAT\d=.*?APO_DIST ([\d.]+)", files["cell.dat"])
    assert files["cell.src"].count("$APO.CDIS=") == 1 and sizes == ["100.0", "20.0", "100.0"]


@pytest.mark.parametrize(
    ("declared", "point"),
    [
        ("VAR num FPick:=1;", "XPick2"),
        ("VAR num XPick:=1;", "XPick2"),
    ],
)
def test_names_of_the_program_are_left_alone(declared: str, point: str) -> None:
    name = declared.split()[2].split(":")[0]
    body = f"    {name}:={name}+1;\n    MoveL pPick,v200,fine,tGrip\\WObj:=wobjTray;\n"
    files, done = written(body, f"{HEAD}  {declared}\n")
    assert done.map.names["pPick"] == point and f"FDAT_ACT=F{point[1:]}\n" in files["cell.src"]
    assert f"{name}={name}+1" in files["cell.src"]


def test_data_of_moves_go_round_names_that_are_taken() -> None:
    body = f"    PPDAT1:=PPDAT1+1;\n    MoveJ pPick,v1000,fine,tGrip\\WObj:=wobjTray;\n{ALSO}"
    files, _ = written(body, f"{HEAD}  VAR num PPDAT1:=1;\n")
    assert "PDAT_ACT=PPDAT2\n" in files["cell.src"] and "PPDAT1=PPDAT1+1" in files["cell.src"]


def test_a_routine_called_as_the_basis_package_gets_another_name() -> None:
    text = HEAD + "  PROC BAS()\n    WaitTime 1;\n  ENDPROC\n"
    files, done = written(f"    BAS;\n{ALSO}", text)
    assert done.renamed["BAS"] == "BAS_2" and "BAS_2( )" in files["cell.src"] and "BAS(#INITMOV,0)" in files["cell.src"]


def test_the_names_of_an_earlier_translation_stay() -> None:
    given = written(ALSO + "    MoveL pPick,v200,fine,tGrip\\WObj:=wobjTray;\n")[1].map
    chosen = (
        map_text(given).replace('pPick = "XPick"', 'pPick = "XGrasp"').replace('FPick = "FPick"', 'FPick = "FGrasp"')
    )
    files, _ = written(ALSO + "    MoveL pPick,v200,fine,tGrip\\WObj:=wobjTray;\n", map_of=chosen)
    assert "LIN XGrasp" in files["cell.src"] and folds(files["cell.src"])[1].startswith(";FOLD LIN Grasp ")


def test_the_home_position_of_the_controller_has_its_own_form() -> None:
    home = "MODULE stations\n  CONST jointtarget XHOME:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nENDMODULE\n"
    text = f"{HEAD}  PROC main()\n    MoveAbsJ XHOME,v2500,fine,tool0;\n{ALSO}  ENDPROC\nENDMODULE\n"
    sources = [source_from_text("cell.mod", text), source_from_text("stations.mod", home)]
    done = translate_program(read_sources(sources, "rapid", Diagnostics()), "krl", None, None, Diagnostics())
    files = {one.path: one.data.decode("cp1252").replace("\r\n", "\n") for one in done.files}
    assert folds(files["cell.src"])[0] == ";FOLD PTP HOME Vel=50 % DEFAULT"
    assert "PDAT_ACT=PDEFAULT\nFDAT_ACT=FHOME\nBAS(#PTP_PARAMS,50)\n$H_POS=XHOME\nPTP XHOME\n" in files["cell.src"]
    assert "FHOME" not in "".join(text for path, text in files.items() if path.endswith(".dat"))


def test_what_came_from_forms_comes_back_as_the_same_forms() -> None:
    krl = written(
        f"    MoveJ pPick,v2500,fine,tGrip\\WObj:=wobjTray;\n{ALSO}    MoveL pPick,v500,z50,tGrip\\WObj:=wobjTray;\n"
    )
    sources = [source_from_bytes(path, text.encode("cp1252")) for path, text in krl[0].items() if "toml" not in path]
    there = translate_program(read_sources(sources, "krl", Diagnostics()), "rapid", None, None, Diagnostics())
    again = [source_from_bytes(one.path, one.data) for one in there.files]
    back = translate_program(read_sources(again, "rapid", Diagnostics()), "krl", None, None, Diagnostics())
    texts = {one.path: one.data.decode("cp1252").replace("\r\n", "\n") for one in back.files}
    assert folds(texts["cell.src"]) == folds(krl[0]["cell.src"])


def test_forms_of_a_krl_program_are_written_as_they_were() -> None:
    files, _ = written(f"    MoveJ pPick,v1000,fine,tGrip\\WObj:=wobjTray;\n{ALSO}")
    sources = [source_from_bytes(path, text.encode("cp1252")) for path, text in files.items()]
    same = translate_program(read_sources(sources, "krl", Diagnostics()), "krl", None, None, Diagnostics())
    assert {one.path: one.data.decode("cp1252").replace("\r\n", "\n") for one in same.files}["cell.src"] == files[
        "cell.src"
    ]


PROJECT = """MODULE cell
  PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wobjTray:=[FALSE,TRUE,"",[[100,20,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget pPick:=[[700,300,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pPlace:=[[700,-300,700],[0,0,1,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jStart:=[[0,-20,20,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num n:=0;
  PROC main()
    MoveAbsJ jStart,v500,fine,tool0;
    WHILE n<2 DO
      MoveJ pPick,v500,z20,tGrip\\WObj:=wobjTray;
      grip;
      IF n=1 THEN
        MoveL Offs(pPick,0,0,50+n),v200,z10,tGrip\\WObj:=wobjTray;
      ENDIF
      MoveL pPlace,v300,fine,tGrip\\WObj:=wobjTray;
      n:=n+1;
    ENDWHILE
    MoveL pPick,v300,z10,tool0;
    MoveL Offs(pPick,0,0,50),v300,fine,tool0;
    SetDO do1,1;
  ENDPROC
  PROC grip()
    WaitTime 0.2;
    MoveL pPick,v200,fine,tGrip\\WObj:=wobjTray;
    SetDO do2,1;
  ENDPROC
ENDMODULE
"""


def test_forms_beside_expert_lines_mean_the_same() -> None:
    journey = there_and_back({"cell.mod": PROJECT}, "rapid", "krl", "abb_irb2400")
    assert len(folds(journey.text)) == 4 and not journey.losses, journey.text
    result = journey.prove()
    assert result.verdict in ("equal", "alike"), result.as_text()
    assert result.level in ("geometry", "time"), result.as_text()
