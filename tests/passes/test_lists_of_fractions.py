"""Lists that come from functions hold fractions where the function puts one into them, also in typed languages."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "ur5e"
TEXT = """def main():
  global a = [1, 2, 3]
  def fill(list, i):
    list[i] = 0.5
    return list
  end
  def rest(list):
    return fill(list, 2)
  end
  d = fill(a, 1)
  e = rest(d)
  f = e
  set_standard_digital_out(0, d[1] > 0.4 and d[1] < 0.6)
  set_standard_digital_out(1, e[2] > 0.4 and e[2] < 0.6)
  set_standard_digital_out(2, f[2] > 0.4 and f[2] < 0.6)
  set_standard_digital_out(3, a[1] == 2)
end
"""


@pytest.mark.parametrize("target", ["krl", "inform", "rpl"])
def test_a_list_from_a_function_keeps_its_fractions(target: str) -> None:
    read = read_sources([source_from_text("main.script", TEXT)], "urscript", Diagnostics())
    translation = translate_program(read, target, ARM, None, Diagnostics())
    written = [source_from_bytes(one.path, one.data) for one in translation.files]
    back = read_sources(written, target, Diagnostics())
    result = run_program(back.program, ARM, None, translation.renamed.get("main", "main"))
    assert result.status == "finished", result.fault
    assert [value for _, _, value in result.outputs] == [True] * 4
