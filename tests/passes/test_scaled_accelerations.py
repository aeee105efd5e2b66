"""Accelerations that follow the speed (V+ SCALE.ACCEL, Language Reference Guide) in languages without such a switch."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "adept_viper_s650"
PLUS = """.PROGRAM main()
  {before}
  MOVE a
  BREAK
  SPEED 50 ALWAYS
  MOVES b
  BREAK
  SPEED 30
  MOVE c
  BREAK
  ACCEL 60, 60
  MOVES a
  BREAK
  SPEED 100 ALWAYS
  MOVES b
  BREAK
.END
.LOCATIONS
a 330 50 260 0 180 0
b 330 150 260 0 180 0
c 380 -100 260 0 180 0
.END
"""
RAPID = """MODULE m
PROC main()
  ConfL\\Off;
  ConfJ\\Off;
  MoveJ [[330,50,260],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
  MoveL [[330,150,260],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
ENDPROC
ENDMODULE
"""


def both(language: str, text: str, target: str) -> tuple[list[float], list[float], str, set[str]]:
    """Seconds of each move before and behind the translation, its text, and the codes of what was reported."""
    source = read_sources([source_from_text("main", text)], language, Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, ARM, None, found)
    files = [source_from_bytes(one.path, one.data) for one in translation.files]
    back = read_sources(files, target, Diagnostics())
    times = []
    for program, entry in ((source.program, "main"), (back.program, translation.renamed.get("main", "main"))):
        result = run_program(program, ARM, None, entry, controller="plain")
        assert result.status == "finished", result.fault
        times.append([float(str(one.data["duration"])) for one in result.trace if one.kind == "move"])
    text = "\n".join(file.data.decode("utf-8", "replace") for file in translation.files)
    return times[0], times[1], text, {item.code.name for item in found}


@pytest.mark.parametrize("before", ["", "DISABLE SCALE.ACCEL"])
@pytest.mark.parametrize("target", ["krl", "tp", "inform", "urscript", "rpl", "vplus"])
def test_moves_take_their_time(target: str, before: str) -> None:
    """The first move has no start in the program; URScript gives joint moves the speed of the slowest axis."""
    source, made, _, codes = both("vplus", PLUS.format(before=before), target)
    joint = 2 if target == "urscript" else None
    for number in range(1, len(source)):
        assert number == joint or made[number] == pytest.approx(source[number], rel=1e-3), number
    assert "acceleration-follows-speed" not in codes


def test_the_switch_makes_a_difference() -> None:
    scaled, _, _, _ = both("vplus", PLUS.format(before=""), "vplus")
    full, _, _, _ = both("vplus", PLUS.format(before="DISABLE SCALE.ACCEL"), "vplus")
    assert [one > other + 1e-3 for one, other in zip(scaled, full, strict=True)] == [False, True, True, True, False]


def test_a_least_acceleration_is_told() -> None:
    """AccSet takes 20 percent at the least (RAPID reference manual)."""
    _, _, text, codes = both("vplus", PLUS.format(before=""), "rapid")
    assert "AccSet 50,100;" in text
    assert "acceleration-below-least" not in codes
    _, _, _, codes = both("vplus", PLUS.format(before="").replace("SPEED 30", "SPEED 10"), "rapid")
    assert "acceleration-below-least" in codes


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript"])
def test_what_hangs_on_the_run_is_told(target: str) -> None:
    text = PLUS.format(before="fast = SIG(1001)").replace("SPEED 50 ALWAYS", "SPEED 50-20*fast ALWAYS")
    _, _, _, codes = both("vplus", text, target)
    assert "acceleration-follows-speed" in codes


def test_a_program_for_such_a_controller_switches_it_off() -> None:
    source, made, text, _ = both("rapid", RAPID, "vplus")
    assert made[1:] == pytest.approx(source[1:], rel=1e-3)
    assert text.count("DISABLE SCALE.ACCEL") == 1
    assert text.index("DISABLE SCALE.ACCEL") < text.index("MOVE")


def test_corners_by_speed_follow() -> None:
    """The corner is the way in which the move brakes: 500 mm/s with half of 5000 mm/s2. For URScript just
    less than half of the way of 100 mm, so that it keeps clear of the next corner; for TP
    the percentage that begins there."""
    text = PLUS.format(before="").replace("MOVES b\n  BREAK\n  SPEED 30", "MOVES b\n  SPEED 30")
    for target, corner in (("rapid", "z50"), ("urscript", "r=0.04999"), ("inform", "CR=50.0"), ("tp", "CNT75 ACC50")):
        source = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
        files = translate_program(source, target, ARM, None, Diagnostics()).files
        assert corner in "\n".join(file.data.decode("utf-8", "replace") for file in files), target


def test_the_switch_can_be_asked_for() -> None:
    text = PLUS.format(before="IF SWITCH(SCALE.ACCEL) THEN\n SIGNAL 1\n END\n DISABLE SCALE.ACCEL\n SIGNAL -1")
    read = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    result = run_program(read.program, ARM, None, "main", controller="plain")
    assert [value for _, _, value in result.outputs] == [True, False]
