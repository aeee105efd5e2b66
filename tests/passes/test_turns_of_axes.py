"""Turns of axes that the target's places do not tell: moves go to joints, or a warning says that turns may differ."""

import pytest

from rpl.diagnostics import Diagnostics
from tests.kept_frames import SYSFRAME
from tests.there_and_back import Journey, there_and_back

ROBOT = "fanuc_lrmate200id"
POSES = {1: (50.0, -90.0, 0), 2: (50.0, -90.0, 1), 3: (-50.0, -90.0, 0), 4: (0.0, 150.0, 0), 5: (0.0, -150.0, 0)}


def listing(*lines: str, name: str = "TURN") -> str:
    numbered = "".join(f"{at:4}:{line} ;\n" for at, line in enumerate(lines, 1))
    points = "".join(
        f"P[{number}]{{\n   GP1:\n\tUF : 0, UT : 1,\tCONFIG : 'N U T, 0, 0, {turn}',\n"
        f"\tX = 420.0  mm,\tY = {y}  mm,\tZ = 20.000  mm,\n\tW = 180.000 deg,\tP = 0.000 deg,\tR = {r} deg\n}};\n"
        for number, (y, r, turn) in POSES.items()
    )
    home = "P[9]{\n   GP1:\n\tUF : 0, UT : 1,\t\n" + "".join(
        f"\tJ{axis}=     {0 if axis != 5 else -90}.000 deg{',' if axis != 6 else ''}\n" for axis in range(1, 7)
    )
    return f"/PROG  {name}\n/ATTR\nDEFAULT_GROUP = 1,*,*,*,*;\n/MN\n{numbered}/POS\n{points}{home}}};\n/END\n"


HOME = "J P[9] 100% FINE"
FRAMES = ("  UTOOL_NUM=1", "  UFRAME_NUM=0")


def joint_6(low: int, high: int) -> tuple[str, ...]:
    return ("  PR[5]=JPOS", "  R[5]=PR[5,6]", f"  IF (R[5]>({low}) AND R[5]<({high})),R[6]=R[6]+1")


def journey(lines: tuple[str, ...], target: str) -> Journey:
    return there_and_back({"TURN.LS": listing(*FRAMES, *lines), "SYSFRAME.VA": SYSFRAME}, "tp", target, ROBOT)


def codes(found: Diagnostics) -> list[str]:
    return [one.code.name for one in found]


WAYS = {
    "to the turn and back": (HOME, "J P[1] 100% FINE", "J P[2] 100% FINE", *joint_6(260, 275)),
    "back": (HOME, "J P[1] 100% FINE", "J P[2] 100% FINE", "J P[1] 100% FINE", *joint_6(-100, -80)),
    "over a path": (HOME, "J P[2] 100% FINE", "L P[3] 100mm/sec FINE", "J P[1] 100% FINE", *joint_6(-100, -80)),
    "the long way": (HOME, "J P[4] 100% FINE", "J P[5] 100% FINE", *joint_6(-160, -140)),
    "behind a jump": (HOME, "J P[2] 100% FINE", "  LBL[1]", *FRAMES, "J P[1] 100% FINE", *joint_6(-100, -80)),
    "in a loop": (
        *(HOME, "  R[7]=0", "  LBL[1]", *FRAMES, "J P[1] 100% FINE", "J P[2] 100% FINE", "  R[7]=R[7]+1"),
        *("  IF R[7]<2,JMP LBL[1]", *joint_6(260, 275)),
    ),
}


@pytest.mark.parametrize("target", ["vplus", "urscript", "inform", "krl", "rapid", "rpl"])
@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_each_axis_comes_to_its_turn(way: tuple[str, ...], target: str) -> None:
    trip = journey(("  R[6]=0", *way, "  IF R[6]=1,DO[1]=ON"), target)
    assert "turn-not-told" not in codes(trip.found)
    result = trip.run("TURN")
    assert result.status == "finished", result.fault
    assert trip.switched_on(result) == {1}


def test_places_in_the_only_turn_that_can_be_stay_places() -> None:
    trip = journey((HOME, "J P[1] 100% FINE", "J P[3] 100% FINE", "  LBL[1]", *FRAMES, "J P[1] 100% FINE"), "vplus")
    assert trip.text.count("MOVE p1") == 2 and "MOVE p3" in trip.text
    assert "turn-not-told" not in codes(trip.found)


@pytest.mark.parametrize(("turned", "told"), [(True, True), (False, False)])
def test_a_place_that_the_program_works_out_is_told(turned: bool, told: bool) -> None:
    moves = ("J P[2] 100% FINE",) if turned else ()
    register = ("  PR[1]=P[1]", "  PR[1,3]=PR[1,3]+R[8]", "J PR[1] 100% FINE")
    trip = journey((HOME, *moves, *register), "vplus")
    assert ("turn-not-told" in codes(trip.found)) is told


@pytest.mark.parametrize("target", ["vplus", "urscript"])
def test_a_place_in_two_frames_whose_joints_are_not_written_is_told(target: str) -> None:
    frame = [f"  PR[1,{number}]={30 if number == 2 else 0}" for number in range(1, 7)]
    moves = ("J P[2] 100% FINE", *frame, "  UFRAME[1]=PR[1]", "  UFRAME_NUM=1", "J P[2] 100% FINE")
    assert "configuration-not-converted" in codes(journey((HOME, *moves), target).found)
