"""VAL3 applications as they are read: files of both forms, values, movements, and what a run does with them."""

from __future__ import annotations

import pytest
from val3_helpers import body, codes, outputs, read, run

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.source import source_from_text

OLD_PROGRAM = """\ufeff<?xml version="1.0" encoding="utf-8"?>
<programList xmlns="ProgramNameSpace">
  <program name="start" public="false">
    <description />
    <paramSection />
    <localSection />
    <source>
      <code>
begin
  if nX&lt;3 and bOn==true // small
    movej(pPick,tTool,mFast)
  endIf
end
      </code>
    </source>
  </program>
</programList>
"""
OLD_DATA = """\ufeff<?xml version="1.0" encoding="utf-8"?>
<dataList xmlns="DataNameSpace">
  <boolSection><bool name="bOn" public="false"><valueBool value="true" index="0" /></bool></boolSection>
  <mdescSection><mdesc name="mFast" public="false"><valueMdesc index="0">
    <mdescValue accel="100" vel="75" decel="100" tmax="99999" rmax="99999" blend="joint" leave="50" reach="50" />
  </valueMdesc></mdesc></mdescSection>
  <numSection><num name="nX" public="false"><valueNum value="2" index="0" /></num></numSection>
  <pointSection><point name="pPick" public="false"><pFather alias="" name="world" fatherIndex="0" />
    <valuePoint index="0"><tpValue x="380" y="0" z="-100" rx="180" ry="0" rz="0" />
      <cpValue shoulder="righty" elbow="esame" wrist="wsame" /></valuePoint></point></pointSection>
  <toolSection><tool name="tTool" public="false"><tFather alias="" name="flange" fatherIndex="0" />
    <valueTool index="0"><ttValue x="0" y="0" z="100" rx="0" ry="0" rz="0" />
      <io alias="io" name="valve1" ioIndex="0" open="1" close="1" /></valueTool></tool></toolSection>
</dataList>
"""


def test_files_of_older_controllers_are_read_and_every_sign_is_accounted_for() -> None:
    found = Diagnostics()
    sources = [source_from_text("start.pgx", OLD_PROGRAM), source_from_text("app.dtx", OLD_DATA)]
    result = registry.dialect("val3").read(sources, found)
    assert not list(found)
    (choice,) = result.program.modules[0].routines[0].body
    assert isinstance(choice, ir.If)
    assert choice.branches[0][0] == ir.Binary(
        "cand",
        ir.Binary("<", ir.Name("nX"), ir.IntLiteral(3)),
        ir.Binary("=", ir.Name("bOn"), ir.BoolLiteral(True)),
    )
    assert [comment.text for comment in choice.origin.comments] == [" small"]
    (point,) = [d for d in result.program.modules[0].declarations if isinstance(d, ir.Variable) and d.name == "pPick"]
    assert isinstance(point.initial, ir.Aggregate)
    assert ("shoulder", ir.IntLiteral(0)) in point.initial.entries  # `same` is a flag left out


def test_an_angle_list_is_turned_about_x_new_y_new_z() -> None:
    """Rz(30)Ry(20)Rx(10) is rx -1.1161, ry 22.2422, rz 28.4518 (computed apart from this reader)."""
    statements = body("trX={0,0,0,-1.1161,22.2422,28.4518}", [("trX", "trsf", "")])
    (made,) = statements
    assert isinstance(made, ir.Assign) and isinstance(made.value, ir.Aggregate)
    angles = [part.value for name, part in made.value.entries if name in "abc" and isinstance(part, ir.RealLiteral)]
    assert angles == pytest.approx([30.0, 20.0, 10.0], abs=1e-3)


def test_a_descriptor_that_nothing_changes_stands_for_its_numbers() -> None:
    (move,) = body("movel(pA,tGrip,mFast)")
    assert isinstance(move, ir.Move) and move.speed is not None
    assert move.speed.path == ir.IntLiteral(500)
    assert move.blend == ir.BlendDistance(ir.IntLiteral(20))


