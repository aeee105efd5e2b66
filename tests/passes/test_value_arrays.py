"""An array passed by value stays the caller's own, whatever the routine does with what it got."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """def main():
  def emptied(values):
    values[0] = 0
    return values[1]
  end
  def read_only(values):
    return values[0]
  end
  list = [9, 8, 7]
  n = emptied(list)
  set_standard_digital_out(0, list[0] == 9 and n == 8 and read_only(list) == 9)
end
"""


def read(text: str, dialect: str) -> ReadProgram:
    return read_sources([source_from_text(f"p.{dialect}", text)], dialect, Diagnostics())


@pytest.mark.parametrize("target", ["vplus", "krl", "rapid", "tp", "inform", "rpl"])
def test_the_caller_keeps_its_array(target: str) -> None:
    diagnostics = Diagnostics()
    written = translate_program(read(PROGRAM, "urscript"), target, None, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = written.renamed.get("main", "main")
    assert [value for _, _, value in run_program(back.program, entry=entry).outputs] == [True]


def test_only_what_changes_is_copied() -> None:
    written = translate_program(read(PROGRAM, "urscript"), "vplus", None, None, Diagnostics())
    text = "".join(file.data.decode() for file in written.files)
    assert "values_given[]" in text and ".PROGRAM read_only(values[])" in text


MORE = PROGRAM.replace("  n = emptied(list)", "  more = [1, 2]\n  n = emptied(more)\n  n = emptied(list)")


def test_of_sizes_that_differ_as_much_is_copied_as_there_is() -> None:
    diagnostics = Diagnostics()
    written = translate_program(read(MORE, "urscript"), "vplus", None, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "vplus", Diagnostics())
    assert [value for _, _, value in run_program(back.program, entry="main").outputs] == [True]


def test_a_copy_of_no_known_size_that_is_handed_on_is_reported() -> None:
    text = MORE.replace("return values[1]", "return read_only(values)").replace("n == 8", "n == 0")
    text = text.replace("  def emptied", "  def read_only(values):\n    return values[0]\n  end\n  def emptied", 1)
    diagnostics = Diagnostics()
    translate_program(read(text, "urscript"), "vplus", None, None, diagnostics)
    assert [item.code.name for item in diagnostics.of(Severity.LOSS)] == ["array-shared"]
