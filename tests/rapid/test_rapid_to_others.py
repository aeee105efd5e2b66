"""RAPID programs that switch do1 when an expectation holds: it still holds in each other language, and nothing is
refused. The arm is the same, so that places and joints compare."""

from __future__ import annotations

import pytest

from rpl import registry
from rpl.cell import Cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.record import signal_names
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.runtime.trace import Event
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ABB = "abb_irb1200_5_90"
POINTS = """
  VAR intnum seen;
  VAR triggdata gun;
  VAR triggdata cut;
  VAR num n:=0;
  VAR bool ok:=FALSE;
  VAR pose fr;
  VAR pos at;
  VAR robtarget here;
  CONST robtarget p1:=[[450,0,350],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget c1:=[[400,-150,180],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget c2:=[[480,-90,180],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget c3:=[[410,-80,180],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
"""
COUNT = "TRAP tCount n:=n+1; ENDTRAP"
# name, declarations and routines beside main, body of main, targets where a part of it is refused by name
CASES: list[tuple[str, str, str, frozenset[str]]] = [
    (
        "a frame that begins beside its third point",
        "",
        """fr:=DefFrame(c1,c2,c3\\Origin:=3); at:=PoseVect(PoseInv(fr),c3.trans);
        ok:=Abs(at.x)<0.01 AND Abs(at.y-50)<0.01; fr:=DefFrame(c1,c2,c3\\Origin:=2);
        IF ok AND Distance(fr.trans,c2.trans)<0.01 AND Abs(EulerZYX(\\Z,fr.rot)-36.87)<0.01 SetDO do1,1;""",
        frozenset(("val3",)),  # places that are worked out, and the frame of them
    ),
    (
        "a trap at a place of the path, deleted when the arm stands",
        COUNT,
        """MoveJ p1,v500,fine,tool0; IDelete seen; CONNECT seen WITH tCount; TriggInt gun,30,seen;
        TriggL Offs(p1,0,0,-100),v200,gun,fine,tool0; IDelete seen; WaitTime 0.1; IF n=1 SetDO do1,1;""",
        frozenset(("val3",)),  # no interrupts
    ),
    (
        "a trap that sleeps while the first event comes",
        COUNT,
        """MoveJ p1,v500,fine,tool0; CONNECT seen WITH tCount; TriggInt gun,30,seen; ISleep seen;
        TriggL Offs(p1,0,0,-100),v200,gun,fine,tool0; WaitTime 0.1; ok:=n=0; IWatch seen;
        TriggL p1,v200,gun,fine,tool0; WaitTime 0.1; IF ok AND n=1 SetDO do1,1;""",
        frozenset(("val3",)),  # no interrupts
    ),
    (
        "events defined anew before each move",
        "",
        """MoveJ p1,v500,fine,tool0; TriggIO gun,30\\DOp:=do2,1; TriggL Offs(p1,0,0,-100),v200,gun,fine,tool0;
        ok:=DOutput(do2)=1; TriggIO gun,20\\DOp:=do2,0; TriggL p1,v200,gun,fine,tool0;
        IF ok AND DOutput(do2)=0 SetDO do1,1;""",
        frozenset(("val3",)),  # no actions on the path
    ),
    (
        "targets put together with the flags and external axes of others",
        """VAR robtarget there; VAR jointtarget j; VAR pos row{2};
        FUNC robtarget raised(robtarget p,num z)
        RETURN [[p.trans.x,p.trans.y,p.trans.z+z],p.rot,p.robconf,p.extax]; ENDFUNC
        """,
        """ConfL\\Off; MoveJ p1,v500,fine,tool0; here:=CRobT(\\Tool:=tool0\\WObj:=wobj0); here.trans.y:=20;
        there:=[[here.trans.x,here.trans.y,here.trans.z-40],p1.rot,p1.robconf,p1.extax]; MoveL there,v200,fine,tool0;
        here:=there; here.robconf:=p1.robconf; here.extax:=p1.extax; here.extax.eax_a:=9E9; n:=here.trans.z;
        MoveL raised(here,25),v200,fine,tool0; ok:=Distance(CPos(),[450,20,335])<0.2 AND Abs(n-310)<0.01;
        j:=CJointT(); j:=[[j.robax.rax_1,j.robax.rax_2,j.robax.rax_3,0,j.robax.rax_5,0],j.extax];
        MoveAbsJ j,v500,fine,tool0; row{2}:=[430,10,350];
        here:=[row{2},OrientZYX(180,0,180),[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]; MoveJ here,v500,fine,tool0;
        IF ok AND Distance(CPos(),[430,10,350])<0.2 SetDO do1,1;""",
        frozenset(),
    ),
    (
        "lists of any length that are handed on",
        """VAR num short{3}:=[3,1,2]; VAR num long{5}:=[5,9,8,7,6];
        PROC sort(INOUT num list{*}) FOR i FROM 1 TO Dim(list,1)-1 DO FOR k FROM 1 TO Dim(list,1)-i DO
        IF above(list,k) swap list,k; ENDFOR ENDFOR ENDPROC
        FUNC bool above(INOUT num list{*},num k) RETURN list{k}>list{k+1}; ENDFUNC
        PROC swap(INOUT num list{*},num k) VAR num held; held:=list{k}; list{k}:=list{k+1}; list{k+1}:=held; ENDPROC
        """,
        "sort short; sort long; IF short{1}=1 AND short{3}=3 AND long{1}=5 AND long{2}=6 AND long{5}=9 SetDO do1,1;",
        frozenset(("urscript",)),  # by reference, of several sizes
    ),
    (
        "where the robot is, with the tool or the frame in use left out",
        """PERS tooldata tProbe:=[TRUE,[[0,0,110],[1,0,0,0]],[0.8,[0,0,50],[1,0,0,0],0,0,0]];
        PERS tooldata tOther:=[TRUE,[[0,20,90],[1,0,0,0]],[0.8,[0,0,50],[1,0,0,0],0,0,0]];
        PERS wobjdata wFix:=[FALSE,TRUE,"",[[480,-120,220],[0.965925826,0,0,0.258819045]],[[10,20,0],[1,0,0,0]]];
        CONST robtarget pSeat:=[[40,30,60],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        """,
        """ConfJ\\Off; MoveJ p1,v500,fine,tProbe; ok:=Distance(CPos(\\Tool:=tProbe),p1.trans)<0.1;
        MoveJ pSeat,v500,fine,tProbe\\WObj:=wFix; here:=CRobT(\\Tool:=tProbe);
        ok:=ok AND Distance(here.trans,pSeat.trans)<0.1; at:=CPos(\\WObj:=wobj0); ok:=ok AND Abs(at.z-280)<0.1;
        at:=CPos(\\Tool:=tOther); IF ok AND Abs(at.z-80)<0.1 SetDO do1,1;""",
        frozenset(),
    ),
    (
        "a record that holds an array of records",
        """RECORD dose string what; num grams; bool hot; ENDRECORD
        RECORD batch num total; dose parts{2}; pos spot; ENDRECORD
        VAR batch b1; VAR batch b2:=[3,[["sand",5,FALSE],["dye",7,TRUE]],[1,2,3]];""",
        """b1.parts{1}:=["resin",20,TRUE]; b1.total:=b1.parts{1}.grams+b2.parts{2}.grams; ok:=b1.total=27;
        b1:=b2; ok:=ok AND b1.parts{2}.hot AND b1.spot.z=3; b1:=[4,[["a",1,FALSE],["b",2,TRUE]],[7,8,9]];
        IF ok AND b1.total=4 AND StrLen(b1.parts{2}.what)=1 AND b1.spot.x=7 SetDO do1,1;""",
        frozenset(("val3",)),  # values for a whole list
    ),
    (
        "an event behind the start and one before the end, of a computed place",
        COUNT,
        """MoveJ p1,v500,fine,tool0; CONNECT seen WITH tCount; ISignalDO do2,1,seen; TriggIO gun,30\\Start\\DOp:=do2,1;
        TriggIO cut,30\\DOp:=do2,0; TriggL Offs(p1,0,0,-100),v100,gun\\T2:=cut,fine,tool0; WaitTime 0.1;
        IF n=1 AND DOutput(do2)=0 SetDO do1,1;""",
        frozenset(("val3",)),  # no interrupts, no actions on the path
    ),
]


