"""BCD, DCB, IDENTICAL and RESET: executed, and carried over to every language."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 SIGNAL 1
 SIGNAL 2
 BITS 5,2 = 3
 n = 1234
 SET a = TRANS(400,10,300,0,180,0)
 SET b = a
 ok = (BCD(45) == 69) AND (BCD(n) == ^H1234) AND (BCD(9) == 9)
 ok = ok AND (DCB(69) == 45) AND (DCB(^H9876) == 9876)
 ok = ok AND IDENTICAL(a,b)
 SET b = SHIFT(a BY 0,0,1)
 ok = ok AND NOT IDENTICAL(a,b)
 RESET
 IF ok AND SIG(-1,-2,-5,-6) THEN
 SIGNAL 3
 END
.END
"""


@pytest.mark.parametrize("target", ["", "krl", "rapid", "tp", "inform", "urscript", "vplus", "rpl"])
def test_each_language_does_the_same(target: str) -> None:
    source = read_sources([source_from_text("main.v2", PROGRAM)], "vplus", Diagnostics())
    program, entry = source.program, "main"
    if target:
        found = Diagnostics()
        translation = translate_program(source, target, "adept_viper_s650", None, found)
        assert not [item.as_text() for item in found.of(Severity.LOSS)]
        again = Diagnostics()
        files = [source_from_bytes(file.path, file.data) for file in translation.files]
        program, entry = read_sources(files, target, again).program, translation.renamed.get("main", "main")
        assert not again.has_errors
    result = run_program(program, "adept_viper_s650", None, entry)
    assert result.status == "finished"
    state = {name: value for _, name, value in result.outputs}
    assert [bool(value) for value in state.values()].count(True) == 1


def test_outputs_whose_numbers_are_computed_are_said_not_to_be_known() -> None:
    found = Diagnostics()
    text = ".PROGRAM main()\nRESET\nFOR i = 1 TO 3\nSIGNAL i\nEND\n.END\n"
    read_sources([source_from_text("main.v2", text)], "vplus", found)
    assert "vplus-reset-computed" in [item.code.name for item in found]