def test_a_point_counts_in_its_father_frame() -> None:
    (move,) = body("movej(pInPart,tGrip,mStop)")
    assert isinstance(move, ir.Move) and move.frame == ir.Name("fPart")


CASES = {
    "a corner is cut where the next movement is known": "movel(pA,tGrip,mStop)\nwaitEndMove()\nbX=1==1",
    "and binds tighter than or": "if true or true and false\ndoOut=true\nendIf",
    "a switch runs one case": "switch 2\ncase 1\nbreak\ncase 2,3\ndoOut=true\nbreak\ndefault\nnX=5\nbreak\nendSwitch",
    "the counter is beyond the end": "for nX=1 to 4\nendFor\nif nX==5\ndoOut=true\nendIf",
    "do runs at least once": "do\nnX=nX+1\nuntil nX>=1\ndoOut=nX==1",
    "texts count from 0": 'sX=mid("abcdef",2,1)\nif sX=="bc" and find(sX,"c")==1\ndoOut=true\nendIf',
    "an angle reads back": (
        "pA.trsf.rz=30\nif abs(pA.trsf.rz-30)<0.001 and abs(abs(pA.trsf.rx)-180)<0.001\ndoOut=true\nendIf"
    ),
    "a watch that is late": "if !watch(diIn==true,0.5)\ndoOut=true\nendIf",
    "compose turns about the frame": (
        "pB=compose(pA,world,{0,0,0,0,0,90})\nif abs(pB.trsf.x-120)<0.01 and abs(pB.trsf.y-380)<0.01\ndoOut=true\nendIf"
    ),
    "a point keeps its place in the room": "pB=pInPart\nif distance(pB,pInPart)<0.001\ndoOut=true\nendIf",
}


@pytest.mark.parametrize("code", CASES.values(), ids=CASES.keys())
def test_the_language_means(code: str) -> None:
    result = run(code)
    assert result.status == "finished", result.as_json()["fault"]
    if "doOut" in code:
        assert ("doOut", True) in outputs(result)


def test_a_movement_is_only_queued() -> None:
    """The program goes on at once: an output behind a movement is switched before the robot has moved."""
    early = run("movej(pA,tGrip,mStop)\ndoOut=true\nwaitEndMove()").as_json()["outputs"]
    late = run("movej(pA,tGrip,mStop)\nwaitEndMove()\ndoOut=true").as_json()["outputs"]
    assert early[0][0] == 0.0
    assert late[0][0] > 0.2


def test_here_is_looked_at_when_the_statement_is_executed() -> None:
    """Behind a movement that is still on its way, a place seen from `here` is another one than behind waitEndMove."""
    code = "movej(jHome,tGrip,mStop)\nwaitEndMove()\nmovej(pA,tGrip,mStop)\n{wait}l=here(tGrip,world)\nnX=l.trsf.z\n"
    code += "if abs(nX+100)<1\ndoOut=true\nendIf\nwaitEndMove()"
    local = '<Locals><Local name="l" type="pointRx" xsi:type="array" size="1" /></Locals>\n---\n'
    assert outputs(run(local + code.format(wait="waitEndMove()\n"))) == [("doOut", True)]
    assert outputs(run(local + code.format(wait=""))) == []


def test_a_tool_acts_behind_the_motion_and_takes_its_time() -> None:
    (at, name, value), *_ = run("movej(pA,tGrip,mStop)\nclose(tGrip)\nopen(tGrip)").as_json()["outputs"]
    assert (name, value) == ("valve1", True) and at > 0.4  # closed it was at the start: only the opening is seen


def test_a_program_gets_values_and_references() -> None:
    head = '<Parameters><Parameter name="x_n" type="num" xsi:type="element" use="reference" /></Parameters>\n---\n'
    result = run({"start": "call add(nX)\ncall add(nX)\ndoOut=nX==2", "add": head + "x_n=x_n+1"})
    assert outputs(result) == [("doOut", True)]


