"""Ports that a program writes and reads by one name, and groups that are given more than eight bits hold."""

from __future__ import annotations

import pytest

from rpl.cell import Cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

_ROBOT = "ur5e"
_PORTS = """def main():
  write_port_register(130, 30)
  write_port_bit(20, True)
  if read_port_register(130) == 30 and read_port_bit(20):
    textmsg("met")
  end
end
"""
_WIDE = """def main():
  write_output_integer_register(3, 70000)
  if read_output_integer_register(3) == 70000:
    textmsg("met")
  end
end
"""


def _behind(text: str, target: str) -> tuple[list[str], list[str]]:
    """What the translation says when it runs, and the codes of its warnings."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", text)], "urscript", diagnostics)
    written = translate_program(read, target, _ROBOT, None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = run_program(back.program, _ROBOT, Cell(), written.renamed.get("main", "main"), 20.0)
    said = [str(event.data.get("text")) for event in result.trace if event.kind == "message"]
    return said, [item.code.name for item in diagnostics]


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "vplus", "inform"])
def test_a_port_gives_back_what_was_written(target: str) -> None:
    said, _ = _behind(_PORTS, target)
    assert said == ["met"]


@pytest.mark.parametrize("target", ["krl", "vplus"])
def test_a_group_is_as_wide_as_its_numbers_ask_for(target: str) -> None:
    said, codes = _behind(_WIDE, target)
    assert said == ["met"]
    assert "group-too-narrow" not in codes


_COMPUTED = """def main():
  n = 300
  write_output_integer_register(3, n * n)
  k = read_output_integer_register(3)
  if k - n * n == 0:
    textmsg("met")
  end
end
"""


@pytest.mark.parametrize("target", ["krl", "vplus"])
def test_a_register_is_wide_enough_for_what_the_program_works_out(target: str) -> None:
    said, codes = _behind(_COMPUTED, target)
    assert said == ["met"]
    assert "group-too-narrow" not in codes


@pytest.mark.parametrize("target", ["tp", "inform"])
def test_a_register_that_may_be_too_narrow_is_named(target: str) -> None:
    assert "group-too-narrow" in _behind(_COMPUTED, target)[1]


@pytest.mark.parametrize(("target", "named"), [("tp", True), ("inform", True), ("krl", False), ("rapid", False)])
def test_a_longer_cycle_is_named(target: str, named: bool) -> None:
    script = "def main():\n  t = 0\n  while t < 0.1:\n    sync()\n    t = t + get_steptime()\n  end\nend\n"
    assert ("step-time-longer" in _behind(script, target)[1]) == named


@pytest.mark.parametrize("target", ["tp", "inform"])
def test_a_group_that_cannot_be_wide_enough_is_named(target: str) -> None:
    assert "group-too-narrow" in _behind(_WIDE, target)[1]
