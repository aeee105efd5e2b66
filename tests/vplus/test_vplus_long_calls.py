"""Calls that are too long for a line give values of elements through variables of their own; what the callee changes
by reference stays a reference."""

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """MODULE demo
  RECORD cartontype
    num outer_length;
    num outer_width;
    num outer_height;
    num driving_speed;
    num label_number;
  ENDRECORD
  VAR cartontype all_cartons{2}:=[[300,200,100,50,7],[400,300,150,40,8]];
  VAR num total_of_everything:=0;
  PROC main()
    FOR number_of_carton FROM 1 TO 2 DO
      StackOneCarton number_of_carton,all_cartons{number_of_carton},total_of_everything;
    ENDFOR
    IF total_of_everything=1558 SetDO do1,1;
  ENDPROC
  PROC StackOneCarton(num no,cartontype box,INOUT num total)
    total:=total+no+box.outer_length+box.outer_width+box.outer_height+box.driving_speed+box.label_number;
    box.outer_length:=0;
  ENDPROC
ENDMODULE
"""


def test_values_in_front_of_a_long_call() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("demo.mod", PROGRAM)], "rapid", diagnostics)
    written = translate_program(read, "vplus", "abb_irb1200_5_90", None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    sources = [source_from_bytes(file.path, file.data) for file in written.files]
    assert max(len(line) for source in sources for line in source.text.splitlines()) <= 120
    back = read_sources(sources, "vplus", diagnostics)
    result = prove_programs(read.program, back.program, "abb_irb1200_5_90", entry="main", to_entry="main")
    assert result.agrees, result.as_text()


CHANGED = """MODULE demo
  RECORD contourtype
    string name;
    string shape;
    pos centre;
    num width;
    num height;
    bool good;
  ENDRECORD
  VAR contourtype sheet{3}:=[["A","X",[1,2,3],4,5,FALSE],["B","Y",[6,7,8],9,10,FALSE],["C","Z",[1,1,1],1,1,FALSE]];
  VAR num order{3}:=[3,1,2];
  VAR string log:="";
  PROC main()
    FOR i FROM 1 TO 2 DO
      CutOne sheet{order{i}},log;
    ENDFOR
    IF log="CA" SetDO do1,1;
    IF sheet{1}.good AND sheet{3}.good AND NOT sheet{2}.good SetDO do2,1;
    IF sheet{1}.width=5 AND sheet{3}.width=2 AND sheet{2}.width=9 SetDO do3,1;
    IF order{1}=2 SetDO do4,1;
  ENDPROC
  PROC CutOne(INOUT contourtype c,INOUT string text)
    order{1}:=2;
    c.good:=c.centre.x=1 AND c.shape<>"";
    c.width:=c.width+1;
    text:=text+c.name;
    IF c.height>100 c.name:=c.shape;
  ENDPROC
ENDMODULE
"""


def test_elements_by_reference_in_a_long_call() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("demo.mod", CHANGED)], "rapid", diagnostics)
    written = translate_program(read, "vplus", "abb_irb1200_5_90", None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    sources = [source_from_bytes(file.path, file.data) for file in written.files]
    assert max(len(line) for source in sources for line in source.text.splitlines()) <= 120
    back = read_sources(sources, "vplus", diagnostics)
    result = prove_programs(read.program, back.program, "abb_irb1200_5_90", entry="main", to_entry="main")
    assert result.agrees, result.as_text()
