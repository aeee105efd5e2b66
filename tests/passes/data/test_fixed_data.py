"""A variable that nothing assigns is written where it is used, and a signal computed of it has its number."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

SCRIPT = """def main():
  global VICE = 1
  global count = 0
  global limit = 3
  while count < limit:
    set_standard_digital_out(VICE, True)
    count = count + 1
  end
end
"""


@pytest.mark.parametrize(("target", "output"), [("tp", "DO[2:VICE]=ON"), ("inform", "DOUT OT#(2) ON")])
def test_what_nothing_assigns_takes_no_register(target: str, output: str) -> None:
    read = read_sources([source_from_text("main.script", SCRIPT)], "urscript", Diagnostics())
    written = translate_program(read, target, "ur5e", None, Diagnostics())
    text = "".join(file.data.decode("ascii") for file in written.files)
    assert output in text
    assert "count" in written.registers.values()
    kept = {name for (bank, _), name in written.registers.items() if bank != "digital_out"}
    assert kept == {"count"}
