"""Tracks, turn-tables and positioners: their poses, and paths in work that they, or the robot's own flange, carry."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.emulator.blending import Corner, Size, blend
from rpl.emulator.mechanismfile import Mechanism, read_mechanisms
from rpl.emulator.mechanisms import Carrier, mechanism_pose
from rpl.emulator.model import load_robot
from rpl.emulator.planner import MotionFault, MoveRequest, PlannedMove, plan
from rpl.emulator.rotations import FloatArray, pose_matrix, rotation_angle, slerp, zyx_to_matrix
from rpl.emulator.splines import plan_block, spline_path
from rpl.errors import UsageError
from rpl.passes.curves import Leg, block
from rpl.passes.rigid import pose_of_matrix

ROBOT = load_robot("abb_irb4600_60_205")
START = np.array([10.0, 20.0, 10.0, 15.0, 40.0, -30.0])
TOOL = pose_matrix([30, -20, 150], zyx_to_matrix([20, 35, -10]))
TABLE = {"name": "table", "kind": "rotary", "root": [1400, 300, 700, 0, 0, 0], "axes": [{"number": 2, "speed": 90}]}
TRACK = {"name": "rail", "kind": "track", "root": [0, -1000, 0, 90, 0, 0], "axes": [{"number": 1, "direction": "x"}]}
TILTED = {
    "name": "manipulator",
    "kind": "positioner",
    "axes": [{"number": 3, "direction": "y"}, {"number": 4, "direction": "z", "place": [0, 0, 100, 0, 0, 0]}],
}


def made(table: dict[str, object], **more: object) -> Mechanism:
    return read_mechanisms([{**table, **more}], "cell.toml")[0]


def place(pose: FloatArray, x: float, y: float, z: float) -> FloatArray:
    return np.asarray((pose @ [x, y, z, 1.0])[..., :3])


def test_a_track_slides_along_its_direction() -> None:
    # its root is turned by 90 degrees about z: x of the track is y of the world
    assert mechanism_pose(made(TRACK), [500.0])[:3, 3] == pytest.approx([0, -500, 0])
    geared = made(TRACK, axes=[{"number": 1, "direction": "-x", "pitch": 0.5}])
    assert mechanism_pose(geared, [500.0])[:3, 3] == pytest.approx([0, -1250, 0])


def test_a_table_turns_what_stands_on_it() -> None:
    table = made(TABLE, flange=[0, 0, 50, 0, 0, 0])
    assert place(mechanism_pose(table, [7.0, 0.0]), 100, 0, 0) == pytest.approx([1500, 300, 750])
    assert place(mechanism_pose(table, [7.0, 90.0]), 100, 0, 0) == pytest.approx([1400, 400, 750])
    assert place(mechanism_pose(table, [7.0]), 100, 0, 0) == pytest.approx([1500, 300, 750])  # has no such axis


@pytest.mark.parametrize(
    ("tilt", "turn", "expected"),
    [
        (0, 0, (50, 0, 100)),
        (90, 0, (100, 0, -50)),  # y turned by 90: x goes to -z, z to x
        (90, 90, (100, 50, 0)),
        (0, 90, (0, 50, 100)),
    ],
)
def test_the_second_axis_of_a_positioner_stands_on_the_first(tilt: float, turn: float, expected: object) -> None:
    pose = mechanism_pose(made(TILTED), [0.0, 0.0, tilt, turn])
    assert place(pose, 50, 0, 0) == pytest.approx(expected, abs=1e-9)


def test_poses_come_for_many_values_at_once() -> None:
    values = np.array([[0.0, 0.0, 10.0, 20.0], [0.0, 0.0, -30.0, 40.0]])
    poses = mechanism_pose(made(TILTED), values)
    assert poses.shape == (2, 4, 4)
    for pose, row in zip(poses, values, strict=True):
        assert pose == pytest.approx(mechanism_pose(made(TILTED), row))


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"name": ""}, r"cell.toml: mechanism\[1\].name: must be a text"),
        ({"kind": "crane"}, r"mechanism\[1\].kind: must be one of track, rotary, positioner"),
        ({"carries": "cake"}, r"mechanism\[1\].carries: must be robot or work"),
        ({"root": [1, 2, 3]}, r"mechanism\[1\].root: must be six numbers"),
        ({"root": [1, 2, 3, float("inf"), 0, 0]}, r"mechanism\[1\].root: must be six numbers"),
        ({"axes": []}, r"mechanism\[1\].axes: a rotary has 1, not 0"),
        ({"axes": [{"number": 7}]}, r"mechanism\[1\].axes\[1\].number: must be the number of an external axis"),
        ({"axes": [{"number": 1, "limits": [10, -10]}]}, r"axes\[1\].limits: must be \[lower, upper\]"),
        ({"axes": [{"number": 1, "speed": 0}]}, r"axes\[1\].speed: must be above zero"),
        ({"axes": [{"number": 1, "pitch": 0}]}, r"axes\[1\].pitch: must not be zero"),
        ({"axes": [{"number": 1, "direction": "w"}]}, r"axes\[1\].direction: must be x, y, z"),
        ({"axes": [{"number": 1, "colour": 1}]}, r"axes\[1\].colour: unknown"),
        ({"colour": 1}, r"mechanism\[1\].colour: unknown"),
        ({"carries": "robot", "on": "robot"}, r"mechanism\[1\].on: "),
    ],
)
def test_wrong_tables_name_file_and_key(change: dict[str, object], complaint: str) -> None:
    with pytest.raises(UsageError, match=complaint):
        made(TABLE, **change)


@pytest.mark.parametrize(
    ("second", "complaint"),
    [
        ({**TILTED, "name": "Table"}, "two have the name 'table'"),
        ({**TRACK, "axes": [{"number": 2}]}, "'rail': external axis 2 is used twice"),
    ],
)
def test_mechanisms_of_one_cell_differ(second: dict[str, object], complaint: str) -> None:
    with pytest.raises(UsageError, match=complaint):
        read_mechanisms([TABLE, second], "cell.toml")


# ---- paths


def planned(request: MoveRequest, start: FloatArray = START) -> PlannedMove:
    move = plan(ROBOT, start, request)
    assert isinstance(move, PlannedMove), move
    return move


def work_of(carrier: Carrier, joints: FloatArray, external: FloatArray) -> FloatArray:
    return carrier.in_work(ROBOT.forward(joints)[None], external[None])[0]


def goal_from(first: FloatArray, way: tuple[float, float, float], turn: tuple[float, float, float]) -> FloatArray:
    goal = first @ pose_matrix([0, 0, 0], zyx_to_matrix(turn))
    goal[:3, 3] += way
    return goal


def assert_on_the_line(move: PlannedMove, carrier: Carrier, goal: FloatArray) -> None:
    """Forward kinematics of arm and mechanism put the tool on the line in the work, in position and orientation."""
    times = np.linspace(0.0, move.duration_s, 41)
    first = work_of(carrier, move.start_joints, move.external_at(0.0))
    done = carrier.in_work(ROBOT.forward(move.joints_at(times)), move.external_at(times))
    share = np.linalg.norm(done[:, :3, 3] - first[:3, 3], axis=1) / np.linalg.norm(goal[:3, 3] - first[:3, 3])
    expected = first[:3, 3] + share[:, None] * (goal[:3, 3] - first[:3, 3])
    assert np.abs(done[:, :3, 3] - expected).max() < 1e-6
    between = np.swapaxes(slerp(first, goal, share), 1, 2) @ done[:, :3, :3]
    assert rotation_angle(between).max() < 1e-8
    assert done[-1] == pytest.approx(goal, abs=1e-6)


def test_a_fixed_tool_draws_a_straight_line_in_the_part_that_the_robot_turns() -> None:
    fixed = ROBOT.forward(START) @ pose_matrix([60, 40, 250], zyx_to_matrix([10, 60, -30]))
    carrier = Carrier(fixed, np.eye(4), stationary=True)
    first = work_of(carrier, START, np.zeros(1))
    goal = goal_from(first, (80, -40, 30), (25, -15, 20))
    move = planned(MoveRequest("linear", target_pose=goal, carrier=carrier, path_speed_mm_s=100))
    assert_on_the_line(move, carrier, goal)
    assert move.length_mm == pytest.approx(np.linalg.norm([80, 40, 30]))


def test_a_fixed_tool_draws_an_arc_in_the_part() -> None:
    fixed = ROBOT.forward(START) @ pose_matrix([60, 40, 250], zyx_to_matrix([10, 60, -30]))
    carrier = Carrier(fixed, np.eye(4), stationary=True)
    first = work_of(carrier, START, np.zeros(1))
    centre = first[:3, 3] + [0, 50, 0]
    via, goal = goal_from(first, (0, 50, 50), (0, 0, 0)), goal_from(first, (0, 100, 0), (0, 30, 0))
    move = planned(MoveRequest("circular", target_pose=goal, via_pose=via, carrier=carrier))
    times = np.linspace(0.0, move.duration_s, 31)
    done = carrier.in_work(ROBOT.forward(move.joints_at(times)), np.zeros((31, 1)))[:, :3, 3]
    assert np.linalg.norm(done - centre, axis=1) == pytest.approx(np.full(31, 50.0), abs=1e-6)
    assert done[:, 0] == pytest.approx(np.full(31, first[0, 3]), abs=1e-6)
    assert move.length_mm == pytest.approx(50 * np.pi)


def test_a_tool_on_a_turning_table_keeps_its_line() -> None:
    carrier = Carrier(TOOL, np.eye(4), mount=made(TABLE))
    begin = (0.0, 0.0)
    first = work_of(carrier, START, np.array(begin))
    goal = goal_from(first, (60, 50, 20), (10, 0, 15))
    request = MoveRequest(
        "linear", target_pose=goal, carrier=carrier, external_start=begin, external_target=(0.0, 40.0),
        external_speeds=(500.0, 90.0),
    )  # fmt: skip
    move = planned(request)
    assert_on_the_line(move, carrier, goal)
    assert move.external_at(move.duration_s) == pytest.approx([0.0, 40.0])


def test_the_slowest_of_tool_orientation_and_external_axes_governs() -> None:
    carrier = Carrier(TOOL, np.eye(4), mount=made(TABLE))
    first = work_of(carrier, START, np.zeros(2))

    def lasts(way: float, turn: float, table: float) -> float:
        goal = goal_from(first, (0, way, 0), (turn, 0, 0))
        request = MoveRequest(
            "linear", target_pose=goal, carrier=carrier, external_start=(0.0, 0.0), external_target=(0.0, table),
            external_speeds=(500.0, 10.0), external_accs=(None, 100.0), path_speed_mm_s=100, path_acc_mm_s2=1000,
            ori_speed_deg_s=20, ori_acc_deg_s2=100,
        )  # fmt: skip
        return planned(request).duration_s

    assert lasts(50, 0, 0) == pytest.approx(50 / 100 + 100 / 1000)
    assert lasts(50, 20, 0) == pytest.approx(20 / 20 + 20 / 100)
    assert lasts(50, 20, 30) == pytest.approx(30 / 10 + 10 / 100)


def test_a_robot_on_a_track_holds_its_tool_still_in_the_room() -> None:
    rail = made(TRACK)
    carrier = Carrier(TOOL, np.eye(4), rides=rail)
    first = work_of(carrier, START, np.array([300.0]))
    # in the room: the carriage stands at y = -700, turned by 90 degrees
    base = pose_matrix([0, -700, 0], zyx_to_matrix([90, 0, 0]))
    assert first == pytest.approx(base @ ROBOT.forward(START) @ TOOL, abs=1e-9)
    request = MoveRequest(
        "linear", target_pose=first, carrier=carrier, external_start=(300.0,), external_target=(150.0,),
        external_speeds=(100.0,),
    )  # fmt: skip
    move = planned(request)
    times = np.linspace(0.0, move.duration_s, 21)
    done = carrier.in_work(ROBOT.forward(move.joints_at(times)), move.external_at(times))
    assert done == pytest.approx(np.broadcast_to(first, done.shape), abs=1e-6)
    tool = (ROBOT.forward(move.end_joints) @ TOOL)[:3, 3]
    assert tool - (ROBOT.forward(START) @ TOOL)[:3, 3] == pytest.approx([150, 0, 0], abs=1e-6)
    assert move.length_mm == pytest.approx(0.0, abs=1e-9)


def test_a_joint_move_reaches_its_place_on_the_table_where_that_then_is() -> None:
    carrier = Carrier(TOOL, np.eye(4), mount=made(TABLE))
    first = work_of(carrier, START, np.zeros(2))
    goal = goal_from(first, (30, 40, 10), (0, 10, 0))
    request = MoveRequest(
        "joint", target_pose=goal, carrier=carrier, external_start=(0.0, 0.0), external_target=(0.0, 30.0),
        external_speeds=(500.0, 90.0),
    )  # fmt: skip
    move = planned(request)
    assert work_of(carrier, move.end_joints, np.array([0.0, 30.0])) == pytest.approx(goal, abs=1e-6)
    assert move.end_pose == pytest.approx(goal, abs=1e-6)


def test_an_external_axis_outside_its_limits_is_a_fault() -> None:
    request = MoveRequest(
        "joint", target_joints=START, external_start=(0.0,), external_target=(200.0,), external_speeds=(90.0,),
        external_limits=((-180.0, 180.0),),
    )  # fmt: skip
    fault = plan(ROBOT, START, request)
    assert isinstance(fault, MotionFault)
    assert fault.message == "external axis 1 would be at 200.000, outside -180..180"


def test_corners_on_a_turning_table_join_both_lines_at_their_distance() -> None:
    carrier = Carrier(TOOL, np.eye(4), mount=made(TABLE))
    first = work_of(carrier, START, np.zeros(2))
    corner, last = goal_from(first, (100, 0, 0), (0, 0, 0)), goal_from(first, (100, 100, 0), (0, 0, 0))
    one = planned(
        MoveRequest(
            "linear", target_pose=corner, carrier=carrier, external_start=(0.0, 0.0), external_target=(0.0, 10.0),
            external_speeds=(500.0, 90.0),
        )
    )  # fmt: skip
    two = planned(
        MoveRequest(
            "linear", target_pose=last, carrier=carrier, external_start=(0.0, 10.0), external_target=(0.0, 30.0),
            external_speeds=(500.0, 90.0),
        ),
        one.end_joints,
    )  # fmt: skip
    joined = blend(ROBOT, one, two, Size(20.0))
    assert isinstance(joined, Corner)
    assert joined.corner.start_pose[:3, 3] - corner[:3, 3] == pytest.approx([-20, 0, 0], abs=1e-6)
    assert joined.corner.end_pose[:3, 3] - corner[:3, 3] == pytest.approx([0, 20, 0], abs=1e-6)
    times = np.linspace(0.0, joined.corner.duration_s, 9)
    external = joined.corner.external_at(times)
    assert external[[0, -1], 1] == pytest.approx([8.0, 14.0])
    done = carrier.in_work(ROBOT.forward(joined.corner.joints_at(times)), external)
    assert done == pytest.approx(joined.corner.tcp_at(times), abs=1e-6)


@given(
    st.tuples(*[st.floats(-180, 180)] * 4),
    st.booleans(),
    st.booleans(),
    st.sampled_from([None, "table", "tilted"]),
    st.tuples(*[st.floats(-80, 80)] * 6),
)
@settings(max_examples=60, deadline=None)
def test_work_and_flange_are_always_each_others_inverse(
    external: tuple[float, ...], stationary: bool, rides: bool, mount: str | None, joints: tuple[float, ...]
) -> None:
    carriers = {"table": made(TABLE), "tilted": made(TILTED, on="robot")}
    carrier = Carrier(
        TOOL, pose_matrix([5, 6, 7], zyx_to_matrix([1, 2, 3])), stationary, made(TRACK) if rides else None,
        carriers.get(mount or ""),
    )  # fmt: skip
    flange, at = ROBOT.forward(np.array(joints))[None], np.array([external])
    assert carrier.flanges(carrier.in_work(flange, at), at) == pytest.approx(flange, abs=1e-8)


def test_a_spline_block_is_exact_in_a_frame_that_turns() -> None:
    """Its path is that of the same block in a frame that stands still; the table passes what each point says."""
    carrier = Carrier(TOOL, np.eye(4), mount=made(TABLE))
    first = work_of(carrier, START, np.zeros(2))
    goals = [goal_from(first, way, (0, 0, 0)) for way in ((20, 30, 0), (50, 20, 10), (70, 60, 10))]
    turns, before = (10.0, 15.0, 40.0), (0.0, 0.0)
    requests = []
    for goal, turn in zip(goals, turns, strict=True):
        after = (0.0, turn)
        requests.append(
            MoveRequest(
                "linear", target_pose=goal, carrier=carrier, external_start=before, external_target=after,
                external_speeds=(500.0, 90.0), tool=TOOL,
            )
        )  # fmt: skip
        before = after
    found = plan_block(ROBOT, START, requests, ["spline"] * 3)
    assert isinstance(found, list)
    (run,) = found
    move = run.move
    shares = np.linspace(0.0, 1.0, 41)
    external, tools = move.external_along(shares), move.geometry.tcp(shares)
    assert carrier.in_work(ROBOT.forward(move.geometry.joints(shares)), external) == pytest.approx(tools, abs=1e-6)
    assert move.external_along(np.array(run.marks))[:, 1] == pytest.approx(turns)
    assert (np.diff(external[:, 1]) > -1e-9).all()
    legs = [Leg("spline", pose_of_matrix(goal.tolist())) for goal in goals]
    runs = block(pose_of_matrix(first.tolist()), legs)
    assert isinstance(runs, list)
    (segments,) = runs
    still = spline_path(segments)
    assert tools == pytest.approx(still.poses(shares), abs=1e-6)
    steps = np.diff(move.external_at(np.linspace(0.0, move.duration_s, 400))[:, 1]) / (move.duration_s / 399)
    assert steps.max() <= 90.0 + 1e-6
