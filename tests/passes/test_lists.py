"""Lists written out inside of expressions, lists as results and lists compared: the same in every target."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROUTINES = {
    "total": """  def total(v):
    local i = 0
    local sum = 0
    while (i < length(v)):
      sum = sum + v[i]
      i = i + 1
    end
    return sum
  end
""",
    "first": "  def first(v):\n    return v[0]\n  end\n",
    "counted": "  def counted():\n    calls = calls + 1\n    return calls\n  end\n",
    "turned": "  def turned(v):\n    return [v[2], v[1], v[0]]\n  end\n",
}
START = "  calls = 0\n  k = 4\n  n = 0\n"
# What holds after the statements: an expression in the source language.
CASES = {
    "argument": ("", "total([1, 2, 6]) == 9"),
    "computed": ("", "total([k, k + 1]) == 9 and first([k, 2]) == 4"),
    "other sizes": ("", "total([1, 2, 3, 4]) + total([k]) == 14"),
    "in order": ("  n = counted() * 10 + total([counted(), counted()])", "n == 15 and calls == 3"),
    "condition of a loop": ("  while (total([n, 1]) < 5):\n    n = n + 1\n  end", "n == 4"),
    "only where it is asked": ("  if (k == 4 or total([counted(), 1]) > 0):\n    n = 1\n  end", "calls == 0"),
    "second branch": ("  if (k == 5):\n    n = 1\n  elif (first([k, 2]) == 4):\n    n = 2\n  end", "n == 2"),
    "element": ("", "[5, 7, 9][k - 2] == 9"),
    "result": ("  l = [1, 2, 3]\n  r = turned(l)", "r[0] == 3 and r[2] == 1 and l[0] == 1"),
    "result into its argument": ("  l = [1, 2, 3]\n  l = turned(l)", "l[0] == 3 and l[2] == 1"),
    "element of a result": ("", "turned([1, 2, k])[0] == 4"),
    "result of a result": ("", "first(turned(turned([8, 2, 3]))) == 8"),
    "equal": ("  l = [1, 2, 3]", "l == [1, 2, k - 1] and l != [1, 2, 4]"),
    "equal to a result": ("  l = [1, 2, 3]", "turned(l) == [3, 2, 1]"),
}


def read(text: str, dialect: str) -> ReadProgram:
    return read_sources([source_from_text(f"p.{dialect}", text)], dialect, Diagnostics())


@pytest.mark.parametrize("target", ["vplus", "krl", "rapid", "tp", "inform", "rpl"])
@pytest.mark.parametrize("name", CASES)
def test_lists_mean_the_same(name: str, target: str) -> None:
    statements, holds = CASES[name]
    used = "".join(text for routine, text in ROUTINES.items() if f"{routine}(" in statements + holds)
    text = f"def main():\n{used}{START}{statements}\n  set_standard_digital_out(0, {holds})\nend\n"
    own = read(text, "urscript")
    assert [value for _, _, value in run_program(own.program, entry="main").outputs] == [True]
    diagnostics = Diagnostics()
    written = translate_program(own, target, None, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = written.renamed.get("main", "main")
    assert [value for _, _, value in run_program(back.program, entry=entry).outputs] == [True]
