"""The port for the robot of a virtual controller of Yaskawa: state, position, variables, signals, running jobs."""

from __future__ import annotations

import itertools
import struct
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from rpl.controllers.link import RefusedError
from rpl.controllers.yaskawa import hses
from rpl.controllers.yaskawa.client import Robot, connect, status, watch
from rpl.controllers.yaskawa.hses import Request
from rpl.controllers.yaskawa.line import Line
from rpl.controllers.yaskawa.loader import place_in_job
from rpl.emulator.model import load_robot
from rpl.errors import UsageError
from tests.controllers.hosting import Hosted, hosted

ARM = "motoman_gp25"
JOB = "\r\n".join(
    (
        "/JOB",
        "//NAME WORK",
        "//POS",
        "///NPOS 0,0,0,1,0,0",
        "///TOOL 0",
        "///POSTYPE PULSE",
        "///PULSE",
        "P00003=13414,0,0,0,0,0",
        "//INST",
        "///DATE 2024/05/06 09:20",
        "///ATTR SC,RW",
        "///GROUP1 RB1",
        "NOP",
        "SET B002 7",
        "SET I003 -5",
        "SET D001 70000",
        "SET R001 1.5",
        'SET S001 "HELLO"',
        "DOUT OT#(3) ON",
        "MOVJ P003 VJ=100.0",
        "TIMER T=600.0",
        "END",
        "",
    )
).encode()


@pytest.fixture
def here() -> Iterator[Hosted]:
    with hosted("yaskawa", {"WORK.JBI": JOB}, robot=ARM) as controller:
        yield controller


@pytest.fixture
def robot(here: Hosted) -> Iterator[Robot]:
    found = Robot(Line("127.0.0.1", here.endpoints.ports["robot"], 20.0), "ascii")
    yield found
    found.close()


def order(
    robot: Robot, command: int, instance: int, data: bytes, attribute: int = 1, service: int = hses.SET_ONE
) -> int:
    """The word of the refusal; 0 when the controller does it."""
    request = Request(hses.ROBOT, service, robot.line.next_number(), command, instance, attribute, data)
    return robot.line.ask(request, again=False).added


def select(robot: Robot, name: str) -> int:
    return order(robot, hses.SELECT, 1, name.encode().ljust(36, b"\x00"), 0, hses.SET_ALL)


ON, OFF = struct.pack("<I", 1), struct.pack("<I", 2)


def until(robot: Robot, line: int) -> None:
    end = time.monotonic() + 60.0
    while robot.job()[1] != line and time.monotonic() < end:
        time.sleep(0.01)
    assert robot.job() == ("WORK", line)


def test_a_job_is_selected_and_runs(here: Hosted, robot: Robot) -> None:
    here.cabinet.time_scale = 20.0
    assert robot.state().running is False
    assert order(robot, hses.START, 1, ON) == 0x4060, "no job is selected"
    assert select(robot, "NONE") == 0x4040
    assert select(robot, "WORK") == 0
    assert order(robot, hses.SERVO, 2, OFF) == 0
    assert order(robot, hses.START, 1, ON) == 0x2070
    assert order(robot, hses.SERVO, 2, ON) == 0
    assert order(robot, hses.START, 1, ON) == 0
    assert robot.state().running
    until(robot, 8)
    assert order(robot, hses.START, 1, ON) == 0x2010
    assert (robot.variable("B", 2), robot.variable("I", 3), robot.variable("D", 1)) == (7, -5, 70000)
    assert (robot.variable("R", 1), robot.variable("S", 1)) == (1.5, "HELLO")
    assert order(robot, hses.BYTE, 2, b"\x08") == 0
    assert robot.variable("B", 2) == 8
    assert order(robot, hses.PLACE, 3, bytes(52), 0, hses.SET_ALL) == 0x2110
    assert robot.signals("OUT", 1, 4) == {"OUT1": False, "OUT2": False, "OUT3": True, "OUT4": False}
    assert robot.variable("P", 3) == (13414.0, *[0.0] * 7)
    assert robot.pulses() == (13414.0, *[0.0] * 7)
    assert order(robot, hses.SERVO, 1, ON) == 0, "on hold"
    assert robot.state().running is False
    assert order(robot, hses.START, 1, ON) == 0x2050
    assert {"select", "start", "servo", "stop"} <= here.kinds()


def test_nothing_runs_that_is_not_in_remote_mode(here: Hosted, robot: Robot) -> None:
    here.cabinet.mode = "manual"
    assert robot.state().mode == "teach"
    assert select(robot, "WORK") == order(robot, hses.START, 1, ON) == order(robot, hses.SERVO, 2, ON) == 0x2100
    link = connect(here.profile(Path()))
    with pytest.raises(RefusedError, match="E2B2"):
        link.put("WORK.JBI", JOB)
    link.close()


