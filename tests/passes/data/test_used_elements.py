"""Of the arrays that a controller brings along only the elements that a program names take registers."""

import re

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr6r900sixx"
PROGRAM = """DEF a()
  DECL INT n
  n=2
  BASE_DATA[3]={X 400.0,Y 0.0,Z 300.0,A 0.0,B 0.0,C 0.0}
  $TOOL=TOOL_DATA[1]
  $BASE=BASE_DATA[NUMBER]
  PTP {X 50,Y 20,Z 100,A 180,B 0,C 180}
  $OUT[1]=BASE_DATA[3].X==400.0
END
"""


def registers(number: str) -> set[str]:
    read = read_sources([source_from_text("a.src", PROGRAM.replace("NUMBER", number))], "krl", Diagnostics())
    written = translate_program(read, "tp", ARM, None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "tp", Diagnostics())
    result = prove_programs(read.program, back.program, ARM, entry="a", to_entry=entry_name(back.program))
    assert result.agrees, result.difference
    text = "".join(file.data.decode() for file in written.files)
    return set(re.findall(r"PR\[\d+:\w+_DATA\d+\]", text))


@pytest.mark.parametrize(("number", "count"), [("3", 1), ("n+1", 32)])
def test_elements_by_constant_and_by_computed_numbers(number: str, count: int) -> None:
    """Frame 3 or all 32; tool 1, which nothing assigns, is a number of its own and no register."""
    assert len(registers(number)) == count
