"""Moves that a controller leaves out, cuts short, or drives in another posture of the arm. Sources: URScript Manual
5.2, movej (a move is skipped whose blend overlaps); ABB RAPID Reference Manual, 50024 (corner path failure)."""

from dataclasses import replace

import numpy as np
import pytest

from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.project import read_sources
from rpl.proof.postures import (
    Family,
    LeftOut,
    cut_short_difference,
    family_of,
    left_out_difference,
    posture_difference,
)
from rpl.proof.prove import recorded_run
from rpl.proof.record import Place, Record, Stretch
from rpl.source import source_from_text

KUKA = load_robot("kuka_kr6r900sixx")
UR = load_robot("ur5e")


def recorded(language: str, text: str, robot: object = KUKA) -> Record:
    suffix = {"krl": ".src", "urscript": ".script", "rapid": ".mod"}[language]
    program = read_sources([source_from_text(f"m{suffix}", text)], language, Diagnostics()).program
    return recorded_run(program, robot)  # type: ignore[arg-type]


FAMILIES = [
    ((0, -90, 90, 0, 45, 0), ("front", "elbow up", "wrist not turned over")),
    ((0, -90, 90, 180, -45, 180), ("front", "elbow up", "wrist turned over")),
    ((0, -90, 90, 0, 0, 0), ("front", "elbow up", "")),  # a straight wrist is on the boundary
]


@pytest.mark.parametrize(("joints", "words"), FAMILIES)
def test_the_family_of_joints(joints: tuple[float, ...], words: tuple[str, ...]) -> None:
    found = family_of(KUKA, np.array(joints, dtype=float))
    assert found is not None
    assert (found.shoulder, found.elbow, found.wrist) == words


def test_every_solution_of_a_pose_is_of_another_family() -> None:
    flange = KUKA.forward(np.array([10.0, -80, 100, 20, 45, 30]))
    found = [family_of(KUKA, one.joints) for one in KUKA.inverse(flange, KUKA.home)]
    assert len(found) == len(set(found)) == len(KUKA.arm.branches)


def test_rounding_decides_no_family() -> None:
    noise = np.full(6, 1e-12)
    for joints in ((0.0, -90, 90, 0, 0, 0), (0.0, -90, 90, 0, 45, 0), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)):
        at = np.array(joints)
        assert family_of(KUKA, at + noise) == family_of(KUKA, at) == family_of(KUKA, at - noise)


def one_move(axes: str) -> Stretch:
    text = f"DEF M()\nPTP {{A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}}\nPTP {{{axes}}}\nEND\n"
    return next(iter(recorded("krl", text).motion.values()))[-1]


def test_one_pose_in_two_postures_is_a_difference() -> None:
    """The tool stands at one place, the wrist is turned over."""
    a, b = one_move("A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0"), one_move("A1 0,A2 -90,A3 90,A4 180,A5 -45,A6 180")
    assert a.goal is not None and b.goal is not None
    assert a.goal == pytest.approx(b.goal, abs=1e-4)
    found = posture_difference("m", a, b)
    assert found is not None
    assert (found.kind, found.level) == ("posture", "geometry")
    assert "wrist not turned over in A, wrist turned over in B" in found.explanation
    assert found.a.place.line == found.b.place.line == 3
    assert posture_difference("m", a, a) is None
    turned = one_move("A1 0,A2 -90,A3 90,A4 0,A5 45,A6 360")  # whole turns are no posture
    assert posture_difference("m", a, turned) is None
    straight = one_move("A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0")
    assert posture_difference("m", straight, b) is None


def test_arms_of_two_builds_have_no_common_families() -> None:
    one, other = Family("A", "front", "", ""), Family("B", "back", "", "")
    assert one.differs(other) == []


OVERLAPPING = (
    "def prog():\n  movej([0.0,-1.57,1.57,-1.57,-1.57,0])\n  movel(p[0.4,-0.2,0.3,0,3.14,0], v=0.1)\n"
    "  movel(p[0.4,-0.1,0.3,0,3.14,0], v=0.1, r={0})\n  movel(p[0.4,-0.04,0.3,0,3.14,0], v=0.1, r={0})\n"
    "  movel(p[0.5,0.1,0.3,0,3.14,0], v=0.1)\nend\n"
)


def test_a_move_that_is_left_out_is_a_difference_with_its_line() -> None:
    a, b = (recorded("urscript", OVERLAPPING.format(radius), UR) for radius in ("0.02", "0.05"))
    assert a.left_out == {}
    ((_, (one,)),) = b.left_out.items()
    assert (one.place.line, one.driven) == (5, False)
    found = left_out_difference(a.left_out, b.left_out, same_language=False)
    assert found is not None
    assert (found.kind, found.b.place.line) == ("left-out", 5)
    assert "left out by the controller in B only" in found.explanation
    assert left_out_difference(b.left_out, b.left_out, same_language=True) is None


def test_what_the_source_leaves_out_is_what_it_means() -> None:
    ours = {"main": (LeftOut(Place("a.script", 5), 1.0, False, "left out"),)}
    assert left_out_difference(ours, {}, same_language=False) is None
    found = left_out_difference(ours, {}, same_language=True)
    assert found is not None and found.a.place.line == 5


def test_one_that_is_driven_with_smaller_corners_counts_too() -> None:
    theirs = {"main": (LeftOut(Place("b.script", 7), 1.0, True, "overlapping"),)}
    found = left_out_difference({}, theirs, same_language=False)
    assert found is not None and "smaller corners" in found.explanation


def rapid(waits: str) -> str:
    nowhere = "[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]"
    places = ((0, "z50"), (100, "fine"))
    moves = [f"MoveL [[400,{y},500],[0,0,1,0],{nowhere}],v1000,{zone},tool0;" for y, zone in places]
    start = "MoveAbsJ [[0,-90,90,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;"
    return f"MODULE m\nPROC main()\n{start}\n{moves[0]}\n{waits}\n{moves[1]}\nENDPROC\nENDMODULE\n"


def test_a_corner_that_becomes_a_stop_is_a_difference() -> None:
    whole, late = (recorded("rapid", rapid(waits)).motion["main"] for waits in ("! on", "WaitTime 3;"))
    assert [one.cut_short for one in whole] == [False] * 3
    assert [one.cut_short for one in late] == [False, True, False]
    found = cut_short_difference("main", whole[1], late[1])
    assert found is not None
    assert (found.kind, found.b.place.line) == ("stop", 4)
    assert cut_short_difference("main", late[1], late[1]) is None
    assert cut_short_difference("main", replace(whole[1], stops=True), late[1]) is None  # both come to rest
