"""From a trace to a record: the way of the tool, where on it things happen, and what counts."""

import numpy as np
import pytest

from rpl import ir
from rpl.emulator.model import load_robot
from rpl.emulator.planner import MoveRequest, PlannedMove, plan
from rpl.proof.compare import Tolerance, compare
from rpl.proof.record import Record
from rpl.proof.recording import record_of
from rpl.runtime.trace import Event, Leg, RunResult
from rpl.runtime.values import SignalRef

ROBOT = load_robot("kuka_kr6r900sixx")
HOME = np.array([0.0, -90, 90, 0, 45, 0])
PROGRAM = ir.Program((ir.Module("m", "krl"),))


def line(dx: float, dy: float, start: np.ndarray = HOME, speed: float = 250.0) -> PlannedMove:
    pose = ROBOT.forward(start).copy()
    pose[:3, 3] += [dx, dy, 0]
    planned = plan(ROBOT, start, MoveRequest("linear", target_pose=pose, path_speed_mm_s=speed))
    assert isinstance(planned, PlannedMove)
    return planned


def move(planned: PlannedMove, start_s: float) -> Event:
    leg = Leg(planned, start_s, planned.duration_s)
    return Event(start_s, "main", "move", {"motion": planned.kind}, legs=(leg,))


def output(t: float, number: int, value: bool) -> Event:
    return Event(
        t, "main", "output", {"signal": f"$OUT[{number}]", "value": value}, port=SignalRef("digital_out", number)
    )


def record(*events: Event) -> Record:
    end = max(event.t for event in events) + 5.0
    last = Event(end, "main", "end", {"status": "finished"})
    result = RunResult("finished", end, 1, 1, (), (), None, (*events, last))
    return record_of(result, PROGRAM, ROBOT)


def test_the_way_and_where_on_it_an_output_switches() -> None:
    first = line(60, 0)
    second = line(0, 40, first.end_joints)
    half = first.duration_s / 2
    later = first.duration_s + 1.0
    found = record(move(first, 0.0), output(half, 1, True), move(second, later), output(later + 9.0, 2, True))
    stretches = found.motion["main"]
    assert [stretch.motion for stretch in stretches] == ["linear", "linear"]
    assert stretches[1].joints == pytest.approx(second.end_joints)
    one, two, end = found.tasks["main"]
    assert (one.along, one.moving) == (pytest.approx(30.0, abs=0.1), True)
    assert (two.along, two.moving) == (pytest.approx(100.0), False)
    assert one.names == {"out[1]", "digital_out:1"}
    assert (end.kind, end.value) == ("end", "finished")
    assert (found.robot, found.language) == ("kuka_kr6r900sixx", "krl")


def test_speed_does_not_change_the_way() -> None:
    verdict = compare(record(move(line(80, 30), 0.0)), record(move(line(80, 30, speed=40.0), 0.0)), Tolerance())
    assert verdict.max_path_mm < 1e-6
    assert verdict.difference is None or verdict.difference.kind == "time"


def test_a_millimetre_is_found() -> None:
    verdict = compare(record(move(line(80, 30), 0.0)), record(move(line(80, 31), 0.0)), Tolerance())
    assert verdict.max_path_mm == pytest.approx(1.0)
    assert verdict.difference is not None and verdict.difference.kind == "path"


def test_what_does_not_count() -> None:
    events = (
        Event(0.0, "main", "call", {"routine": "sub"}),
        Event(0.1, "main", "wait", {"seconds": 0.0}),
        Event(0.2, "main", "input", {"signal": "di1", "value": True}),
        Event(0.3, "main", "message", {"text": "hello"}),
    )
    assert [happening.kind for happening in record(*events).tasks["main"]] == ["message", "end"]


def test_polling_is_one_wait() -> None:
    polls = tuple(Event(0.1 * number, "main", "wait", {"seconds": 0.1}) for number in range(7))
    more = tuple(Event(0.1 * number, "main", "wait", {"seconds": 0.1}) for number in range(8))
    wait, _ = record(*polls).tasks["main"]
    assert (wait.times, wait.value, wait.longest_s) == (7, pytest.approx(0.7), 0.1)
    once = Event(0.0, "main", "wait", {"seconds": 0.7})
    assert compare(record(*polls), record(once), Tolerance()).level != "none"
    verdict = compare(record(*polls), record(*more), Tolerance())
    assert verdict.difference is None or verdict.difference.level == "time"
    many = tuple(Event(0.1 * number, "main", "wait", {"seconds": 0.1}) for number in range(30))
    found = compare(record(*polls), record(*many), Tolerance()).difference
    assert found is not None and found.kind == "wait"


def test_looks_are_no_part_of_a_wait_behind_them() -> None:
    looks = tuple(Event(0.008 * number, "main", "wait", {"seconds": 0.008}) for number in range(50))
    wait = Event(0.4, "main", "wait", {"seconds": 0.5})
    first, second, _ = record(*looks, wait).tasks["main"]
    assert (first.times, second.times, second.value) == (50, 1, 0.5)
    longer = Event(0.4, "main", "wait", {"seconds": 0.4})
    assert compare(record(wait), record(longer), Tolerance()).difference is not None
