"""The interfaces of the virtual UR controller: bytes as its maker's pages have them, and what our client reads."""

from __future__ import annotations

import math
import socket
import struct
import time
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import pytest

from rpl.controllers.link import GarbledError, LinkError, LostError, RefusedError
from rpl.controllers.ur import rtde
from rpl.controllers.ur.dashboard import Dashboard, state_by
from rpl.controllers.ur.exchange import Exchange, now, watched
from rpl.controllers.ur.pushed import whole_programs
from rpl.controllers.vendors import vendor
from tests.controllers.hosting import Hosted, hosted

pytest.importorskip("asyncssh", reason="the extra `ssh` is not installed")

PROGRAM = b"""def pick():
  set_standard_digital_out(2, True)
  while get_standard_digital_in(1) == False:
    sync()
  end
  movej([0.2, -1.57, -1.57, -1.57, 1.57, 0], a=10, v=3)
  write_output_integer_register(3, read_input_integer_register(3) + 1)
  write_output_float_register(2, 2.5)
  while True:
    sync()
  end
end
"""
FILES = {"pick.script": PROGRAM, "broken.script": b"def broken(:\n"}
WAITED_S = 60.0


@pytest.fixture
def here() -> Iterator[Hosted]:
    with hosted("ur", FILES, robot="ur5e") as found:
        yield found


class Words:
    """A plain socket that asks the dashboard for anything, also for what our client has no words for."""

    def __init__(self, here: Hosted) -> None:
        self.stream = socket.create_connection(("127.0.0.1", here.endpoints.ports["dashboard"]), WAITED_S)
        self.file = self.stream.makefile("r", encoding="utf-8")
        assert self.file.readline() == "Connected: Universal Robots Dashboard Server\n"

    def __call__(self, line: str) -> str:
        self.stream.sendall(f"{line}\n".encode())
        return self.file.readline().strip()


def waited(here: Hosted, name: str, wanted: float, folder: Path) -> None:
    """Until RTDE gives this value."""
    until = time.monotonic() + WAITED_S
    while (found := now(here.profile(folder), (name,))[name]) != wanted:
        assert time.monotonic() < until, f"{name} stays {found}"


def test_the_dashboard_says_what_the_article_says(here: Hosted) -> None:
    """Universal Robots, "Dashboard Server e-Series" (15690)."""
    ask = Words(here)
    assert ask("PolyscopeVersion") == "URSoftware 5.12.2.1101534 (Sep 08 2022)"
    assert ask("robotmode") == "Robotmode: RUNNING"
    assert ask("get loaded program") == "No program loaded"
    assert ask("play") == "Failed to execute: play"
    assert ask("load nobody.urp") == "File not found: nobody.urp"
    assert ask("load broken.script") == "Error while loading program: broken.script"
    assert ask("load pick.script") == "Loading program: /programs/pick.script"
    assert ask("programState") == "STOPPED pick.script"
    assert ask("play") == "Starting program"
    assert ask("running") == "Program running: true"
    assert ask("pause") == "Pausing program"
    assert ask("programState") == "PAUSED pick.script"
    assert ask("stop") == "Stopped"
    assert ask("is in remote control") == "true"
    assert ask("get serial number").isdigit()
    assert ask("dance") == 'could not understand: "dance"'
    assert {"select", "start", "stop"} <= here.kinds()


def test_a_program_runs_and_is_seen_by_rtde_and_the_link(here: Hosted, tmp_path: Path) -> None:
    ask = Words(here)
    profile = here.profile(tmp_path)
    ask("load pick.script")
    ask("play")
    waited(here, "actual_digital_output_bits", 1 << 2, tmp_path)
    with Dashboard(profile) as dashboard:
        state = state_by(dashboard, "/programs")
    assert (state.running, state.mode, state.selected, state.emergency_stop) == (
        True,
        "remote",
        ("pick.script",),
        False,
    )
    here.cabinet.set_signals({"di2": True, "input_integer_register_3": 6})
    waited(here, "output_int_register_3", 7, tmp_path)
    values = now(profile, ("actual_q", "output_double_register_2", "runtime_state", "robot_status_bits"))
    assert values["actual_q"] == pytest.approx((0.2, -1.57, -1.57, -1.57, 1.57, 0.0), abs=1e-6)
    assert (values["output_double_register_2"], values["runtime_state"]) == (2.5, 2)
    samples = list(islice(watched(profile, ("actual_q", "digital_out[2]", "digital_out[3]"), 0.02), 3))
    assert [one.values["digital_out[2]"] for one in samples] == [True] * 3
    assert samples[-1].values["digital_out[3]"] is False
    status = vendor("ur").status
    assert status is not None
    seen = status(profile)
    assert seen.identity.serial == "20260001" and seen.state.running
    assert seen.joints == pytest.approx([math.degrees(q) for q in values["actual_q"]])  # type: ignore[union-attr]
    assert seen.signals["digital_out[2]"] is True


