"""Files of a virtual controller of Yaskawa by the High-Speed Ethernet Server: packets, own client, faults."""

from __future__ import annotations

import ftplib
import io
import socket
import struct
import time
from pathlib import Path

import pytest

from rpl.controllers.link import GarbledError, LinkError, LostError, NotThereError, RefusedError
from rpl.controllers.yaskawa import VENDOR, client, hses
from rpl.controllers.yaskawa.client import connect
from rpl.controllers.yaskawa.hses import Answer, Request, answer_of, blocks_of, request_of
from tests.controllers.enduring import Files, endured, requests_of
from tests.controllers.hosting import MOTION, hosted
from tests.controllers.serving import served

SAMPLES = Path(__file__).parents[3] / "samples/inform"


def job(name: str, *lines: str) -> bytes:
    head = ("/JOB", f"//NAME {name}", "//INST", "///DATE 2024/05/06 09:20", "///ATTR SC,RW", "///GROUP1 RB1")
    return "\r\n".join((*head, "NOP", *lines, "END", "")).encode()


OLD = job("WORK", "TIMER T=1.00")
LONG = job("WORK", *(f"SET I000 {number}" for number in range(80)))

# Packets as hsinkoyu/fs100 (MIT) builds them for get_status, select_job("A") and the acknowledgement of block 2 of a
# file, laid out as the manual 160766-1CD says.
HEAD = "59455243 2000 {size} 03 {division} {ack} {number} {block} 3939393939393939"
GOLDEN = {
    "status": (
        HEAD.format(size="0000", division="01", ack="00", number="00", block="00000000") + "7200 0100 00 01 0000",
        Request(hses.ROBOT, hses.GET_ALL, 0, hses.STATUS, 1),
    ),
    "select": (
        HEAD.format(size="2400", division="01", ack="00", number="00", block="00000000")
        + "8700 0100 00 02 0000"
        + "41"
        + "00" * 35,
        Request(hses.ROBOT, hses.SET_ALL, 0, hses.SELECT, 1, data=b"A" + bytes(35)),
    ),
    "acknowledgement": (
        HEAD.format(size="0000", division="02", ack="01", number="07", block="02000000") + "0000 0000 00 16 0000",
        Request(hses.FILES, hses.READ, 7, block=2, acknowledges=True),
    ),
}


@pytest.mark.parametrize("name", GOLDEN)
def test_requests_are_laid_out_as_the_manual_says(name: str) -> None:
    packet, request = GOLDEN[name]
    assert request.packed() == bytes.fromhex(packet)
    assert request_of(bytes.fromhex(packet)) == request


def test_an_answer_that_says_no_has_the_word_behind_its_head() -> None:
    packet = Answer(hses.FILES, hses.READ, 3, hses.REFUSED, 0xE2B3).packed()
    assert packet[24:30] == bytes.fromhex("96 1f 01 00 b3e2")
    assert answer_of(packet).meaning == "file not found (E2B3)"


def test_the_last_block_is_marked() -> None:
    assert [(block, len(part)) for block, part in blocks_of(bytes(900))] == [(1, 400), (2, 400), (hses.LAST | 3, 100)]
    assert list(blocks_of(b"")) == [(hses.LAST | 1, b"")]


@pytest.mark.parametrize("length", [0, 31, 33])
def test_what_is_no_packet_is_said(length: int) -> None:
    with pytest.raises(hses.PacketError):
        answer_of(bytes(length))


def test_the_command_serves_files(tmp_path: Path) -> None:
    with served("yaskawa", tmp_path, SAMPLES / "machine_tending", "--save", tmp_path / "kept") as here:
        link = connect(here.profile(tmp_path))
        assert [one.name for one in link.files()] == ["TEND.JBI"]
        data = link.fetch("tend.jbi")
        assert data == (SAMPLES / "machine_tending/TEND.JBI").read_bytes()
        link.put("OTHER.JBI", data)
        assert VENDOR.rules.same("OTHER.JBI", data, link.fetch("OTHER.JBI"))
        assert data != link.fetch("OTHER.JBI"), "the controller writes its own date"
        link.delete("TEND.JBI")
        assert [one.name for one in link.files()] == ["OTHER.JBI"]
        link.close()
        assert here.kinds() == {"look", "list", "read", "write", "delete"}
        here.stop()
        assert (tmp_path / "kept/OTHER.JBI").read_bytes().startswith(b"/JOB")


def test_a_job_is_the_same_but_for_its_date_and_line_ends() -> None:
    same = VENDOR.rules.same
    assert same("A.JBI", OLD, OLD.replace(b"2024/05/06 09:20", b"2026/01/01 00:00").replace(b"\r\n", b"\n"))
    assert not same("A.JBI", OLD, OLD.replace(b"1.00", b"2.00"))


