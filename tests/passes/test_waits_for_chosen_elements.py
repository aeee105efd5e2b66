"""A wait for an element that the program chooses: where elements are numbered data, a loop computes the number."""

import pytest

from rpl.cell import parse_cell
from tests.there_and_back import there_and_back

PROGRAM = """MODULE m
  VAR num u{3}:=[0,1,2];
  VAR num i:=2;
  VAR intnum e;
  PROC main()
    CONNECT e WITH seen;
    ISignalDI di1,1,e;
    WaitUntil u{i}=1;
    SetDO do1,1;
    IDelete e;
    WHILE u{i}<3 DO
      u{i}:=u{i}+1;
    ENDWHILE
    IF u{2}=3 SetDO do2,1;
  ENDPROC
  TRAP seen
    i:=3;
  ENDTRAP
ENDMODULE
"""


@pytest.mark.parametrize("target", ["tp", "inform", "vplus", "krl", "urscript"])
def test_it_is_waited_for(target: str) -> None:
    given = there_and_back({"m.mod": PROGRAM}, "rapid", target)
    assert not given.losses, [item.as_text() for item in given.found]
    ended = given.run()
    assert given.switched_on(ended) == {1, 2} and ended.status == "finished"


@pytest.mark.parametrize("target", ["tp", "inform"])
def test_the_condition_is_looked_at_again_and_again(target: str) -> None:
    text = PROGRAM.replace("u{3}:=[0,1,2]", "u{3}:=[0,2,2]").replace("i:=3;", "u{2}:=1;")
    given = there_and_back({"m.mod": text}, "rapid", target)
    cell = parse_cell('[[input]]\ntime = 0.7\nsignal = "di1"\nvalue = true\n')
    ended = given.run(cell=cell)
    assert given.switched_on(ended) == {1, 2} and 0.7 <= ended.time_s < 0.8
