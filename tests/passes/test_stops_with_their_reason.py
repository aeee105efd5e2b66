"""A stop that a pass makes is told once, with the pass's own reason; the text of the output gives that reason too."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """DEF MAIN()
DECL POS P
DECL INT N
P={X 400,Y 0,Z 400,A 0,B 90,C 0,S 2,T 2}
N=2
IF $IN[2] THEN
  N=6
ENDIF
P.S=N
LIN P
END
"""


@pytest.mark.parametrize("target", ["rapid", "tp", "vplus", "inform"])
def test_the_reason_is_the_pass_s_own(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.src", PROGRAM)], "krl", diagnostics)
    written = translate_program(read, target, "kuka_kr6r900sixx", None, diagnostics)
    line = 1 + PROGRAM.splitlines().index("P.S=N")
    assert [item.code.name for item in diagnostics.of(Severity.LOSS) if item.origin.line == line] == [
        "configuration-field"
    ]
    if target == "rapid":
        text = "".join(file.data.decode() for file in written.files)
        assert "not carried over: s is part of the arm configuration" in text, text
