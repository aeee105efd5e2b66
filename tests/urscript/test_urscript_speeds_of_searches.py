"""Speeds of motions that go on (speedl) in other languages: m/s become the target's unit exactly, or are refused."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program
from tests.refusing import refused

ARM = "ur5e"
HEAD = "def main():\n  global v = [0, 0, -0.03, 0, 0, 0]\n  global s = 0.03\n  movej([0, -1.5, 1.5, -1.5, -1.5, 0])\n"
LOOP = HEAD + "  while not get_standard_digital_in(0):\n    speedl({speed}, 0.5, 0.5)\n  end\n  stopl(1)\nend\n"


@pytest.mark.parametrize(
    ("speed", "target", "wanted"),
    [
        ("[0, 0, -0.03, 0, 0, 0]", "krl", "$VEL.CP=0.03\r\n"),
        ("[0, 0, -0.03, 0, 0, 0]", "rapid", ",v30,"),
        ("[0, 0, -s, 0, 0, 0]", "krl", "$VEL.CP=ABS(-s)\r\n"),
        ("[0, 0, -s, 0, 0, 0]", "rapid", "vPath\\V:=Abs(-s)*1000,"),
    ],
)
def test_the_speed_is_in_the_unit_of_the_target(speed: str, target: str, wanted: str) -> None:
    read = read_sources([source_from_text("main.script", LOOP.format(speed=speed))], "urscript", Diagnostics())
    files = translate_program(read, target, ARM, None, Diagnostics()).files
    text = b"".join(one.data for one in files).decode()
    assert wanted.replace("\r\n", "\n") in text.replace("\r\n", "\n")


@pytest.mark.parametrize("target", ["krl", "inform"])
def test_a_speed_in_several_directions_that_the_run_decides_is_refused(target: str) -> None:
    """The search would go as fast as the move before it."""
    assert refused(LOOP.format(speed="v"), "urscript", target, ARM) == [("velocity-motion-lost", 6)]
