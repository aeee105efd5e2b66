"""Externally guided motion: the messages as they travel, and the robot that follows."""

import socket
import struct
from pathlib import Path

import pytest

from tests.controllers.serving import served

pytest.importorskip("aiohttp", reason="the extra `rws` is not installed")
pytest.importorskip("cryptography", reason="the extra `rws` is not installed")

JOINTS = (12.5, 0.0, 0.0, 0.0, 30.0, 0.0)


@pytest.mark.parametrize("number", [0, 1, 127, 128, 300, 2**32 - 1, 2**63])
def test_whole_numbers_there_and_back(number: int) -> None:
    from rpl.controllers.abb.egm import fields, message

    assert fields(message((5, number))) == [(5, number)]


def test_a_message_is_what_protocol_buffers_write() -> None:
    """The examples of the encoding guide of protocol buffers (150, "testing"), and a double."""
    from rpl.controllers.abb.egm import message

    assert message((1, 150)) == bytes.fromhex("089601")
    assert message((2, b"testing")) == bytes.fromhex("120774657374696e67")
    assert message((3, 1.0)) == b"\x19" + struct.pack("<d", 1.0)


@pytest.mark.parametrize("packed", [False, True])
def test_wanted_joints_are_read_packed_or_not(packed: bool) -> None:
    from rpl.controllers.abb.egm import message, wanted_joints

    inner = message((1, struct.pack("<6d", *JOINTS))) if packed else message(*((1, value) for value in JOINTS))
    assert wanted_joints(message((1, message((1, 7))), (2, message((1, inner))))) == JOINTS
    assert wanted_joints(message((1, message((1, 7))))) == ()


@pytest.mark.parametrize("noise", [b"\xff" * 20, b"\x12\x7f\x00", b"\x0b", b"\x09\x00"])
def test_noise_is_no_message(noise: bytes) -> None:
    from rpl.controllers.abb.egm import wanted_joints

    with pytest.raises(ValueError):
        wanted_joints(noise)


def test_the_robot_tells_where_it_is_and_follows(tmp_path: Path) -> None:
    from rpl.controllers.abb.egm import _doubles, _part, fields, message

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as line:
        line.bind(("127.0.0.1", 0))
        line.settimeout(60.0)
        with served("abb", tmp_path, "--robot", "abb_irb120_3_58", "--port", f"egm={line.getsockname()[1]}"):
            told: tuple[float, ...] = ()
            for _ in range(2000):
                data, robot = line.recvfrom(65536)
                told = _doubles(_part(_part(fields(data), 2), 1), 1)
                if told == pytest.approx(JOINTS):
                    break
                joints = message(*((1, value) for value in JOINTS))
                line.sendto(message((1, message((1, 1))), (2, message((1, joints)))), robot)
                line.sendto(b"noise", robot)
            assert told == pytest.approx(JOINTS)
