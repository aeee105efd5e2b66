"""Corners with a size in mm are CNT: the model of the controller says which. CR is an option that nobody uses."""

from __future__ import annotations

import re

from hypothesis import given
from hypothesis import strategies as st

from postprocessors.tp.passes.continuouscorners import nearest_percent
from rpl.controllerfiles import controller_named
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

FANUC = controller_named("tp")
SPEEDS, EFFORTS = st.floats(50.0, 4000.0), st.floats(0.2, 1.5)


@given(st.integers(1, 100), SPEEDS, EFFORTS)
def test_the_size_of_a_corner_by_percent_gives_the_percent_back(percent: int, speed: float, effort: float) -> None:
    size = FANUC.overlap_distance_mm(percent, speed, effort)
    assert nearest_percent(FANUC, size, speed, effort) == percent


@given(st.floats(0.1, 500.0), SPEEDS, EFFORTS)
def test_no_other_percent_begins_nearer(size: float, speed: float, effort: float) -> None:
    def off(percent: int) -> float:
        return abs(FANUC.overlap_distance_mm(percent, speed, effort) - size)

    assert off(nearest_percent(FANUC, size, speed, effort)) == min(map(off, range(1, 101)))


def krl(speed: str, corner: str) -> str:
    return f"""DEF corners()
DECL REAL fast
fast = 0.2
IF $IN[1] THEN
 fast = 0.3
ENDIF
PTP {{A1 0, A2 -90, A3 90, A4 0, A5 45, A6 0}}
$VEL.CP = {speed}
$APO.CDIS = {corner}
LIN {{X 400, Y 100, Z 400, A 0, B 90, C 0}} C_DIS
LIN {{X 400, Y 400, Z 400, A 0, B 90, C 0}}
END
"""


def corner_of(speed: str, corner: str) -> tuple[str, list[str]]:
    """The word at the end of the path move, and what was reported of corners."""
    read = read_sources([source_from_text("corners.src", krl(speed, corner))], "krl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, "tp", None, None, diagnostics)
    listing = next(one.data.decode("ascii") for one in written.files if one.path.endswith(".LS"))
    found = re.search(r"L P\[.*?(CNT\d+|CR ?\S+|FINE)", listing)
    assert found is not None, listing
    return found[1], [one.message for one in diagnostics if one.code.name == "tp-corner-by-speed"]


def test_a_corner_that_the_controller_can_drive_is_the_nearest_percentage() -> None:
    """Half the speed times the ramp (0.203 s) times the square of the overlap (0.628 of the ramp): 20 mm."""
    corner, told = corner_of("0.5", "20")
    assert corner == "CNT64"
    assert len(told) == 1 and "CNT64 for 20 mm, which begins 19.9 mm" in told[0]


def test_a_corner_larger_than_the_controller_drives_is_its_largest() -> None:
    corner, told = corner_of("0.1", "20")
    assert corner == "CNT100"
    assert len(told) == 1 and "begins 6.7 mm before" in told[0]


def test_at_a_speed_that_the_run_decides_the_distance_stays() -> None:
    corner, told = corner_of("fast", "20")
    assert corner.startswith("CR") and not told


LISTING = """/PROG  ROUND
/ATTR
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:J P[1] 20% FINE    ;
   2:L P[2] 2000mm/sec CNT25    ;
   3:L P[3] 500mm/sec CNT50    ;
   4:L P[2] 250mm/sec CNT100    ;
   5:L P[1] 250mm/sec FINE    ;
/POS
P[1]{
   GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', X = 400 mm,
   Y = 0 mm, Z = 200 mm, W = 180 deg, P = 0 deg, R = 0 deg
};
P[2]{
   GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', X = 400 mm,
   Y = 200 mm, Z = 200 mm, W = 180 deg, P = 0 deg, R = 0 deg
};
P[3]{
   GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', X = 300 mm,
   Y = 200 mm, Z = 200 mm, W = 180 deg, P = 0 deg, R = 0 deg
};
/END
"""


def test_percentages_come_back_from_krl_with_its_distances() -> None:
    read = read_sources([source_from_text("round.ls", LISTING)], "tp", Diagnostics())
    there = translate_program(read, "krl", "fanuc_lrmate200id", None, Diagnostics()).files
    texts = [source_from_bytes(one.path, one.data) for one in there if not one.path.endswith((".toml", ".md"))]
    again = read_sources(texts, "krl", Diagnostics())
    back = translate_program(again, "tp", "fanuc_lrmate200id", None, Diagnostics()).files
    listing = "".join(one.data.decode("ascii") for one in back if one.path.endswith(".LS"))
    assert re.findall(r"mm/sec (CNT\d+|CR\S+|FINE)", listing) == ["CNT25", "CNT50", "CNT100", "FINE"]
