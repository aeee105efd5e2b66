"""Characters and their codes, in targets that have them by another word or only cut and compare texts."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
        AUTO i, $w, $s
        $s = "X1 _:"
        $w = ""
        FOR i = 0 TO 5
            $w = $w+$CHR(97+i)
        END
        IF $w == "abcdef" THEN
            SIGNAL 1
        END
        $w = ""
        FOR i = 1 TO 2
            $w = $w+$CHR(ASC($s,i)+1)
        END
        IF $w == "Y2" THEN
            SIGNAL 2
        END
        IF (ASC($s) == 88) AND (ASC($s,3) == 32) AND (ASC($s,4) == 95) AND (ASC($s,5) == 58) THEN
            SIGNAL 3
        END
.END
"""


@pytest.mark.parametrize("target", ["rapid", "krl", "tp", "inform", "urscript", "rpl"])
def test_codes_of_characters_and_back(target: str) -> None:
    read = read_sources([source_from_text("p.v2", PROGRAM)], "vplus", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, None, None, diagnostics)
    assert not any("guarded" in item.code.name or "not-written" in item.code.name for item in diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = written.renamed.get("main", "main")
    assert [value for _, _, value in run_program(back.program, entry=entry).outputs] == [True] * 3