def test_rtde_packages_are_those_of_the_guide(here: Hosted) -> None:
    """RTDE guide (22229): u16 size with the header, u8 type; V=86, O=79, I=73, S=83, U=85; big endian."""
    with socket.create_connection(("127.0.0.1", here.endpoints.ports["rtde"]), WAITED_S) as stream:
        file = stream.makefile("rb")
        stream.sendall(bytes.fromhex("00 05 56 00 02"))
        assert file.read(4) == bytes.fromhex("00 04 56 01")
        stream.sendall(bytes.fromhex("00 03 76"))
        assert file.read(19) == struct.pack(">HB4I", 19, 118, 5, 12, 2, 1101534)
        names = b"robot_mode,actual_q,"  # ur-rtde ends with a comma
        stream.sendall(struct.pack(">HBd", 11 + len(names), 79, 500.0) + names)
        assert file.read(4 + 14) == struct.pack(">HBB", 18, 79, 1) + b"INT32,VECTOR6D"
        stream.sendall(struct.pack(">HB", 3 + 22, 73) + b"input_int_register_24,")
        assert file.read(9) == struct.pack(">HBB", 9, 73, 1) + b"INT32"
        stream.sendall(bytes.fromhex("00 03 53"))
        assert file.read(4) == bytes.fromhex("00 04 53 01")
        size, kind, recipe, mode, *joints = struct.unpack(">HBBi6d", file.read(56))
        assert (size, kind, recipe, mode) == (56, 85, 1, 7)
        assert joints == pytest.approx([0.0, -math.pi / 2, -math.pi / 2, -math.pi / 2, math.pi / 2, 0.0])
        with socket.create_connection(("127.0.0.1", here.endpoints.ports["rtde"]), WAITED_S) as other:
            reader = other.makefile("rb")
            asked = b"input_int_register_24,nothing"
            other.sendall(struct.pack(">HB", 3 + len(asked), 73) + asked)
            assert reader.read(4 + 16) == struct.pack(">HBB", 20, 73, 0) + b"IN_USE,NOT_FOUND"
        stream.sendall(struct.pack(">HBBi", 8, 85, 1, 77))
        until = time.monotonic() + WAITED_S
        while here.cabinet.signal("input_integer_register_24") != 77:
            assert time.monotonic() < until


def test_the_packets_of_the_open_ports_have_their_sizes(here: Hosted) -> None:
    """Client library headers: sub-packages of 5.x are 47, 251, 37, 74, 101 and 61 bytes; 30003 of 5.12 has 1220."""
    with socket.create_connection(("127.0.0.1", here.endpoints.ports["realtime"]), WAITED_S) as stream:
        data = stream.makefile("rb").read(1220)
    assert struct.unpack(">I", data[:4]) == (1220,)
    assert struct.unpack(">6d", data[252:300]) == pytest.approx((0, -1.5708, -1.5708, -1.5708, 1.5708, 0), abs=1e-4)
    with socket.create_connection(("127.0.0.1", here.endpoints.ports["secondary"]), WAITED_S) as stream:
        file = stream.makefile("rb")
        size, kind = struct.unpack(">IB", file.read(5))
        assert kind == 20 and b"URControl" in file.read(size - 5)
        size, kind = struct.unpack(">IB", file.read(5))
        body = file.read(size - 5)
    assert kind == 16
    sizes = {}
    while body:
        length, part = struct.unpack(">IB", body[:5])
        sizes[part], body = length, body[length:]
    assert sizes == {0: 47, 1: 251, 2: 37, 3: 74, 4: 101, 7: 61}


def test_text_that_is_pushed_runs_at_once(here: Hosted, tmp_path: Path) -> None:
    with socket.create_connection(("127.0.0.1", here.endpoints.ports["secondary"]), WAITED_S) as stream:
        stream.sendall(b"set_standard_digital_out(4, True)\n")
        waited(here, "actual_digital_output_bits", 1 << 4, tmp_path)
    assert "start" in here.kinds()


def test_programs_are_cut_where_their_block_ends() -> None:
    text = "movej(q)\ndef a():\n  if x: # end\n    y()\n  end\nend\nsec b():\n"
    assert whole_programs(text) == (["movej(q)\n", "def a():\n  if x: # end\n    y()\n  end\nend\n"], "sec b():\n")


@pytest.mark.parametrize(
    ("fault", "kind"),
    [
        ("before:2", LostError),
        ("drop:1", LostError),
        ("garbage:1", GarbledError),
        ("garbage:2", GarbledError),
        ("endless:1", (GarbledError, LostError)),
        ("slow:30", LostError),
    ],
)
def test_a_hostile_rtde_ends_in_an_error(fault: str, kind: type[LinkError], tmp_path: Path) -> None:
    with hosted("ur", FILES, fault) as here, pytest.raises(kind):
        now(here.profile(tmp_path, 1.0), ("actual_q",))


@pytest.mark.parametrize("fault", ["garbage:1", "endless:1", "before:1", "drop:1", "slow:30"])
def test_a_hostile_dashboard_ends_in_an_error(fault: str, tmp_path: Path) -> None:
    with (
        hosted("ur", FILES, fault) as here,
        pytest.raises((GarbledError, LostError)),
        Dashboard(here.profile(tmp_path, 1.0)) as dashboard,
    ):
        dashboard.ask("robotmode")


def test_a_name_that_there_is_not_is_refused(here: Hosted, tmp_path: Path) -> None:
    with pytest.raises(RefusedError, match="nothing_like_it"):
        now(here.profile(tmp_path), ("actual_q", "nothing_like_it"))
    with Exchange(here.profile(tmp_path)) as exchange:
        assert exchange.version == (5, 12, 2, 1101534)
    assert rtde.package(rtde.START) == b"\x00\x03S"
