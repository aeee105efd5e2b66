"""Points in pulses of an arm whose pulses per degree nobody has said: taught points without a value, and moves to
them."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "motoman_gp12"


def job(name: str, *lines: str) -> tuple[str, str]:
    text = f"""/JOB
//NAME {name}
//POS
///NPOS 1,0,0,1,0,0
///TOOL 0
///POSTYPE PULSE
///PULSE
C00000=-112581,2876,-52713,1095,34938,-48626
P00007=-111044,-86410,-81415,-4390,7023,2426
//INST
///DATE 2023/09/11 14:51
///ATTR SC,RW
///GROUP1 RB1
NOP
"""
    return f"{name}.JBI", text + "\n".join((*lines, "END")) + "\n"


def translated(target: str, *jobs: tuple[str, str]) -> tuple[str, Diagnostics]:
    read = read_sources([source_from_text(*one) for one in jobs], "inform", Diagnostics())
    found = Diagnostics()
    done = translate_program(read, target, ARM, None, found)
    return "\n".join(source_from_bytes(file.path, file.data).text for file in done.files), found


CASES = {
    "rapid": ("PERS robtarget P007;", "MoveJ P007,", "MoveL C00000,"),
    "krl": ("DECL GLOBAL E6POS XP007", "PTP XP007", "LIN XC00000"),
    "tp": ("P007] 50%", "C00000] 100mm/sec"),
    "urscript": ("movej(P007,", "movel(C00000,"),
    "vplus": ("MOVE p007", "MOVES c00000"),
}


@pytest.mark.parametrize("target", CASES)
def test_points_keep_their_names_and_moves_go_to_them(target: str) -> None:
    text, found = translated(target, job("MAIN", "MOVJ P007 VJ=50.00", "MOVL C00000 V=100.0"))
    for line in CASES[target]:
        assert line in text
    assert {item.code.name for item in found.of(Severity.LOSS)} == {"kept-value-unknown"}
    assert "pulses-unknown" in {item.code.name for item in found}
    assert "set first, as on" in text  # nothing moves before they are taught


def test_points_of_two_jobs_stay_apart() -> None:
    text, _ = translated(
        "rapid", job("MAIN", "MOVJ C00000 VJ=50.00", "CALL JOB:SUB"), job("SUB", "MOVJ C00000 VJ=9.00")
    )
    assert "PERS robtarget MAIN_C00000;" in text and "PERS robtarget SUB_C00000;" in text
    assert "MoveJ MAIN_C00000," in text and "MoveJ SUB_C00000," in text
