"""What counts as equal and what does not, on records made by hand."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpl.passes import rigid
from rpl.proof.compare import Tolerance, compare
from rpl.proof.paths import gap, length_mm, measure, turn_deg
from rpl.proof.record import Happening, Place, Record, Stretch, signal_names
from rpl.runtime.moves.payloads import Payload
from rpl.runtime.moves.programmed import Programmed

TOLERANCE = Tolerance()


def line(start: tuple[float, ...], end: tuple[float, ...], count: int = 20, **more: object) -> Stretch:
    poses = np.repeat(np.eye(4)[None], count, axis=0)
    shares = np.linspace(0, 1, count)[:, None]
    poses[:, :3, 3] = np.array(start) + shares * (np.array(end) - np.array(start))
    given_values = {"motion": "linear", "joints": np.zeros(6), "place": Place("a.src", 3, "LIN p1"), **more}
    return Stretch(times=np.linspace(0, 1, count), poses=poses, **given_values)  # type: ignore[arg-type]


OUT = Happening("output", 1.0, True, signal_names("digital_out", ["grip"], 3), Place("a.src", 4, "$OUT[3]=TRUE"), 100.0)
NOTE = Happening("message", 1.1, "part  ready", place=Place("a.src", 5, 'MSG("part ready")'), along=100.0)
WAIT = Happening("wait", 1.2, 0.5, longest_s=0.5, place=Place("a.src", 6, "WAIT SEC 0.5"), along=100.0)
END = Happening("end", 2.0, "finished", place=Place("a.src", 7, "END"), along=100.0)
SECOND = np.linspace(1, 2, 20)
MOTION = (line((0, 0, 0), (100, 0, 0)), replace(line((100, 0, 0), (100, 50, 0)), times=SECOND))
RUN = Record("finished", 2.0, {"main": (OUT, NOTE, WAIT, END)}, {"main": MOTION}, "arm", "krl")


def changed(*happenings: Happening) -> Record:
    return replace(RUN, tasks={"main": happenings})


def moved(*stretches: Stretch) -> Record:
    return replace(RUN, motion={"main": stretches})


def test_a_run_equals_itself_in_time_too() -> None:
    verdict = compare(RUN, RUN, TOLERANCE)
    assert (verdict.level, verdict.difference, verdict.max_path_mm) == ("time", None, 0.0)


@pytest.mark.parametrize(
    ("other", "kind"),
    [
        (changed(replace(OUT, value=False), NOTE, WAIT, END), "output"),
        (changed(replace(OUT, names=signal_names("digital_out", [], 4)), NOTE, WAIT, END), "output"),
        (changed(NOTE, OUT, WAIT, END), "order"),
        (changed(OUT, WAIT, END), "order"),
        (changed(OUT, NOTE, replace(WAIT, value=0.6), END), "wait"),
        (changed(OUT, NOTE, replace(WAIT, value=None), END), "wait"),
        (changed(OUT, replace(NOTE, value="part Ready"), WAIT, END), "message"),
        (changed(OUT, NOTE, WAIT, replace(END, value="deadlock")), "end"),
        (changed(OUT, NOTE, WAIT), "end"),
        (changed(OUT, NOTE, WAIT, Happening("fault", 2.0, "reach"), END), "order"),
    ],
)
def test_other_events_are_refuted_whatever_the_motion(other: Record, kind: str) -> None:
    verdict = compare(RUN, other, TOLERANCE)
    assert verdict.level == "none"
    assert verdict.difference is not None
    assert verdict.difference.kind == kind
    assert "a.src" in verdict.difference.as_text()
    back = compare(other, RUN, TOLERANCE)
    assert back.difference is not None


@pytest.mark.parametrize(
    ("other", "kind"),
    [
        (moved(line((0, 0, 0), (101, 0, 0)), line((101, 0, 0), (100, 50, 0))), "path"),
        (moved(line((0, 0, 0), (100, 0, 0)), line((100, 0, 0), (100, 50, 1))), "path"),
        (moved(MOTION[0]), "move"),
        (moved(MOTION[0], replace(MOTION[1], joints=np.array([0, 0, 0, 0, 0, 360.0]))), "joints"),
        (changed(replace(OUT, along=50.0), NOTE, WAIT, END), "place"),
    ],
)
def test_other_geometry_is_refuted_with_both_lines(other: Record, kind: str) -> None:
    verdict = compare(RUN, other, TOLERANCE)
    assert verdict.level == "events"
    assert verdict.difference is not None
    assert verdict.difference.kind == kind
    assert "a.src:" in verdict.difference.as_text()


def test_time_counts_between_programs_of_one_language_only() -> None:
    late = tuple(replace(event, t=event.t + 0.5) for event in RUN.tasks["main"])
    moves = tuple(replace(move, times=move.times * 1.5) for move in MOTION)
    slower = replace(RUN, tasks={"main": late}, motion={"main": moves}, time_s=RUN.time_s + 0.5)
    verdict = compare(RUN, slower, TOLERANCE)
    assert (verdict.level, verdict.difference) == ("geometry", None)
    assert {one.kind for one in verdict.deviations} == {"time"}
    foreign = compare(RUN, replace(slower, language="rapid"), TOLERANCE)
    assert (foreign.level, foreign.difference, foreign.deviations) == ("geometry", None, ())


def test_one_cycle_of_another_controller_s_waiting_loop_is_no_event() -> None:
    look = Happening("wait", 0.9, 0.002, longest_s=0.002)
    other = replace(changed(look, OUT, NOTE, WAIT, END), language="rapid")
    assert compare(RUN, other, TOLERANCE).difference is None
    assert compare(RUN, replace(other, language="krl"), TOLERANCE).difference is not None
    longer = replace(changed(replace(look, value=0.05, longest_s=0.05), OUT, NOTE, WAIT, END), language="rapid")
    assert compare(RUN, longer, TOLERANCE).difference is not None


def test_helper_tasks_of_one_language_belong_to_its_first_task() -> None:
    waits = replace(WAIT, value=1.0, times=500, longest_s=0.002)
    tasks = {"main": (NOTE, WAIT, END), "helper": (OUT, waits, END)}
    assert compare(RUN, replace(RUN, tasks=tasks, language="rapid"), TOLERANCE).difference is None
    assert compare(RUN, replace(RUN, tasks=tasks), TOLERANCE).difference is not None
    late = {"main": (NOTE, WAIT, END), "helper": (replace(OUT, t=1.5), END)}
    assert compare(RUN, replace(RUN, tasks=late, language="rapid"), TOLERANCE).difference is not None


def test_places_on_joint_moves_are_each_controller_s_own() -> None:
    way = line((0, 0, 0), (100, 0, 0), motion="joint")
    way = replace(way, times=way.times * 2.0)
    run = replace(RUN, motion={"main": (way,)}, tasks={"main": (replace(OUT, along=50.0), END)})
    other = replace(run, tasks={"main": (replace(OUT, along=60.0), END)}, language="rapid")
    verdict = compare(run, other, TOLERANCE)
    assert verdict.difference is None
    assert [(one.kind, one.amount) for one in verdict.deviations] == [("place", 10.0)]
    assert compare(run, replace(other, language="krl"), TOLERANCE).difference is not None


def test_one_move_equals_two_on_the_same_line() -> None:
    halves = moved(line((0, 0, 0), (60, 0, 0), stops=False), line((60, 0, 0), (100, 0, 0)), MOTION[1])
    assert compare(RUN, halves, TOLERANCE).difference is None


def test_a_move_to_where_the_robot_is_changes_nothing() -> None:
    lazy = moved(line((0, 0, 0), (0, 0, 0)), *MOTION)
    assert compare(RUN, lazy, TOLERANCE).difference is None


def test_another_arm_may_bend_between_the_ends_of_a_joint_move() -> None:
    detour = np.concatenate([line((0, 0, 0), (50, 80, 0)).poses, line((50, 80, 0), (100, 0, 0)).poses])
    free = Stretch("joint", np.linspace(0, 1, 40), detour, np.ones(6))
    straight = replace(MOTION[0], motion="joint")
    assert compare(moved(straight), moved(free), TOLERANCE).difference is not None
    assert compare(moved(straight), replace(moved(free), robot="other"), TOLERANCE).difference is None


def test_tasks_pair_by_name_and_a_single_one_with_a_single_one() -> None:
    assert compare(RUN, replace(RUN, tasks={"T_ROB1": RUN.tasks["main"]}), TOLERANCE).difference is None
    two = replace(RUN, tasks={"main": RUN.tasks["main"], "SUB": (END,)})
    assert compare(two, replace(two, tasks={"sub": (END,), "MAIN": RUN.tasks["main"]}), TOLERANCE).difference is None
    lone = compare(two, RUN, TOLERANCE).difference
    assert lone is not None and lone.kind == "task"


@pytest.mark.parametrize(
    ("a", "b", "same"),
    [
        (("digital_out", [], 3), (None, ["do3"], None), True),
        (("digital_out", ["$OUT[3]"], 3), (None, ["DO_3"], None), True),
        (("digital_out", [], 3), (None, ["out03"], None), True),
        (("digital_out", ["GRIPPER"], 7), (None, ["gripper"], None), True),
        (("digital_out", [], 3), (None, ["di3"], None), False),
        (("digital_out", [], 3), (None, ["do4"], None), False),
        (("digital_out", ["do3"], 5), (None, ["do5"], None), True),
        (("digital_out", ["valve"], 5), ("digital_out", [], 3), False),
        (("group_out", [], 1), (None, ["go1"], None), True),
        (("analog_out", ["$ANOUT[2]"], 2), (None, ["ao2"], None), True),
    ],
)
def test_signals_of_two_languages_meet(a: tuple, b: tuple, same: bool) -> None:  # type: ignore[type-arg]
    assert bool(signal_names(*a) & signal_names(*b)) is same


coordinates = st.floats(-1000, 1000).map(lambda value: round(value, 3))
points = st.tuples(coordinates, coordinates, coordinates)


@given(points, points, st.integers(2, 80), st.integers(2, 80))
def test_the_density_of_samples_does_not_matter(
    start: tuple[float, ...], end: tuple[float, ...], few: int, many: int
) -> None:
    found = gap(line(start, end, few).poses, line(start, end, many).poses)
    assert found.mm < 1e-6 and found.deg < 1e-6


@given(points, points, st.floats(1, 500))
def test_a_shift_is_found_in_its_full_size(start: tuple[float, ...], end: tuple[float, ...], shift: float) -> None:
    other = line(start, end).poses
    other[:, 2, 3] += shift
    assert gap(line(start, end).poses, other).mm == pytest.approx(shift)


def test_measures_of_a_way() -> None:
    poses = line((0, 0, 0), (30, 40, 0), 11).poses
    assert length_mm(poses) == pytest.approx(50)
    assert measure(poses)[-1] == pytest.approx(50)
    quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    assert turn_deg(np.eye(3), quarter) == pytest.approx(90)
    assert turn_deg(np.eye(3), quarter @ quarter) == pytest.approx(180)


def test_a_message_in_several_lines_is_one_only_for_another_language() -> None:
    lines = (replace(NOTE, value="part"), replace(NOTE, value="ready"))
    other = replace(changed(OUT, *lines, WAIT, END), language="inform")
    assert compare(RUN, other, TOLERANCE).difference is None
    assert compare(other, RUN, TOLERANCE).difference is None
    assert compare(RUN, changed(OUT, *lines, WAIT, END), TOLERANCE).difference is not None
    later = replace(changed(OUT, lines[0], replace(lines[1], t=1.15), WAIT, END), language="inform")
    assert compare(RUN, later, TOLERANCE).difference is not None


def asked(**more: object) -> Programmed:
    return Programmed("linear", **more)  # type: ignore[arg-type]


def load(mass: float, x: float) -> Payload:
    return Payload(mass, rigid.Pose(rigid.Vector(x, 0.0, 0.0), rigid.Rotation((1.0, 0.0, 0.0, 0.0))), (0.0, 0.0, 0.0))


def told(ours: Stretch, theirs: Stretch) -> dict[str, float]:
    verdict = compare(moved(ours), replace(moved(theirs), language="rapid"), TOLERANCE)
    assert verdict.difference is None, verdict.difference
    return {one.kind: round(one.amount, 3) for one in verdict.deviations}


def test_another_mass_hides_no_other_centre() -> None:
    ours = replace(MOTION[0], asked=asked(), loads=(load(2.0, 10.0),))
    theirs = replace(MOTION[0], asked=asked(), loads=(load(3.0, 30.0),))
    assert told(ours, theirs) == {"load": 1.0, "load-centre": 20.0}
    assert told(ours, replace(theirs, loads=())) == {"load": 2.0, "load-centre": 10.0}


def test_accelerations_in_two_units_are_never_equal_in_silence() -> None:
    ours = replace(MOTION[0], asked=asked(acceleration=(2000.0, "mm/s2"), driven_acceleration=2000.0))
    share = asked(acceleration=(0.5, "of the controller's"), driven_acceleration=2000.0)
    assert told(ours, replace(MOTION[0], asked=share)) == {"acceleration-unit": 0.0}
    slower = replace(share, driven_acceleration=1500.0)
    assert told(ours, replace(MOTION[0], asked=slower)) == {"acceleration-unit": 25.0}
    usual = replace(share, usual_acceleration=True)
    assert told(ours, replace(MOTION[0], asked=usual)) == {}


def test_what_is_asked_of_a_part_of_a_way_is_compared() -> None:
    whole = replace(line((0, 0, 0), (100, 0, 0), asked=asked(path_mm_s=100.0)), times=np.linspace(0, 2, 20))
    first = line((0, 0, 0), (60, 0, 0), stops=False, asked=asked(path_mm_s=100.0))
    second = replace(line((60, 0, 0), (100, 0, 0), asked=asked(path_mm_s=120.0)), times=SECOND)
    halves = replace(moved(first, second), language="rapid")
    verdict = compare(moved(whole), halves, TOLERANCE)
    assert verdict.difference is None
    assert [(one.kind, round(one.amount)) for one in verdict.deviations] == [("path-speed", 20)]


def test_moves_that_are_ended_head_for_one_point() -> None:
    def ended(x: float) -> Stretch:
        aim = np.eye(4)
        aim[0, 3] = x
        return line((0, 0, 0), (50, 0, 0), cut=True, aim=aim)

    other = replace(moved(ended(100.0)), language="rapid")
    assert compare(moved(ended(100.0)), other, TOLERANCE).difference is None
    difference = compare(moved(ended(101.0)), other, TOLERANCE).difference
    assert difference is not None and "1.000 mm" in difference.explanation


def test_a_name_with_two_numbers_and_another_sender_are_told() -> None:
    output = replace(OUT, names=signal_names("digital_out", ["grip"], 4))
    note = replace(NOTE, sender="cell")
    ours, theirs = changed(OUT, replace(NOTE, sender="robot"), WAIT, END), changed(output, note, WAIT, END)
    verdict = compare(ours, replace(theirs, language="rapid"), TOLERANCE)
    assert {one.kind for one in verdict.deviations} == {"output-number", "sender"}
    silent = replace(changed(OUT, NOTE, WAIT, END), language="rapid")
    assert compare(ours, silent, TOLERANCE).deviations == ()