def test_a_task_runs_beside() -> None:
    code = 'taskCreate "other",10,beside()\ndelay(1)\ntaskKill("other")\nif taskStatus("other")==-1\ndoOut=false\nendIf'
    result = run({"start": code, "beside": "while true\ndoOut=true\ndelay(0.1)\nendWhile"})
    assert result.status == "finished" and outputs(result) == [("doOut", True), ("doOut", False)]


@pytest.mark.parametrize(
    ("code", "reported"),
    [
        ("nX=", "unreadable-statement"),
        ("nX=unheard(3)", "unreadable-statement"),
        ("if nX==1\nnX=2", "missing-block-end"),
        ("endFor", "stray-block-end"),
    ],
)
def test_damage_costs_its_statement_and_is_told(code: str, reported: str) -> None:
    assert reported in codes(read(code)[1])


TREE = [
    ("fCell", "frame", 'x="300" z="-200" fatherId="world[0]"'),
    ("fTray", "frame", 'y="-40" rz="90" fatherId="fCell[0]"'),
    ("pTray", "pointRx", 'x="20" y="10" z="40" rx="180" rz="180" fatherId="fTray[0]"'),
    ("tLong", "tool", 'z="30" fatherId="tGrip[0]"'),
]


def test_frames_and_tools_hang_on_their_fathers() -> None:
    (move,) = body("movej(pTray,tLong,mStop)", TREE)
    assert isinstance(move, ir.Move)
    assert move.frame == ir.Binary(":", ir.Name("fCell"), ir.Name("fTray"))
    assert move.tool == ir.Binary(":", ir.Name("tGrip"), ir.Name("tLong"))
    code = "movej(pTray,tLong,mStop)\nwaitEndMove()\nl=here(tLong,world)\n"
    code += "if abs(l.trsf.x-290)<0.01 and abs(l.trsf.y+20)<0.01 and abs(l.trsf.z+160)<0.01\ndoOut=true\nendIf"
    local = '<Locals><Local name="l" type="pointRx" xsi:type="array" size="1" /></Locals>\n---\n'
    assert outputs(run(local + code, TREE)) == [("doOut", True)]


def test_joints_of_a_point_are_given_only_where_there_are_any() -> None:
    rows = [("jFound", "jointRx", ""), ("pFar", "pointRx", 'x="3000" rx="180"')]
    code = "bX=pointToJoint(tGrip,jHome,{point},jFound)\ndoOut=bX\n"
    assert outputs(run(code.format(point="pA"), rows)) == [("doOut", True)]
    assert outputs(run(code.format(point="pFar"), rows)) == []


def test_a_block_whose_condition_cannot_be_read_stays_whole() -> None:
    program, found = read("if (unheard(3)==1) // why\nnX=2\nelse\nnX=3\nendIf")
    assert codes(found) == ["val3-unread-condition"]
    (choice,) = program.modules[0].routines[0].body
    assert isinstance(choice, ir.If) and isinstance(choice.branches[0][0], ir.VendorValue)
    assert choice.branches[0][0].text == "(unheard(3)==1)"


def test_a_limited_wait_cannot_stand_in_the_condition_of_a_loop() -> None:
    assert "unreadable-statement" in codes(read("while watch(diIn==true,1)\nnX=1\nendWhile")[1])


@pytest.mark.parametrize(
    ("words", "sign"), [("enegative", -1), ("epositive", 1)], ids=["below the stretched arm", "above it"]
)
def test_the_elbow_is_on_the_side_that_the_point_says(words: str, sign: int) -> None:
    place = f'x="250" y="0" z="250" shoulder="righty" elbow="{words}" wrist="wpositive"'
    code = "movej(pSide,flange,mStop)\nwaitEndMove()\nl=herej()\nnX=l.j3\ndoOut=nX*{sign}>0"
    local = '<Locals><Local name="l" type="jointRx" xsi:type="array" size="1" /></Locals>\n---\n'
    result = run(local + code.format(sign=sign), [("pSide", "pointRx", place)])
    assert result.status == "finished", result.as_json()["fault"]
    assert outputs(result) == [("doOut", True)]
