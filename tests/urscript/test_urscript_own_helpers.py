"""A program's function that is called as one that the writer brings along gets another name."""

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """MODULE M
  FUNC num rpl_trunc(num a)
    RETURN a+1;
  ENDFUNC
  PROC main()
    VAR num n;
    n:=rpl_trunc(2.5);
    SetDO do1,n=3.5;
    SetDO do2,Trunc(n)=3;
  ENDPROC
ENDMODULE
"""


def test_both_are_there() -> None:
    read = read_sources([source_from_text("M.mod", PROGRAM)], "rapid", Diagnostics())
    written = translate_program(read, "urscript", "abb_irb1200_5_90", None, Diagnostics())
    text = written.files[0].data.decode()
    assert text.count("def rpl_trunc(") == 1
    assert text.count("def rpl_trunc_2(") == 1 and "rpl_trunc_2(2.5)" in text
