"""Values of a virtual FANUC controller by the panel interface, and motion by the remote one."""

from __future__ import annotations

import asyncio
import json
import socket
import struct
import time
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

from rpl.controllers.fanuc import snpx
from rpl.controllers.fanuc.client import connect, status, watch
from rpl.controllers.fanuc.snpx import Request, SnpxClient, answer, message_of, request_of
from rpl.controllers.link import GarbledError, LinkError, RefusedError
from rpl.errors import UsageError
from tests.controllers.serving import Served, served

pytest.importorskip("pyftpdlib", reason="the virtual controller needs pyftpdlib")

SAMPLES = Path(__file__).resolve().parents[3] / "samples/tp"
PATIENCE_S = 30.0


@pytest.fixture(scope="module")
def fanuc(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    folder = tmp_path_factory.mktemp("fanuc")
    words = (SAMPLES / "palletiser", "--robot", "fanuc_lrmate200id", "--time-scale", "20")
    with served("fanuc", folder, *words) as one:
        yield one


@pytest.fixture
def panel(fanuc: Served) -> Iterator[SnpxClient]:
    client = SnpxClient(fanuc.host, fanuc.ports["snpx"], PATIENCE_S)
    yield client
    client.close()


@pytest.mark.parametrize("data", [b"", b"\x01\x02", b"abcdef", b"SETASG 1 2 R[1] 0"])
def test_a_request_is_read_as_it_was_written(data: bytes) -> None:
    request = Request(7, snpx.WRITE, snpx.COMMAND, 3, len(data), data)
    found = request_of(message_of(request))
    assert (found.sequence, found.service, found.segment, found.index, found.size) == (7, 7, 0x38, 3, len(data))
    assert found.data[: len(data)] == data
    assert len(message_of(request)) == 56 + (len(data) if len(data) > 6 else 0)


def test_answers_have_the_layout_of_a_recorded_one() -> None:
    """The bytes of an answer that the sources of fanuc-ucl keep from a controller: kind, sequence, where data stand."""
    short, long = answer(2, b"\x05\x06"), answer(4, b"10.23.16.2".ljust(80, b"\x00"))
    assert (short[0], short[2], short[30], short[31], short[44:46]) == (3, 2, 2, 0xD4, b"\x05\x06")
    assert (long[0], long[4], long[31], len(long)) == (3, 80, 0x94, 136)
    assert long[56:66] == b"10.23.16.2"
    assert short[50:52] == b"\x01\xff"


def test_registers_are_written_and_read(panel: SnpxClient) -> None:
    panel.ask(snpx.WRITE, snpx.REGISTERS, 0, 3, struct.pack("<3h", 5, -6, 7))
    assert struct.unpack("<3h", panel.ask(snpx.READ, snpx.REGISTERS, 0, 3)[:6]) == (5, -6, 7)
    start = panel.window("R[2]", 2, "0")
    assert struct.unpack("<f", panel.words(start, 2)) == (-6.0,)


def test_signals_are_written_and_read_bit_by_bit(panel: SnpxClient) -> None:
    panel.ask(snpx.WRITE, snpx.INPUTS, 9, 3, bytes([0b1010]))  # from the second bit of the second byte: DI[10] to [12]
    assert panel.bits(snpx.INPUTS, 9, 6) == [False, True, False, True, False, False]
    assert panel.bits(snpx.OUTPUTS, 9, 6) == [False] * 6


def test_what_has_no_name_is_refused(panel: SnpxClient) -> None:
    start = panel.window("$NOBODY.$KNOWS", 2)
    with pytest.raises(RefusedError):
        panel.words(start, 2)
    with pytest.raises(RefusedError):
        panel.command("SETASG x")


def test_watching_gives_values_by_their_names(fanuc: Served, tmp_path: Path) -> None:
    profile = fanuc.profile(tmp_path, PATIENCE_S)
    names = ["R[40]", "DO[3]", "SR[2]", "$MCR.$GENOVERRIDE", "joints", "place"]
    first, second = islice(watch(profile, names, 0.01), 2)
    assert first.values["R[40]"] == 0.0
    assert first.values["DO[3]"] is False
    assert first.values["$MCR.$GENOVERRIDE"] == 100
    assert isinstance(first.values["joints"], tuple)
    assert isinstance(first.values["place"], tuple)
    assert second.t >= first.t
    with pytest.raises(UsageError, match="there are"):
        next(watch(profile, ["Q[1]"], 0.01))


class Remote:
    """A line of JSON there and back."""

    def __init__(self, host: str, port: int) -> None:
        self.socket = socket.create_connection((host, port), PATIENCE_S)
        self.stream = self.socket.makefile("rwb")

    def ask(self, **packet: Any) -> dict[str, Any]:
        self.stream.write(json.dumps(packet).encode() + b"\r\n")
        self.stream.flush()
        found = json.loads(self.stream.readline())
        assert isinstance(found, dict)
        return found


def test_remote_motion_moves_the_robot_and_is_told_as_a_start(fanuc: Served, tmp_path: Path) -> None:
    port = Remote(fanuc.host, fanuc.ports["rmi"]).ask(Communication="FRC_Connect")["PortNumber"]
    remote = Remote(fanuc.host, port)
    wanted = {"J1": 10.0, "J2": 5.0, "J3": -5.0, "J4": 0.0, "J5": -60.0, "J6": 20.0}
    move = {"JointAngle": wanted, "SpeedType": "Percent", "Speed": 50, "TermType": "FINE", "TermValue": 0}
    assert remote.ask(Instruction="FRC_JointMotionJRep", SequenceID=1, **move)["ErrorID"] != 0  # not initialised
    assert remote.ask(Command="FRC_Initialize")["ErrorID"] == 0
    assert remote.ask(Instruction="FRC_JointMotionJRep", SequenceID=1, **move) == {
        "Instruction": "FRC_JointMotionJRep",
        "ErrorID": 0,
        "SequenceID": 1,
    }
    found = remote.ask(Command="FRC_ReadJointAngles")["JointAngle"]
    assert [found[name] for name in wanted] == pytest.approx(list(wanted.values()), abs=1e-3)
    place = remote.ask(Command="FRC_ReadCartesianPosition")
    upwards = {**place["Position"], "Z": place["Position"]["Z"] + 20.0}
    line = {"SpeedType": "mmSec", "Speed": 100, "TermType": "FINE", "TermValue": 0}
    configuration = place["Configuration"]
    answer = remote.ask(
        Instruction="FRC_LinearMotion", SequenceID=2, Configuration=configuration, Position=upwards, **line
    )
    assert answer["ErrorID"] == 0
    assert remote.ask(Command="FRC_ReadCartesianPosition")["Position"]["Z"] == pytest.approx(upwards["Z"], abs=0.01)
    assert remote.ask(Command="FRC_Nonsense")["ErrorID"] != 0
    assert remote.ask(Command="FRC_Abort")["ErrorID"] == 0
    assert "start" in fanuc.kinds()
    assert status(fanuc.profile(tmp_path, PATIENCE_S)).joints is not None


def test_stream_motion_tells_its_state_and_takes_joints(fanuc: Served) -> None:
    peer = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    peer.settimeout(PATIENCE_S)
    to = (fanuc.host, fanuc.ports["streammotion"])
    peer.sendto(struct.pack(">II", 6, 0), to)
    assert struct.unpack(">II", peer.recv(200)) == (6, 2)
    peer.sendto(struct.pack(">IIII", 3, 2, 1, 0), to)
    assert len(peer.recv(400)) == 8 + 16 + 160
    peer.sendto(struct.pack(">II", 0, 2), to)
    state = peer.recv(200)
    assert len(state) == 8 + 16 + 3 * 36
    joints = list(struct.unpack_from(">9f", state, 8 + 20 + 36 - 4))
    joints[0] += 1.5
    head = struct.pack(">IIIBBHHBBHHHHHH", 5, 2, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0xFFFF, 0x3333, 0x3333)
    peer.sendto(head + struct.pack(">9d", *joints), to)
    deadline = time.monotonic() + PATIENCE_S
    while abs(struct.unpack_from(">9f", peer.recv(200), 8 + 20 + 36 - 4)[0] - joints[0]) > 1e-3:
        assert time.monotonic() < deadline
    peer.sendto(struct.pack(">II", 2, 2), to)
    peer.close()


def test_the_users_driver_moves_and_tells_where_the_robot_is(fanuc: Served) -> None:
    peer = socket.create_connection((fanuc.host, fanuc.ports["mappdk"]), PATIENCE_S)

    def ask(line: str) -> str:
        peer.sendall(f"{line}\n".encode())
        return peer.recv(1024).decode()

    assert peer.recv(1024) == b"0:success"
    joints = (12.0, 5.0, -5.0, 0.0, -60.0, 20.0)
    moved = ":".join(f"{value:+014.6f}" for value in joints)
    assert ask(f"movej:0050:0100:000:0:6:{moved}") == "0:success"
    code, found = ask("curjpos").split(":")
    assert code == "0"
    assert [float(each.split("=")[1]) for each in found.split(",")] == pytest.approx(joints, abs=1e-3)
    place = [float(each.split("=")[1]) for each in ask("curpos").split(":")[1].split(",")]
    place[2] += 10.0
    moved = ":".join(f"{value:+014.6f}" for value in place)
    assert ask(f"movep:0100:0100:000:1:6:{moved}") == "0:success"
    again = [float(each.split("=")[1]) for each in ask("curpos").split(":")[1].split(",")]
    assert again == pytest.approx(place, abs=0.01)
    far = ":".join(f"{value:+014.6f}" for value in (9000.0, *place[1:]))
    assert ask(f"movep:0100:0100:000:1:6:{far}").startswith("1:")
    assert [ask("setdout:00004:true"), ask("getdout:00004"), ask("getdout:00005")] == ["0:success", "0:1", "0:0"]
    assert ask("nonsense").startswith("1:")
    peer.close()


HOSTILE = {
    "noise": bytes(range(256)) * 4,
    "an answer of 64 kB": bytes([1, 0, 0, 0, 255, 255]) + bytes(300),
    "nothing": b"",
    "half an answer": snpx.INIT_ACK[:20],
}


@pytest.mark.parametrize("said", HOSTILE.values(), ids=HOSTILE)
def test_a_hostile_panel_interface_ends_in_an_error_in_time(said: bytes) -> None:
    async def speak(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writer.write(said)
        await writer.drain()
        await reader.read()
        writer.close()

    async def tried() -> None:
        server = await asyncio.start_server(speak, "127.0.0.1", 0)
        port = server.sockets[0].getsockname()[1]
        began = time.monotonic()
        with pytest.raises(LinkError):
            await asyncio.to_thread(SnpxClient, "127.0.0.1", port, 0.5)
        assert time.monotonic() - began < 30.0
        server.close()

    asyncio.run(tried())


def test_a_position_of_the_wrong_length_is_told() -> None:
    with pytest.raises(GarbledError):
        snpx.position_of(bytes(10))


def test_files_are_untouched_by_all_this(fanuc: Served, tmp_path: Path) -> None:
    link = connect(fanuc.profile(tmp_path, PATIENCE_S))
    assert "PICK.LS" in [one.name for one in link.files()]
    link.close()
