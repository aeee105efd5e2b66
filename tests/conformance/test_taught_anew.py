"""What a program computes from taught data follows when the data is taught anew on the target's controller.

A point that is moved to and computed with is translated, its numbers are changed in what was written, as a pendant
would do it, and the approach has to move with it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

import pytest
from there_and_back import Journey, entry_of, there_and_back

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text

RAPID = """MODULE M
  TASK PERS tooldata tGrip:=[TRUE,[[0,0,150],[1,0,0,0]],[2,[0,0,50],[1,0,0,0],0,0,0]];
  CONST robtarget pPick:=[[500,100,250],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ Offs(pPick,0,0,100),v500,fine,tGrip;
    MoveL pPick,v100,fine,tGrip;
    MoveL RelTool(pPick,0,0,-80),v100,fine,tGrip;
  ENDPROC
ENDMODULE
"""
KRL = {
    "main.src": """DEF main()
  BAS(#INITMOV,0)
  $TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}
  $BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}
  $VEL.CP=0.5
  PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}
  LIN xPick:{X 0,Y 0,Z -100,A 0,B 0,C 0}
  LIN xPick
  LIN xPick:{X 0,Y 0,Z -80,A 0,B 0,C 0}
END
""",
    "main.dat": """DEFDAT main
DECL E6POS xPick={X 500,Y 100,Z 250,A 0,B 180,C 0,S 2,T 2}
ENDDAT
""",
}
# How y = 100 mm of a place at x = 500 and z = 250 is written in each language, and y = 140 mm.
TAUGHT = {
    "urscript": (r"(p\[0\.5, )0\.1(?=, 0\.25,)", r"\g<1>0.14"),
    "vplus": (r"( 500 )100(?= 250 )", r"\g<1>140"),
    "inform": (r"((?:=|BUSER )500\.000,)100(?=\.000,250\.000)", r"\g<1>140"),
    "tp": (r"(Y(?: =|:) +)100(?=\.000  (?:mm,\s+Z =| Z:) +250)", r"\g<1>140"),  # in a listing or a dump
    "krl": (r"Y 100(?=(?:\.0)?,Z 250)", "Y 140"),
    "rapid": (r"(\[500,)100(?=,250\])", r"\g<1>140"),
}
FRAMES = """MODULE M
  TASK PERS tooldata tGrip:=[TRUE,[[0,30,150],[1,0,0,0]],[2,[0,0,50],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wJig:=[FALSE,TRUE,"",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST pose fJig:=[[500,100,250],[1,0,0,0]];
  CONST robtarget pIn:=[[0,0,100],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pSide:=[[500,100,250],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR robtarget pNext;
  PROC main()
    wJig.uframe:=PoseMult(fJig,[[0,0,20],[1,0,0,0]]);
    MoveJ pIn,v500,fine,tGrip\\WObj:=wJig;
    MoveL Offs(pSide,0,tGrip.tframe.trans.y,100),v500,fine,tGrip;
    pNext:=pSide;
    pNext.trans.y:=pSide.trans.y+5;
    MoveL pNext,v500,fine,tGrip;
  ENDPROC
ENDMODULE
"""
# The tool's own place, 30 mm and 70 mm.
TOOL = {
    "urscript": (r"(frame=p\[0, )0\.03,", r"\g<1>0.07,"),
    "vplus": (r"(tgrip_frame 0 )30 ", r"\g<1>70 "),
    "inform": (r"(=0\.000,)30\.000", r"\g<1>70.000"),
    "tp": (r"(Y = +)30\.000", r"\g<1>70.000"),
    "krl": (r"(Y 30)(?:\.0)?\b", "Y 70"),
}
ARMS = {"rapid": "abb_irb1600_6_12", "krl": "kuka_kr6r900_2"}


def ends(files: Mapping[str, str], language: str, robot: str, entry: str = "main") -> list[float]:
    """The y of the tool where each straight move ends, mm; begun in the routine `entry`."""
    found = Diagnostics()
    program = read_sources([source_from_text(name, text) for name, text in files.items()], language, found).program
    assert not found.has_errors, [item.as_text() for item in found]
    result = run_program(program, robot, None, entry, 60.0, controller="plain")
    assert result.status == "finished", result.fault
    plans = [event.legs[-1].plan for event in result.trace if event.kind == "move" and event.legs]
    return [round(float(plan.sample(2).tcp[-1, 1, 3]), 2) for plan in plans]


def texts(journey: Journey) -> dict[str, str]:
    return {file.path: file.data.decode("latin-1") for file in journey.written.files if not file.path.endswith(".csv")}


@pytest.mark.parametrize("target", ["urscript", "vplus", "inform", "tp", "krl", "rapid"])
@pytest.mark.parametrize("source", ["rapid", "krl"])
def test_an_approach_follows_the_point(source: str, target: str) -> None:
    if source == target:
        pytest.skip("the same language is written as it is")
    robot = ARMS[source]
    files = {"m.mod": RAPID} if source == "rapid" else KRL
    journey = there_and_back(files, source, target, robot)
    written = texts(journey)
    entry = entry_of(journey.written, "main")
    before = ends(written, target, robot, entry)
    pattern, new = TAUGHT[target]
    changed = {name: re.sub(pattern, new, text) for name, text in written.items()}
    after = ends(changed, target, robot, entry)
    moved = [round(late - early) for early, late in zip(before, after, strict=True)]
    assert moved[-3:] == [40, 40, 40], journey.text


@pytest.mark.parametrize("target", list(TOOL))
def test_what_is_computed_of_frames_tools_and_components_follows(target: str) -> None:
    journey = there_and_back({"m.mod": FRAMES}, "rapid", target, ARMS["rapid"])
    written = texts(journey)
    entry = entry_of(journey.written, "main")
    before = ends(written, target, ARMS["rapid"], entry)
    assert before == pytest.approx([100.0, 130.0, 105.0], abs=0.01)
    for (pattern, new), far in ((TAUGHT[target], [40, 40, 40]), (TOOL[target], [0, 40, 0])):
        changed = {name: re.sub(pattern, new, text) for name, text in written.items()}
        after = ends(changed, target, ARMS["rapid"], entry)
        assert [round(late - early) for early, late in zip(before, after, strict=True)] == far, journey.text


SHARED = RAPID.replace(
    "  ENDPROC\nENDMODULE",
    "    again;\n  ENDPROC\n  PROC again()\n    MoveL pPick,v100,fine,tGrip;\n  ENDPROC\nENDMODULE",
)


@pytest.mark.parametrize("target", ["urscript", "vplus", "inform", "tp", "krl"])
def test_a_point_that_is_kept_twice_is_named(target: str) -> None:
    """FANUC and Yaskawa programs have points of their own: what another program is taught does not reach them. INFORM
    calculates with position variables only, so that the point of a job has a copy there."""
    found = there_and_back({"m.mod": SHARED}, "rapid", target, ARMS["rapid"]).found
    said = {item.code.name: item.as_text() for item in found if "tau" in item.code.name}
    assert sorted(said) == {
        "inform": ["inform-taught-copies", "taught-point-copied"],
        "tp": ["taught-point-copied"],
    }.get(target, [])
    assert all("pPick" in text for text in said.values())
    if target == "inform":
        assert "C00000" in said["inform-taught-copies"] and "P1" in said["inform-taught-copies"]


def test_points_that_happen_to_be_equal_stay_two_points() -> None:
    place = "[[500,100,250],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
    text = RAPID.replace("  PROC", f"  CONST robtarget pPlace:={place};\n  PROC", 1)
    text = text.replace("  ENDPROC", "    MoveL pPlace,v100,fine,tGrip;\n  ENDPROC")
    job = there_and_back({"m.mod": text}, "rapid", "inform", ARMS["rapid"]).text
    assert len(set(re.findall(r"MOVL (C\d+) ", job))) == 2


HEAD = """DEF main()
  BAS(#INITMOV,0)
  $TOOL=$NULLFRAME
  $BASE=$NULLFRAME
  $VEL.CP=0.5
  PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}
%s
END
"""
DATA = "DEFDAT main\nDECL E6POS xPick={X 500,Y 100,Z 250,A 0,B 180,C 0,S 2,T 3}\nENDDAT\n"
ARC = "CIRC xPick:{X 50,Y -20,Z 0,A 0,B 0,C 0},xPick:{X 100,Y 0,Z 0,A 0,B 0,C 0}"
NAMED = ["taught-value-written"]
# moves, how far each ends beside its old place when the point is taught 40 mm farther, what is said where it is not so
FOLLOWING = {
    "what a place leaves out": ("LIN xPick\nLIN {Z 300}\nLIN {X 450}\nLIN {Y 20}", [0, 40, 40, 40, 0], ()),
    "what a joint move leaves out": ("PTP xPick\nPTP {Z 300}\nLIN {Z 350}", [0, 40, 40, 40], ("vplus",)),
    "behind a computed place": ("LIN xPick:{X 0,Y 0,Z -100,A 0,B 0,C 0}\nLIN {X 450}", [0, 40, 40], ()),
    "a way that turns": ("LIN xPick\nLIN_REL {Z 30,A 10}\nLIN_REL {Z -20,C 5} #TOOL", [0, 40, 40, 40], ()),
    "an arc by an angle": (f"LIN xPick\n{ARC},CA 270", [0, 40, 40], ("tp", "vplus")),
    "an arc": (f"LIN xPick\n{ARC}", [0, 40, 40], ()),
    "an arc of some components": ("LIN xPick\nCIRC {X 530,Z 270},{X 560}", [0, 40, 40], ()),
    "an arc that turns as seen from the base": (
        "$CIRC_TYPE=#BASE\nLIN xPick\nCIRC {X 530,Z 270},{X 560,A 20}",
        [0, 40, 40],
        ("tp", "vplus"),
    ),
    "a joint move behind a straight one": ("LIN xPick\nLIN {Z 300}\nPTP {Z 350}", [], list(TAUGHT)),
}


@pytest.mark.parametrize("target", ["urscript", "vplus", "inform", "tp", "rapid"])
@pytest.mark.parametrize("name", FOLLOWING)
def test_what_rests_on_a_taught_point_follows_or_is_named(name: str, target: str) -> None:
    moves, wanted, stays = FOLLOWING[name]
    source = {"main.src": HEAD % moves, "main.dat": DATA}
    journey = there_and_back(source, "krl", target, ARMS["krl"])
    said = [item.code.name for item in journey.found if item.code.name in NAMED]
    assert bool(said) == (target in stays), said
    if said:
        assert all("xPick" in item.message and item.origin.line for item in journey.found if item.code.name in NAMED)
        assert ends(texts(journey), target, ARMS["krl"])[-1] == ends(source, "krl", ARMS["krl"])[-1]
        return
    written = texts(journey)
    pattern, new = TAUGHT[target]
    before = ends(written, target, ARMS["krl"])
    after = ends({name: re.sub(pattern, new, text) for name, text in written.items()}, target, ARMS["krl"])
    moved = [round(late - early) for early, late in zip(before, after, strict=True)]
    assert not journey.losses and (moved[:1], moved[-1], set(moved)) == ([0], wanted[-1], set(wanted)), journey.text


@pytest.mark.parametrize("target", ["rapid", "tp", "vplus", "inform"])
def test_joints_that_are_worked_out_of_a_taught_place_are_named(target: str) -> None:
    text = (
        "def main():\n  global pick = p[0.5, 0.1, 0.25, 0, 3.141592654, 0]\n"
        "  movej([0,-1.57,1.57,-1.57,-1.57,0],a=1,v=1)\n"
        "  movej(get_inverse_kin(pick,qnear=[0,-1.57,1.57,-1.57,-1.57,0]),a=1,v=1)\nend\n"
    )
    found = there_and_back({"main.script": text}, "urscript", target, "ur10e").found
    (one,) = [item for item in found if item.code.name in NAMED]
    assert "pick" in one.message and one.origin.line == 4
