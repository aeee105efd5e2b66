"""Texts compared by their order in languages whose operators only tell whether texts are the same."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 $a = "gear"
 $list[1] = "axle"
 $list[2] = "gears"
 ok = ($list[1] < $a) AND ($a < $list[2]) AND ($a <= "gear") AND NOT ($a > $list[2])
 n = 0
 WHILE $list[n+1] < "gears" DO
 n = n+1
 END
 IF ok AND ("b" > $list[1]) AND (n == 1) THEN
 SIGNAL 1
 END
.END
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript", "vplus", "rpl"])
def test_the_order_is_the_same(target: str) -> None:
    source = read_sources([source_from_text("main.v2", PROGRAM)], "vplus", Diagnostics())
    found, again = Diagnostics(), Diagnostics()
    translation = translate_program(source, target, "adept_viper_s650", None, found)
    assert {item.code.name for item in found.of(Severity.LOSS)} <= {"tp-text-case"}
    files = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(files, target, again)
    assert not again.has_errors
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and len(result.outputs) == 1
    written = "".join(file.data.decode("latin-1") for file in translation.files)
    assert ("text_order" in written.lower()) == (target not in ("vplus", "rpl"))
