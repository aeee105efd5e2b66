"""Words that ask for a posture (V+ LEFTY) become joints in targets without such words, or their loss is named."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SCARA = """.PROGRAM main()
        RIGHTY
        MOVE safe
        LEFTY
        MOVE PLACE
        BREAK
        CALL report(safe)
        RIGHTY
        MOVE safe
.END
.PROGRAM report(where)
        IF DISTANCE(HERE, where) < 0.1 THEN
            SIGNAL 1
        END
.END
.LOCATIONS
safe 350 100 280 0 180 0
#left 60 -70 50 0
.END
"""
SIX_AXES = """.PROGRAM main()
        MOVE #start
        FLIP
        MOVE safe
        NOFLIP
        MOVE safe
.END
.LOCATIONS
safe 350 100 400 0 180 0
#start 0 -60 150 0 30 0
.END
"""


def translated(text: str, arm: str, target: str) -> tuple[bool, list[str]]:
    read = read_sources([source_from_text("k.v2", text)], "vplus", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, arm, None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = prove_programs(read.program, back.program, arm, entry="main", to_entry=entry_name(back.program))
    return result.agrees, [item.code.name for item in diagnostics.of(Severity.LOSS)]


@pytest.mark.parametrize("place", ["#left", "safe", "SHIFT(safe BY 0,30,0)"])
@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "inform"])
def test_handedness_of_a_scara(place: str, target: str) -> None:
    assert translated(SCARA.replace("PLACE", place), "adept_cobra_s600", target) == (True, [])


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "inform"])
def test_wrist_of_six_axes(target: str) -> None:
    assert translated(SIX_AXES, "adept_viper_s650", target) == (True, [])


def test_a_posture_at_a_place_that_is_known_in_a_run_only() -> None:
    text = SCARA.replace("PLACE", "here").replace("LEFTY", "HERE here\n        LEFTY")
    assert "posture-change-lost" in translated(text, "adept_cobra_s600", "krl")[1]


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "inform"])
def test_a_word_for_the_wrist_where_the_rest_is_open(target: str) -> None:
    """Behind joints that a run computes the arm stands as before, which is said."""
    move = "        HERE #now\n        DECOMPOSE j[1] = #now\n        MOVE #PPOINT(j[1],j[2],j[3],j[4],j[5],j[6]+5)\n"
    text = SIX_AXES.replace("        FLIP\n", f"        BREAK\n{move}        FLIP\n")
    read = read_sources([source_from_text("k.v2", text)], "vplus", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(read, target, "adept_viper_s650", None, diagnostics)
    codes = [item.code.name for item in diagnostics]
    assert "posture-left-open" in codes
    assert not diagnostics.of(Severity.LOSS)


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "inform"])
def test_the_wrist_stays_as_a_word_has_turned_it(target: str) -> None:
    text = SIX_AXES.replace("        NOFLIP\n        MOVE safe", "        MOVE beside\n        MOVE #start")
    text = text.replace("#start 0", "beside 350 140 400 0 180 0\n#start 0")
    assert translated(text, "adept_viper_s650", target) == (True, [])
