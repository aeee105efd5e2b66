"""Handles of threads: variables that only `join` and `kill` look at are no data, and what is written has its own."""

from __future__ import annotations

import re

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """def cell():
  place = p[-0.5, -0.2, 0.3, 0, 3.14159, 0]
  global beeps = 0
  thread horn():
    sleep(0.2)
    beeps = beeps + 1
  end
  {handle} = run horn()
  join {handle}
  {after}
  set_standard_digital_out(0, beeps == 1 and point_dist(place, p[-0.5, -0.2, 0.4, 0, 3.14159, 0]) > 0.09)
  height = place[2]
  set_standard_digital_out(1, height == 0.3)
end
"""


def project(handle: str, after: str = "") -> ReadProgram:
    text = PROGRAM.format(handle=handle, after=after)
    return read_sources([source_from_text("cell.script", text)], "urscript", Diagnostics())


def written(read: ReadProgram) -> str:
    (file,) = translate_program(read, "urscript", "ur5e", None, Diagnostics()).files
    back = read_sources([source_from_bytes(file.path, file.data)], "urscript", Diagnostics())
    result = run_program(back.program, "ur5e", entry="cell")
    assert result.status == "finished", result.fault
    assert [bool(value) for _, _, value in result.outputs] == [True, True]
    return file.data.decode("ascii")


def test_a_handle_is_no_data() -> None:
    read = project("horn_run")
    assert not [node for node in walk(*read.program.modules) if isinstance(node, ir.Name) and node.id == "horn_run"]
    text = written(read)
    assert re.findall(r"horn_run\w*.*", text) == ["horn_run = run horn()", "horn_run"]


def test_a_handle_that_is_a_number_too_keeps_its_name() -> None:
    text = written(project("horn_run", "textmsg(horn_run)"))
    assert "horn_run = 1" in text
    assert "global horn_run_2 = run horn()" in text
    assert "join horn_run_2" in text


def test_what_is_read_in_metres_is_not_rounded() -> None:
    text = written(project("h"))
    assert "height = place[2]" in text
    assert "point_dist(place, p[-0.5, -0.2, 0.4, 0, 3.14159, 0]) > 0.09" in text
    assert "rpl_decimals" not in text