def _keys(event: Event) -> set[str]:
    kind, index, last, _ = event.port or (None, None, None, None)
    known = [str(name) for name in (event.data.get("signal"), *event.names) if name]
    return set(signal_names(kind, known, index, last))


TARGETS = [name for name in registry.target_names() if name != "rapid"]


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize(("name", "others", "body", "refusing"), CASES, ids=[case[0] for case in CASES])
def test_it_holds_there_too(name: str, others: str, body: str, refusing: frozenset[str], target: str) -> None:
    text = f"MODULE checks\n{POINTS}{others}\nPROC main()\n{body}\nENDPROC\nENDMODULE\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("checks.mod", text)], "rapid", diagnostics)
    assert not [item.as_text() for item in diagnostics]
    translation = translate_program(read, target, ABB, None, diagnostics)
    losses = [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert bool(losses) == (target in refusing), losses
    sources = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(sources, target, diagnostics)
    named = with_signal_names(back.program, translation.program)
    entry = entry_name(read.program, None)
    cell = in_words_of(Cell(), read.program, named)
    result = run_program(named, ABB, cell, translation.renamed.get(entry or "", entry))
    lamp = {"digital_out:1"}
    on = [event for event in result.trace if event.kind == "output" and event.data["value"] and lamp & _keys(event)]
    if losses:  # the program stops where the first part is refused
        assert result.status != "finished" and not on
        return
    assert result.status == "finished", result.fault
    assert on, translation.files[0].data.decode("latin-1")