def test_position_is_where_the_arm_stands(here: Hosted, robot: Robot) -> None:
    arm = load_robot(ARM)
    assert arm.pulse_scale is not None
    found = robot.pulses()
    assert found is not None
    assert found[:6] == tuple(round(float(a * b)) for a, b in zip(arm.home, arm.pulse_scale, strict=True))
    pose = robot.pose()
    assert pose is not None
    assert pose[:3] == pytest.approx(arm.forward(arm.home)[:3, 3], abs=0.001)


def test_variables_that_no_job_names_keep_what_is_written(robot: Robot) -> None:
    assert robot.variable("B", 50) == 0
    assert order(robot, hses.BYTE, 50, b"\x09") == 0
    assert robot.variable("B", 50) == 9
    assert robot.variable("P", 50) is None
    assert order(robot, hses.INTEGER, 100, b"\x00\x00") == 0xA001
    assert order(robot, hses.REAL, 1, b"\x00") == 0xB003
    place = struct.pack("<13i", 17, 0, 0, 0, 0, 1500, 2000, -3000, 900000, 0, 10000, 0, 0)
    assert order(robot, hses.PLACE, 50, place, 0, hses.SET_ALL) == 0
    assert robot.variable("P", 50) == (1.5, 2.0, -3.0, 90.0, 0.0, 1.0)


def test_several_variables_come_in_one_answer(robot: Robot) -> None:
    words = struct.pack("<Ihhh", 3, 1, -2, 3)
    assert order(robot, hses.INTEGER + 0x288, 10, words, 0, hses.SET_MANY) == 0
    request = Request(hses.ROBOT, hses.GET_MANY, robot.line.next_number(), 0x303, 10, 0, struct.pack("<I", 3))
    assert robot.line.ask(request).data == words
    odd = Request(hses.ROBOT, hses.GET_MANY, robot.line.next_number(), 0x302, 0, 0, struct.pack("<I", 3))
    assert robot.line.ask(odd).added == 0xB004, "bytes come in even numbers"


def test_only_inputs_of_the_network_are_written(robot: Robot) -> None:
    assert order(robot, hses.SIGNALS, 2701, b"\x05") == 0
    assert robot.asked(hses.SIGNALS, 2701, 1, hses.GET_ONE) == b"\x05"
    assert order(robot, hses.SIGNALS, 1, b"\x05") == 0x2110


def test_a_command_that_nobody_knows_is_refused(robot: Robot) -> None:
    request = Request(hses.ROBOT, hses.GET_ALL, 9, 0x999, 1)
    assert robot.line.ask(request).status == hses.NO_SUCH_COMMAND


def test_axes_have_names(robot: Robot) -> None:
    assert robot.asked(hses.AXES, 1)[:8] == b"S\x00\x00\x00L\x00\x00\x00"
    assert robot.asked(hses.AXES, 101, 4, hses.GET_ONE) == b"Rx\x00\x00"


def test_lines_are_counted_from_nop() -> None:
    nop = JOB.split(b"\r\n").index(b"NOP") + 1
    assert place_in_job(JOB, nop) == (0, 0)
    assert place_in_job(JOB, nop + 7) == (7, 1)


def test_status_says_what_is_to_be_seen(here: Hosted, tmp_path: Path) -> None:
    found = status(here.profile(tmp_path, robot=ARM))
    assert found.identity.said() == {
        "maker": "Yaskawa",
        "model": "MOTOMAN-GP25",
        "firmware": "RPL1.00.00A (EN)-00 1.00",
    }
    assert found.state.mode == "remote" and found.state.motors_on
    assert found.joints is not None
    assert found.joints[:6] == pytest.approx(load_robot(ARM).home, abs=0.001)
    assert set(found.orientation) == {"Rx", "Ry", "Rz"}
    assert found.signals["IN1"] is False
    assert status(here.profile(tmp_path)).joints is None, "of which robot the pulses are is not known"
    assert here.kinds() == {"look"}


def test_values_are_watched(here: Hosted, tmp_path: Path) -> None:
    names = ("B050", "position", "IN1", "job", "running")
    samples = list(itertools.islice(watch(here.profile(tmp_path), names, 0.01), 2))
    assert set(samples[1].values) == set(names) and samples[1].t > samples[0].t
    assert samples[0].values["B050"] == 0 and samples[0].values["running"] is False
    with pytest.raises(UsageError, match="no such value"):
        next(watch(here.profile(tmp_path), ("nonsense",), 0.01))