REFUSED = {
    "no job": (b"hello\r\n", "5170"),
    "no end": (OLD.replace(b"END\r\n", b""), "5130"),
    "empty": (b"", "empty"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_the_loader_says_what_is_wrong(name: str, tmp_path: Path) -> None:
    data, word = REFUSED[name]
    with hosted("yaskawa", {"WORK.JBI": OLD}) as here:
        link = connect(here.profile(tmp_path))
        with pytest.raises(RefusedError, match=word):
            link.put("WORK.JBI", data)
        assert link.fetch("WORK.JBI") == OLD
        link.close()


def test_names_are_as_long_as_the_controller_has_them(tmp_path: Path) -> None:
    with hosted("yaskawa", {}) as here:
        link = connect(here.profile(tmp_path, options={"name_length": "8"}))
        with pytest.raises(RefusedError, match="8 characters"):
            link.put("LONG-NAME.JBI", OLD)
        assert link.files() == []
        link.close()


def test_what_is_not_there_is_told(tmp_path: Path) -> None:
    with hosted("yaskawa", {}) as here:
        link = connect(here.profile(tmp_path))
        for ask in (link.fetch, link.delete):
            with pytest.raises(NotThereError, match="E2B3"):
                ask("NONE.JBI")
        link.close()


FILES = Files("yaskawa", "WORK.JBI", OLD, LONG)


def test_the_line_is_lost_at_each_message(tmp_path: Path) -> None:
    count = requests_of(FILES, connect, tmp_path)
    assert count > 10
    for number in range(1, count + 1):
        for fault in ("drop", "before"):
            endured(FILES, connect, tmp_path, f"{fault}:{number}", patience_s=0.1)


def test_a_question_is_asked_again(tmp_path: Path) -> None:
    with hosted("yaskawa", {"WORK.JBI": LONG}, "drop:4") as here:
        link = connect(here.profile(tmp_path))
        assert link.fetch("WORK.JBI") == LONG
        link.close()
        numbers = [one.text for one in here.cabinet.transcript.requests if one.kind == "read"]
        assert len(numbers) > len(set(numbers)), "the lost one came twice"


EXPECTED = {
    "truncate": LinkError,
    "misread": LinkError,
    "busy": RefusedError,
    "protected": RefusedError,
    "full": RefusedError,
    "names": GarbledError,
    "huge": LostError,
}


@pytest.mark.parametrize("fault", EXPECTED)
def test_each_fault_is_noticed(fault: str, tmp_path: Path) -> None:
    errors = endured(FILES, connect, tmp_path, fault)
    assert errors and isinstance(errors[0], EXPECTED[fault]), errors


@pytest.mark.parametrize("fault", ["garbage", "endless"])
def test_noise_at_each_message_ends_in_time(fault: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(client, "LARGEST_JOB", 32 * 1024)
    monkeypatch.setattr(client, "MOST_FILES", 1000)
    for number in range(1, requests_of(FILES, connect, tmp_path) + 1):
        began = time.monotonic()
        endured(FILES, connect, tmp_path, f"{fault}:{number}", patience_s=0.1)
        assert time.monotonic() - began < 30.0


def test_noise_that_stays_is_an_error(tmp_path: Path) -> None:
    for fault in ("garbage:1+", "endless:1+"):  # the state is asked for first, and has no end either
        assert isinstance(endured(FILES, connect, tmp_path, fault)[0], LostError)


def test_a_slow_controller_is_waited_for(tmp_path: Path) -> None:
    assert endured(FILES, connect, tmp_path, "slow:0.02", patience_s=10.0) == []


def test_the_emergency_stop_shows_by_the_servos(tmp_path: Path) -> None:
    with hosted("yaskawa", {"WORK.JBI": OLD}, "estop:6") as here:
        link = connect(here.profile(tmp_path))
        assert link.state().motors_on
        for _ in range(6):
            link.files()
        assert link.state().motors_on is False
        link.close()
        assert not here.kinds() & MOTION


def test_blocks_out_of_turn_are_refused(tmp_path: Path) -> None:
    with hosted("yaskawa", {}) as here, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as line:
        line.connect(("127.0.0.1", here.endpoints.ports["files"]))
        line.settimeout(20.0)
        request = Request(hses.FILES, hses.WRITE, 1, data=b"A.JBI")
        line.send(request.packed())
        assert answer_of(line.recv(512)).block == 0
        line.send(Request(hses.FILES, hses.WRITE, 1, data=b"x", block=2, acknowledges=True).packed())
        assert answer_of(line.recv(512)).added == 0xE4A1
        line.send(struct.pack("<4s60x", b"NOPE"))
        line.send(Request(hses.FILES, hses.READ, 2, data=b"A.JBI").packed())
        assert answer_of(line.recv(512)).added == 0xE2B3, "noise is not answered, and nothing was written"


def test_nobody_at_the_port(tmp_path: Path) -> None:
    with hosted("yaskawa", {}) as here:
        profile = here.profile(tmp_path, patience_s=0.3)
    began = time.monotonic()
    with pytest.raises(LostError):
        connect(profile)
    assert time.monotonic() - began < 20.0


def test_ftp_gives_the_same_jobs(tmp_path: Path) -> None:
    pytest.importorskip("pyftpdlib", reason="the extra `ftp` is not installed")
    with served("yaskawa", tmp_path, SAMPLES / "calculation", "--port", "ftp=0") as here:
        line = ftplib.FTP()
        line.connect(here.host, here.ports["ftp"], timeout=60)
        line.login("ftp", "robot")
        assert "CALC.JBI" in line.nlst()
        line.storbinary("STOR WORK.JBI", io.BytesIO(OLD))
        with pytest.raises(ftplib.error_perm):
            line.storbinary("STOR BAD.JBI", io.BytesIO(b"hello"))
        link = connect(here.profile(tmp_path))
        assert VENDOR.rules.same("WORK.JBI", OLD, link.fetch("WORK.JBI"))
        link.close()
        line.quit()
