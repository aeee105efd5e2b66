"""Whole numbers as the bytes of a text (V+ INTB, LNGB) in every language."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text
from tests.there_and_back import there_and_back

PROGRAM = """.PROGRAM main()
 $tel = $INTB(1234)+$LNGB(-70000)+$CHR(7)
 IF (INTB($tel,1) == 1234) AND (LNGB($tel,3) == -70000) AND (LEN($tel) == 7) THEN
 SIGNAL 1
 END
 IF (ASC($tel,1) == 4) AND (ASC($tel,3) == 255) AND (ASC($tel,4) == 254) AND (ASC($tel,6) == 144) THEN
 SIGNAL 2
 END
 n = -257
 $two = $INTB(n)
 m = 2.6
 $four = $LNGB(m*1000)
 IF (INTB($two) == -257) AND (ASC($two,1) == 254) AND (ASC($two,2) == 255) AND (LNGB($four) == 2600) THEN
 SIGNAL 3
 END
.END
"""


def run(files: list[tuple[str, str]], language: str, entry: str) -> list[str]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(name, text) for name, text in files], language, diagnostics)
    assert not diagnostics.has_errors
    result = run_program(read.program, "adept_viper_s650", None, entry)
    assert result.status == "finished", result.fault
    return [str(value) for _, _, value in result.outputs]


def test_they_are_executed() -> None:
    assert run([("main.v2", PROGRAM)], "vplus", "main") == ["True"] * 3


@pytest.mark.parametrize("target", ["krl", "rapid", "inform", "vplus", "rpl"])
def test_the_bytes_are_the_same(target: str) -> None:
    journey = there_and_back({"main.v2": PROGRAM}, "vplus", target, "adept_viper_s650")
    assert not journey.losses
    result = journey.run()
    assert result.status == "finished" and len(result.outputs) == 3
    if target == "vplus":
        assert "$INTB(1234)" in journey.text


@pytest.mark.parametrize("target", ["tp", "urscript"])
def test_texts_of_printable_signs_hold_no_bytes(target: str) -> None:
    losses = there_and_back({"main.v2": PROGRAM}, "vplus", target, "adept_viper_s650").losses
    assert {"text-bytes-lost", f"{target}-guarded-stop"} <= set(losses)


def test_bytes_beyond_the_end_are_an_error() -> None:
    text = '.PROGRAM main()\n x = INTB("a")\n.END\n'
    read = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    assert run_program(read.program, "adept_viper_s650", None, "main").status != "finished"
