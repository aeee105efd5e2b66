"""RAPID zones in numbers: where the path is left, where the tool and external axes begin to go over to the next target.

Source: ABB RAPID Reference Manual, zonedata: the corner path begins at pzone_tcp; reorientation and external axes begin
at the extended zone (pzone_ori, pzone_eax, never smaller than pzone_tcp) and have where the zone ends the value that
they would have had with stop points; large reorientations and external movements reduce the zone to the smallest of its
relative sizes; no zone is larger than half of a move. Motion principles, 2.3: joint movements have the same zones.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from helpers import ABB, run
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.emulator.rotations import FloatArray, rotation_angle

HEAD = """MODULE m
  CONST robtarget p0:=[[400,-100,400],[0,0,1,0],[0,0,0,0],[{0},9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p1:=[[400,0,400],[0,0,1,0],[0,0,0,0],[{0},9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    ConfJ\\Off; ConfL\\Off;
    MoveJ p0,v100,fine,tool0;
"""
NONE = "9E9"


@dataclass(frozen=True)
class Driven:
    """Poses (k, 4, 4) and external axes (k, e) of the moves behind the first, every half millisecond."""

    poses: FloatArray
    external: FloatArray

    def turned(self) -> FloatArray:
        """Degrees (k,) away from the first orientation."""
        return np.rad2deg(rotation_angle(self.poses[0, :3, :3].T @ self.poses[:, :3, :3]))

    def leaves(self, what: FloatArray, least: float) -> float:
        """How far before the corner point (mm) `what` begins to be more than nothing."""
        return float(-self.poses[int(np.argmax(what > least)), 1, 3])


def driven(*lines: str, external: str = NONE, data: str = "") -> Driven:
    text = HEAD.format(external).replace("PROC main", data + "PROC main") + "\n".join(lines) + "\nENDPROC\nENDMODULE\n"
    result = run("rapid", text, ABB)
    assert result.fault is None, result.fault
    poses, axes = [], []
    for event in [event for event in result.trace if event.kind == "move"][1:]:
        for leg in event.legs:
            times = leg.offset_s + np.arange(0.0, leg.duration_s, 0.0005)
            poses.append(leg.plan.tcp_at(times))
            axes.append(leg.plan.external_at(times))
    return Driven(np.concatenate(poses), np.concatenate(axes))


def target(x: float, y: float, turn_deg: float = 0.0, external: str = NONE) -> str:
    """A target at the height of the others, the tool turned about its own axis."""
    half = np.deg2rad(turn_deg) / 2.0
    return f"[[{x},{y},400],[0,{np.sin(half):.12f},{np.cos(half):.12f},0],[0,0,0,0],[{external},9E9,9E9,9E9,9E9,9E9]]"


def off_path(found: Driven) -> FloatArray:
    return np.asarray(np.abs(found.poses[:, 0, 3] - 400.0))


# ---- the path's zone


@pytest.mark.parametrize(("zone", "size"), [("z10", 10.0), ("z20", 20.0), ("z100", 50.0), ("z20\\Z:=7", 7.0)])
def test_the_path_is_left_at_its_zone_and_met_again_there(zone: str, size: float) -> None:
    """z100 is reduced to half of 100 mm: the robot stands only at the start of the first move, which keeps its 100."""
    text = f"MoveL p1,v20\\V:=20,{zone},tool0;" if "Z:" not in zone else f"MoveL p1,v20,{zone},tool0;"
    text = text.replace("v20\\V:=20", "v20")
    found = driven(text, f"MoveL {target(500, 0)},v20,z0,tool0;", f"MoveL {target(500, 100)},v20,fine,tool0;")
    off = off_path(found)
    assert found.leaves(off, 1e-5) == pytest.approx(size, abs=0.25)
    on_second = np.abs(found.poses[:, 1, 3]) < 1e-9
    assert found.poses[np.argmax(on_second & (off > 1.0)), 0, 3] - 400.0 == pytest.approx(size, abs=0.02)


# ---- the extended zone


def test_the_tool_begins_to_turn_at_its_zone_and_the_path_is_left_later() -> None:
    """z20: 20 mm for the path, 30 mm and 3 degrees for the tool; 10 degrees over 100 mm: 3/10 of 100 is 30 mm."""
    found = driven("MoveL p1,v20,z20,tool0;", f"MoveL {target(500, 0, 10)},v20,fine,tool0;")
    assert found.leaves(found.turned(), 1e-4) == pytest.approx(30.0, abs=0.35)
    assert found.leaves(off_path(found), 1e-5) == pytest.approx(20.0, abs=0.25)
    behind = found.poses[:, 0, 3] - 400.0
    for way in (30.05, 40.0, 80.0):  # as with a stop point: a tenth of a degree per mm
        assert np.interp(way, behind, found.turned()) == pytest.approx(way / 10.0, abs=0.01)
    assert np.interp(25.0, behind, found.turned()) > 2.5 + 0.01  # in the zone the turn begun earlier is ahead


def test_a_large_reorientation_reduces_the_zone_to_its_relative_size() -> None:
    """60 degrees over 100 mm: 3/60 of 100 is 5 mm, also for the path."""
    found = driven("MoveL p1,v20,z20,tool0;", f"MoveL {target(500, 0, 60)},v20,fine,tool0;")
    assert found.leaves(off_path(found), 1e-5) == pytest.approx(5.0, abs=0.1)
    assert found.leaves(found.turned(), 1e-4) == pytest.approx(5.0, abs=0.1)


def test_the_turn_of_the_move_before_counts_as_well() -> None:
    found = driven(f"MoveL {target(400, 0, 60)},v20,z20,tool0;", f"MoveL {target(500, 0, 60)},v20,fine,tool0;")
    assert found.leaves(off_path(found), 1e-5) == pytest.approx(5.0, abs=0.1)


def test_a_zone_for_the_tool_smaller_than_that_of_the_path_is_increased() -> None:
    data = "CONST zonedata zOwn:=[FALSE,20,5,5,90,5,90];\n"
    found = driven("MoveL p1,v20,zOwn,tool0;", f"MoveL {target(500, 0, 10)},v20,fine,tool0;", data=data)
    assert found.leaves(found.turned(), 1e-4) == pytest.approx(20.0, abs=0.35)
    assert found.leaves(off_path(found), 1e-5) == pytest.approx(20.0, abs=0.25)


def test_an_argument_z_changes_the_zone_of_the_path_alone() -> None:
    found = driven("MoveL p1,v20,z20\\Z:=10,tool0;", f"MoveL {target(500, 0, 10)},v20,fine,tool0;")
    assert found.leaves(off_path(found), 1e-5) == pytest.approx(10.0, abs=0.25)
    assert found.leaves(found.turned(), 1e-4) == pytest.approx(30.0, abs=0.35)


def test_external_axes_begin_at_their_zone() -> None:
    """pzone_eax 30 mm; 10 degrees over 100 mm: 3/10 of 100 is 30 mm too. M: an axis that nobody describes turns."""
    found = driven("MoveL p1,v20,z20,tool0;", f"MoveL {target(500, 0, 0, '10')},v20,fine,tool0;", external="0")
    moved = np.abs(found.external[:, 0])
    assert found.leaves(moved, 1e-4) == pytest.approx(30.0, abs=0.35)
    assert found.leaves(off_path(found), 1e-5) == pytest.approx(20.0, abs=0.25)
    behind = found.poses[:, 0, 3] - 400.0
    assert np.interp(60.0, behind, moved) == pytest.approx(6.0, abs=0.01)


def test_a_long_way_of_an_external_axis_reduces_the_zone() -> None:
    """60 degrees over 100 mm: 3/60 of 100 is 5 mm."""
    found = driven("MoveL p1,v20,z20,tool0;", f"MoveL {target(500, 0, 0, '60')},v20,fine,tool0;", external="0")
    assert found.leaves(off_path(found), 1e-5) == pytest.approx(5.0, abs=0.1)


# ---- moves without a way


def test_turns_on_the_spot_go_over_into_each_other_by_the_angle() -> None:
    """40 degrees there, 20 back: 3 degrees before the end of the first turn the second begins (zone_ori of z20)."""
    found = driven(f"MoveL {target(400, -100, 40)},v20,z20,tool0;", f"MoveL {target(400, -100, 20)},v20,fine,tool0;")
    assert np.abs(found.poses[:, :3, 3] - found.poses[0, :3, 3]).max() < 1e-6
    # 37, 40 and 37 degrees are the control points of the parabola between both turns.
    assert found.turned().max() == pytest.approx(40.0 - 3.0 / 2.0, abs=0.01)


def test_external_axes_alone_go_over_into_each_other() -> None:
    """An axis that turns 40 degrees on and 20 back: 3 degrees of each (zone_reax of z20)."""
    found = driven(
        f"MoveL {target(400, -100, 0, '40')},v20,z20,tool0;",
        f"MoveL {target(400, -100, 0, '20')},v20,fine,tool0;",
        external="0",
    )
    assert found.external[:, 0].max() == pytest.approx(38.5, abs=0.01)


def test_between_a_turn_on_the_spot_and_a_way_the_robot_stops() -> None:
    """Half of no distance is the zone."""
    found = driven(f"MoveL {target(400, -100, 40)},v20,z20,tool0;", f"MoveL {target(400, 0, 40)},v20,fine,tool0;")
    assert found.turned()[np.argmax(found.poses[:, 1, 3] > -100.0 + 1e-9)] == pytest.approx(40.0, abs=1e-6)


def test_a_joint_move_has_the_reduced_zone_too() -> None:
    """MoveJ over 100 mm with 60 degrees of the tool: the next move is met 5 mm behind the point."""
    found = driven("MoveJ p1,v20,z20,tool0;", f"MoveL {target(500, 0, 60)},v20,fine,tool0;")
    behind = found.poses[:, 0, 3] - 400.0
    off = np.abs(found.poses[:, 1, 3])
    assert behind[np.argmax((off < 1e-6) & (behind > 1.0))] == pytest.approx(5.0, abs=0.1)


@settings(max_examples=8, deadline=None)
@given(st.floats(1.0, 50.0), st.floats(-30.0, 30.0), st.floats(-30.0, 30.0))
def test_place_and_orientation_never_jump_nor_does_their_speed(size: float, before: float, behind: float) -> None:
    data = f"CONST zonedata zOwn:=[FALSE,{size:.3f},{1.5 * size:.3f},{1.5 * size:.3f},{0.3 * size:.3f},0,0];\n"
    found = driven(
        f"MoveL {target(400, 0, before)},v50,zOwn,tool0;",
        f"MoveL {target(500, 0, behind)},v50,fine,tool0;",
        data=data,
    )
    places = np.linalg.norm(np.diff(found.poses[:, :3, 3], axis=0), axis=1)
    steps = np.swapaxes(found.poses[:-1, :3, :3], 1, 2) @ found.poses[1:, :3, :3]
    turns = np.rad2deg(rotation_angle(steps))
    assert places.max() < 50.0 * 0.0005 * 1.01
    # Fewer than 6 degrees per second change within 0.5 ms would be 12,000 deg/s2; sample times at seams are uneven.
    speeds = turns / np.maximum(places, 1e-12)
    moving = places > 0.5 * places.max()
    for one, two, both in zip(speeds[:-1], speeds[1:], pairwise(moving), strict=True):
        if all(both):
            assert abs(one - two) < 0.05
