"""Variables of a virtual controller of KUKA, and the program that runs in it."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from rpl.controllers.kuka import c3
from rpl.controllers.kuka.client import Variables, status, watch
from rpl.controllers.kuka.krl import read_structure, read_value, spelled
from rpl.controllers.kuka.wire import Wire
from rpl.controllers.link import NotThereError, RefusedError
from rpl.emulator.model import load_robot
from tests.controllers.hosting import Hosted, hosted

ARM = "kuka_kr6r900sixx"
SOURCE = b"""DEF WORK()\r
INT COUNT\r
COUNT=3\r
$OUT[5]=TRUE\r
NUMBER=42\r
WAIT FOR $IN[2]\r
PTP {A1 10,A2 -90,A3 90,A4 0,A5 0,A6 0}\r
WAIT SEC 600.0\r
END\r
"""
DATA = b"""DEFDAT WORK PUBLIC\r
DECL INT NUMBER=1\r
DECL E6POS XPLACE={X 1.5,Y 2.0,Z 3.0,A 0.0,B 90.0,C 0.0,S 2,T 10,E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 0.0}\r
ENDDAT\r
"""


@pytest.fixture
def here() -> Iterator[Hosted]:
    with hosted("kuka", {"WORK.src": SOURCE, "WORK.dat": DATA}, robot=ARM) as controller:
        yield controller


@pytest.fixture
def wire(here: Hosted) -> Iterator[Wire]:
    found = Wire("127.0.0.1", here.endpoints.ports["c3"], 20.0)
    yield found
    found.close()


def order(wire: Wire, command: int, name: str = "") -> None:
    words = c3.wide(name) + c3.wide("") + b"\x01" if name else b""
    wire.ask(c3.PROGRAM, bytes((command, 0, 1)) + words, name or "program")


def write(wire: Wire, name: str, value: str) -> None:
    wire.ask(c3.WRITE_ASCII, c3.narrow(name.encode()) + c3.narrow(value.encode()), name)


def until(wire: Wire, name: str, value: str) -> None:
    end = time.monotonic() + 60.0
    while wire.value(name) != value and time.monotonic() < end:
        time.sleep(0.01)
    assert wire.value(name) == value


def test_a_program_is_selected_and_runs(here: Hosted, wire: Wire) -> None:
    assert (wire.value("$PRO_STATE1"), wire.value("$PRO_NAME1[]")) == ("#P_FREE", '""')
    with pytest.raises(RefusedError):
        order(wire, c3.PROGRAM_SELECT, "/R1/NONE()")
    order(wire, c3.PROGRAM_SELECT, "/R1/WORK()")
    assert (wire.value("$PRO_STATE1"), wire.value("$PRO_NAME1[]")) == ("#P_RESET", '"WORK"')
    order(wire, c3.PROGRAM_START)
    until(wire, "$OUT[5]", "TRUE")
    until(wire, "NUMBER", "42")
    assert wire.value("COUNT") == "3"
    assert read_structure(wire.value("XPLACE"))["X"] == 1.5
    assert wire.value("XPLACE.B") == "90.00000"
    write(wire, "NUMBER", "7")
    write(wire, "XPLACE.X", "2.5")
    assert (wire.value("NUMBER"), wire.value("XPLACE.X")) == ("7", "2.50000")
    for value in ("TRUE", '"A"', "1.5"):
        with pytest.raises(RefusedError):
            write(wire, "NUMBER", value)
    state = Variables(wire).state()
    assert (state.running, state.program, state.selected, state.line) == (True, "WORK", ("WORK",), 6)
    here.cabinet.set_signal("$IN[2]", True)
    end = time.monotonic() + 60.0
    while read_structure(wire.value("$AXIS_ACT"))["A1"] != 10.0 and time.monotonic() < end:
        time.sleep(0.01)
    assert read_structure(wire.value("$AXIS_ACT"))["A1"] == 10.0
    order(wire, c3.PROGRAM_STOP)
    assert wire.value("$PRO_STATE1") == "#P_STOP"
    order(wire, c3.PROGRAM_CANCEL)
    assert wire.value("$PRO_STATE1") == "#P_FREE"
    assert {"select", "start", "stop"} <= here.kinds()


def test_nothing_starts_with_the_emergency_stop_pressed(here: Hosted, wire: Wire) -> None:
    order(wire, c3.PROGRAM_SELECT, "WORK")
    here.cabinet.press_emergency_stop()
    with pytest.raises(RefusedError, match="access denied"):
        order(wire, c3.PROGRAM_START)
    assert (wire.value("$ALARM_STOP"), wire.value("$PERI_RDY")) == ("FALSE", "FALSE")


def test_what_is_written(wire: Wire) -> None:
    write(wire, "$OV_PRO", "50")
    write(wire, "$OUT[7]", "TRUE")
    assert (wire.value("$OV_PRO"), wire.value("$OUT[7]")) == ("50", "TRUE")
    for name, value in (("$OV_PRO", "200"), ("$IN[1]", "TRUE"), ("$MODE_OP", "#T1"), ("NOTHING", "1")):
        with pytest.raises(RefusedError):
            write(wire, name, value)
    with pytest.raises(NotThereError):
        wire.value("NOTHING")


def test_wide_messages_say_the_same(wire: Wire) -> None:
    assert c3.Reader(wire.ask(c3.READ, c3.wide("$MODE_OP"))).wide() == "#EX"
    assert c3.Reader(wire.ask(c3.WRITE, c3.wide("$OV_PRO") + c3.wide("30"))).wide() == "30"


def test_answers_fit_into_what_others_read_at_once(wire: Wire) -> None:
    """py-openshowvar reads 256 bytes, once."""
    for name in ("$AXIS_ACT", "$POS_ACT", "$PRO_IP1"):
        assert len(wire.value(name)) + 10 <= 256


def test_status_says_what_is_to_be_seen(here: Hosted, tmp_path: Path) -> None:
    found = status(here.profile(tmp_path))
    arm = load_robot(ARM)
    assert found.identity.serial == here.cabinet.serial and found.identity.model == f"#{ARM.upper()}"
    assert (found.state.mode, found.state.emergency_stop, found.state.selected) == ("EX", False, ())
    assert found.joints == pytest.approx(arm.home)
    assert found.xyz_mm == pytest.approx(arm.forward(arm.home)[:3, 3], abs=1e-4)
    assert set(found.orientation) == {"A", "B", "C"}
    assert found.signals["$OUT[1]"] is False
    assert here.kinds() == {"connect", "look"}


def test_values_are_watched(here: Hosted, tmp_path: Path) -> None:
    samples = list(itertools.islice(watch(here.profile(tmp_path), ("$OV_PRO", "$AXIS_ACT", "NOTHING"), 0.01), 2))
    assert samples[0].values["$OV_PRO"] == 100 and samples[1].values["NOTHING"] is None
    axes = samples[1].values["$AXIS_ACT"]
    assert isinstance(axes, tuple) and len(axes) == 12


VALUES = {"TRUE": True, "-3": -3, "1.5e2": 150.0, '"A B"': "A B", "#T1": "#T1", "{X 1}": "{X 1}"}


@pytest.mark.parametrize("text", VALUES)
def test_values_are_read_as_krl_spells_them(text: str) -> None:
    found = read_value(text)
    assert found == VALUES[text] and type(found) is type(VALUES[text])


def test_structures_are_read_by_their_parts() -> None:
    assert read_structure('{PRO_IP: NAME[] "A, B", SNR 12, ON TRUE}') == {"NAME[]": "A, B", "SNR": 12, "ON": True}
    assert read_structure("12") == {}
    assert [spelled(value) for value in (True, 3, -0.0, "A")] == ["TRUE", "3", "0.00000", '"A"']
