"""Motion instructions with all their options. Facts: RAPID reference manuals, MoveL, TriggIO, SearchL and others."""

from dataclasses import replace

import pytest
from rapid_helpers import statement

from rpl import ir

TOOL, WOBJ, P, T1 = ir.Name("tGrip"), ir.Name("wCell"), ir.Name("p"), ir.Name("t1")
ONE, TEN = ir.IntLiteral(1), ir.IntLiteral(10)
ON = ir.BoolLiteral(True)
DO1 = ir.Signal("digital_out", name="do1")
LINE = ir.Move(
    "linear",
    P,
    tool=TOOL,
    frame=ir.Name("wobj0"),
    speed=ir.Speed(ir.Name("v100")),
    blend=ir.BlendZone(ir.Name("z10")),
)
EVENT = ir.Trigger("middle", ir.Assign(DO1, ON))


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("MoveL p,v100,z10,tGrip;", LINE),
        ("movel P,V100,Z10,tgrip;", replace(
            LINE, target=ir.Name("P"), tool=ir.Name("tgrip"), speed=ir.Speed(ir.Name("V100")),
            blend=ir.BlendZone(ir.Name("Z10")))),
        ("MoveJ p,v100,z10,tGrip\\WObj:=wCell;", replace(LINE, kind="joint", frame=WOBJ)),
        ("MoveL\\Conc,p\\ID:=10,v100\\V:=50,z10\\Z:=3\\Inpos:=inpos50,tGrip\\WObj:=wCell\\TLoad:=load0;", replace(
            LINE, concurrent=True, identity=TEN, frame=WOBJ, load=ir.Name("load0"),
            speed=ir.Speed(ir.Name("v100"), path=ir.IntLiteral(50)),
            blend=ir.BlendZone(ir.Name("z10"), ir.IntLiteral(3), ir.Name("inpos50")))),
        ("MoveL p,v100\\T:=10,z10,tGrip;", replace(LINE, speed=ir.Speed(ir.Name("v100"), duration=TEN))),
        ("MoveAbsJ p\\NoEOffs,v100,z10,tGrip;", replace(LINE, kind="joint", without_offsets=True)),
        ("MoveC p,q,v100,z10,tGrip;", replace(LINE, kind="circular", via=P, target=ir.Name("q"))),
        ("MoveLDO p,v100,z10,tGrip,do1,1;", replace(LINE, triggers=(EVENT,))),
        ('MoveLSync p,v100,z10,tGrip,"note";', replace(
            LINE, triggers=(ir.Trigger("middle", ir.CallRoutine("note")),))),
        ("TriggL p,v100,t1\\T2:=t2,z10,tGrip;", replace(LINE, triggers=(T1, ir.Name("t2")))),
        ("SearchL\\Stop,di1,found,p,v100,tGrip;", replace(
            LINE, blend=ir.BlendStop(),
            search=ir.Search(ir.Signal("digital_in", name="di1"), ir.Name("found"), "stop"))),
        ("SearchL di1\\Flanks,found,p,v100,tGrip;", replace(
            LINE, blend=ir.BlendStop(),
            search=ir.Search(ir.Signal("digital_in", name="di1"), ir.Name("found"), "none", "either"))),
        ("MoveExtJ p,v100,z10;", ir.MoveExternal(P, LINE.speed, LINE.blend)),
        ("TriggIO t1,10\\DOp:=do1,1;", ir.DefineTrigger(
            T1, ir.Trigger("end", ir.Assign(DO1, ON), ir.Unary("-", TEN)))),
        ("TriggIO t1,10\\Start\\DOp:=do1,1;", ir.DefineTrigger(
            T1, ir.Trigger("start", ir.Assign(DO1, ON), TEN))),
        ("TriggIO t1,10\\Time\\DOp:=do1,1;", ir.DefineTrigger(
            T1, ir.Trigger("end", ir.Assign(DO1, ON), None, ir.Unary("-", TEN)))),
        ("TriggEquip t1,10,1\\DOp:=do1,1;", ir.DefineTrigger(
            T1, ir.Trigger("end", ir.Assign(DO1, ON), ir.Unary("-", TEN), ir.Unary("-", ONE)))),
        ("TriggInt t1,10,i1;", ir.DefineTrigger(
            T1, ir.Trigger("end", ir.CallRoutine(""), ir.Unary("-", TEN)), ir.Name("i1"))),
        ("MoveL p,v100,z10,tGrip\\Corr;", ir.Vendor("rapid", "MoveL p,v100,z10,tGrip\\Corr;", "unknown")),
    ],
)  # fmt: skip
def test_moves(text: str, meaning: ir.Statement) -> None:
    assert statement(text) == meaning


def test_a_target_may_be_written_at_the_move() -> None:
    move = statement("MoveJ [[217.4,1.57,1072.81],[0.97,-0.01,0.22,-0.04],[0,1,-3,0],[9E+09,9E+09]],v1000,z50,tool0;")
    assert isinstance(move, ir.Move) and isinstance(move.target, ir.Aggregate)
    assert [len(entry.entries) for _, entry in move.target.entries if isinstance(entry, ir.Aggregate)] == [3, 4, 4, 2]
