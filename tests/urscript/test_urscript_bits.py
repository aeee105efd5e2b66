"""integer_to_binary_list: the bits of a whole number, the lowest first, here and in other languages."""

import pytest
from test_urscript_tasks_elsewhere import translated

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text

SCRIPT = """def main():
  number = 730418
  bits = integer_to_binary_list(number)
  ones = 0
  i = 0
  while i < 32:
    if bits[i]:
      ones = ones + 1
    end
    i = i + 1
  end
  set_standard_digital_out(0, ones == 9 and length(bits) == 32 and bits[1] and not bits[0])
  less = integer_to_binary_list(-2)
  set_standard_digital_out(1, not less[0] and less[1] and less[31])
end
"""


def test_here() -> None:
    program = read_sources([source_from_text("main.script", SCRIPT)], "urscript", Diagnostics()).program
    assert [each[2] for each in run_program(program, "ur5e").outputs] == [True, True]


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "vplus", "inform"])
def test_elsewhere(target: str) -> None:
    result, losses, _ = translated(SCRIPT, target)
    assert (result.status, losses) == ("finished", [])
    assert [each[2] for each in result.outputs] == [True, True]
