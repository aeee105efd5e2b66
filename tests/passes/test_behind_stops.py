"""What stands behind a stop that ends the program is written as if the program went on there: a translation ends what
it cannot say with such a stop, people take it away, and then the settings in front of it hold."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

SCRIPT = """def cell():
  global a = p[0.4, -0.2, 0.3, 0, 3.14, 0]
  global b = p[0.5, -0.2, 0.3, 0, 3.14, 0]
  movel(a, a=1.2, v=0.1)
  {stop}
  other()
  movel(a, a=1.2, v=0.25)
  movel(b, a=1.2, v=0.25)
end
"""
BRANCH = """def cell():
  global a = p[0.4, -0.2, 0.3, 0, 3.14, 0]
  set_tcp(p[0, 0, 0.1, 0, 0, 0])
  if get_standard_digital_in(1):
    set_tcp(p[0, 0, 0.2, 0, 0, 0])
    halt
  end
  movel(a, a=1.2, v=0.25)
end
"""


def _moves(text: str) -> list[str]:
    read = read_sources([source_from_text("cell.script", text)], "urscript", Diagnostics())
    written = translate_program(read, "tp", "ur10e", None, Diagnostics())
    (listing,) = (file.data.decode("ascii") for file in written.files if file.path == "CELL.LS")
    return [line.partition(":")[2].strip(" ;") for line in listing.splitlines() if "mm/sec" in line]


@pytest.mark.parametrize("stop", ["halt", "sync()"])
def test_speeds_behind_a_stop_are_numbers(stop: str) -> None:
    assert _moves(SCRIPT.format(stop=stop)) == [
        "L P[1:a] 100mm/sec FINE",
        "L P[1:a] 250mm/sec FINE",
        "L P[2:b] 250mm/sec FINE",
    ]


def test_a_branch_that_ends_the_program_changes_nothing_behind_it() -> None:
    read = read_sources([source_from_text("cell.script", BRANCH)], "urscript", Diagnostics())
    written = translate_program(read, "tp", "ur10e", None, Diagnostics())
    (listing,) = (file.data.decode("ascii") for file in written.files if file.path == "CELL.LS")
    chosen = [line.partition(":")[2].strip(" ;") for line in listing.splitlines() if "UTOOL_NUM" in line]
    assert chosen == ["UTOOL_NUM=1", "UTOOL_NUM=2"]
