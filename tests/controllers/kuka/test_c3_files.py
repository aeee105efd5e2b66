"""Files of a virtual controller of KUKA by C3 Bridge Interface: messages, own client, faults."""

from __future__ import annotations

import socket
import time
from pathlib import Path

import pytest

from rpl.controllers.kuka import VENDOR, c3
from rpl.controllers.kuka.c3 import Message, Reader, answer, parts_of
from rpl.controllers.kuka.client import GUIDE, KukaLink, connect, folder_of
from rpl.controllers.kuka.server import place_of
from rpl.controllers.kuka.wire import Wire
from rpl.controllers.link import GarbledError, LinkError, LostError, NotThereError, RefusedError
from tests.controllers.enduring import Files, ReadBackError, endured, requests_of
from tests.controllers.hosting import hosted
from tests.controllers.serving import served

SAMPLES = Path(__file__).parents[3] / "samples/krl"
OLD = b"DEF WORK()\r\nWAIT SEC 1.0\r\nEND\r\n"
NEW = b"DEF WORK()\r\n" + b"WAIT SEC 2.0\r\n" * 9000 + b"END\r\n"  # more than one message takes


def test_messages_are_those_of_the_specification() -> None:
    """The samples of sections 3.5.1 and 3.6.1."""
    asked = Message(256, c3.READ_ASCII, c3.narrow(b"$ACCU_STATE")).packed()
    assert asked == bytes.fromhex("0100 000E 00 000B 24 41 43 43 55 5F 53 54 41 54 45")
    told = answer(256, c3.READ_ASCII, c3.narrow(b"#CHARGE_OK"))
    assert told == bytes.fromhex("0100 0010 00 000A 23 43 48 41 52 47 45 5F 4F 4B 0001 01")
    assert Message(652, c3.PROGRAM, bytes((c3.PROGRAM_RESET, 0, 0))).packed() == bytes.fromhex("028C 0004 0A 01 0000")
    assert answer(652, c3.PROGRAM, b"\x01") == bytes.fromhex("028C 0005 0A 01 0001 01")


def test_wide_texts_are_counted_in_characters() -> None:
    assert c3.wide("Ab") == bytes.fromhex("0002 4100 6200")
    assert Reader(c3.wide("Ä€")).wide() == "Ä€"


def test_an_answer_has_its_end() -> None:
    assert parts_of(b"xy\x00\x02\x00") == (b"xy", 2, False)
    with pytest.raises(c3.MessageError):
        parts_of(b"xy")


PLACES = {
    "KRC:\\R1\\Program\\A.SRC": "R1/Program/A.SRC",
    "/R1/A.SRC": "R1/Program/A.SRC",
    "A.SRC": "R1/Program/A.SRC",
    "lib/A.SRC": "R1/Program/lib/A.SRC",
    "KRC/R1/System/$config.dat": "R1/System/$config.dat",
}


@pytest.mark.parametrize("path", PLACES)
def test_paths_of_one_file_mean_one_place(path: str) -> None:
    assert place_of(path) == PLACES[path]


def test_the_folder_is_spelled_as_the_controller_does() -> None:
    assert folder_of("/KRC:/R1/Program") == "KRC:\\R1\\Program"
    assert folder_of("R1/Program") == "KRC:\\R1\\Program"


def test_the_command_serves_files(tmp_path: Path) -> None:
    with served("kuka", tmp_path, SAMPLES / "machine_tending", "--save", tmp_path / "kept") as here:
        link = connect(here.profile(tmp_path))
        names = [one.name for one in link.files() if VENDOR.rules.is_program(one.name)]
        assert names == ["machine_tending.dat", "machine_tending.src"]
        data = link.fetch("MACHINE_TENDING.SRC")
        assert data == (SAMPLES / "machine_tending/machine_tending.src").read_bytes()
        link.put("zzrpl1.src", data)
        link.rename("zzrpl1.src", "other.src")
        link.delete("machine_tending.src")
        assert link.fetch("other.src") == data
        with pytest.raises(NotThereError):
            link.fetch("machine_tending.src")
        with pytest.raises(NotThereError):
            link.delete("machine_tending.src")
        link.close()
        assert here.kinds() == {"connect", "list", "read", "write", "delete"}
        assert "Traceback" not in here.stop()
        assert (tmp_path / "kept/R1/Program/other.src").read_bytes() == data


def test_a_file_that_is_there_is_replaced_only_when_that_is_asked_for(tmp_path: Path) -> None:
    with hosted("kuka", {"A.src": OLD, "B.src": OLD}) as here:
        link = connect(here.profile(tmp_path))
        assert isinstance(link, KukaLink)
        paths = c3.wide("KRC:\\R1\\Program\\A.src") + c3.wide("/R1/B.src")
        with pytest.raises(RefusedError, match="access denied"):
            link.wire.ask(c3.COPY, c3.number(0) + paths)
        link.wire.ask(c3.COPY, c3.number(c3.OVERWRITE) + paths)
        link.wire.ask(c3.SET_ATTRIBUTES, c3.number(1) + c3.number(1) + c3.wide("/R1/B.src"), "B.src")
        with pytest.raises(RefusedError, match="access denied"):
            link.put("B.src", NEW)
        link.wire.ask(c3.SET_ATTRIBUTES, c3.number(0) + c3.number(1) + c3.wide("/R1/B.src"), "B.src")
        link.put("B.src", NEW)
        told = Reader(link.wire.ask(c3.PROPERTIES, c3.number(255) + c3.wide("/R1/B.src"), "B.src"))
        assert [told.number() for _ in range(3)] == [16, len(NEW), 0]
        assert Reader(link.wire.ask(c3.FULL_NAME, c3.wide("/R1/B.src"))).wide() == "KRC:\\R1\\Program\\B.src"
        assert Reader(link.wire.ask(c3.KRC_NAME, c3.wide("KRC:\\R1\\Program\\B.src"))).wide() == "/R1/B.src"
        link.close()


def test_a_type_that_nobody_knows_ends_the_connection(tmp_path: Path) -> None:
    with hosted("kuka", {}) as here:
        wire = Wire("127.0.0.1", here.endpoints.ports["c3"], 10.0)
        with pytest.raises(LostError):
            wire.ask(99, b"")
        wire.close()


FILES = Files("kuka", "WORK.src", OLD, NEW, "zzrpl1.src", "R1/Program/")


def test_the_line_is_lost_at_each_message(tmp_path: Path) -> None:
    count = requests_of(FILES, connect, tmp_path)
    assert count > 20
    for number in range(1, count + 1):
        for fault in ("drop", "before"):
            errors = endured(FILES, connect, tmp_path, f"{fault}:{number}", patience_s=10.0)
            assert errors and isinstance(errors[0], LostError), (fault, number)


EXPECTED = {
    "truncate": ReadBackError,
    "misread": ReadBackError,
    "busy": RefusedError,
    "protected": RefusedError,
    "full": RefusedError,
    "names": GarbledError,
    "huge": GarbledError,
}


@pytest.mark.parametrize("fault", EXPECTED)
def test_each_fault_is_noticed(fault: str, tmp_path: Path) -> None:
    errors = endured(FILES, connect, tmp_path, fault, patience_s=10.0)
    assert errors and isinstance(errors[0], EXPECTED[fault]), errors


@pytest.mark.parametrize("fault", ["garbage", "endless"])
def test_noise_at_each_message_is_an_error_in_time(fault: str, tmp_path: Path) -> None:
    for number in range(1, requests_of(FILES, connect, tmp_path) + 1):
        began = time.monotonic()
        errors = endured(FILES, connect, tmp_path, f"{fault}:{number}", patience_s=0.3)
        assert errors and isinstance(errors[0], LinkError), number
        assert time.monotonic() - began < 30.0


def test_a_slow_controller_is_waited_for(tmp_path: Path) -> None:
    assert endured(FILES, connect, tmp_path, "slow:0.02", patience_s=10.0) == []


def test_the_emergency_stop_is_seen(tmp_path: Path) -> None:
    with hosted("kuka", {"WORK.src": OLD}, "estop:7") as here:
        link = connect(here.profile(tmp_path))
        before = link.state()
        link.fetch("WORK.src")
        after = link.state()
        assert (before.emergency_stop, before.motors_on) == (False, True)
        assert (after.emergency_stop, after.motors_on) == (True, False)
        link.close()


def test_an_answer_that_comes_by_drops_ends_in_time(tmp_path: Path) -> None:
    """A byte now and then would keep a client for ever that waits for each of them anew."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        wire = Wire("127.0.0.1", listening.getsockname()[1], 0.5)
        other, _ = listening.accept()
        other.sendall(bytes.fromhex("0001 ffff 00"))
        began = time.monotonic()
        with pytest.raises(LostError, match="did not answer"):
            wire.ask(c3.READ_ASCII, b"")
        assert time.monotonic() - began < 20.0
        wire.close()
        other.close()


def test_pairs_travel_together_the_data_first() -> None:
    rules = VENDOR.rules
    assert rules.in_order(["B.src", "A.src", "A.dat", "B.dat"]) == ["A.dat", "A.src", "B.dat", "B.src"]


DENIED = ["$machine.dat", "$config.dat", "System/BAS.SRC", "lib/mada/x.dat", "STEU/Mada/$custom.dat", "sps.sub"]


@pytest.mark.parametrize("name", DENIED)
def test_what_is_the_systems_own_is_denied(name: str) -> None:
    assert VENDOR.rules.is_denied(name)
    assert not VENDOR.rules.is_denied("work.src")


def test_a_module_without_data_is_sent_alone_unless_the_controller_has_its_data() -> None:
    rules, alone = VENDOR.rules, frozenset({"work.src"})
    assert list(rules.complaints("work.src", OLD, "cp1252", alone)) == []
    (said,) = rules.complaints("work.src", OLD, "cp1252", alone, frozenset({"work.src", "work.dat"}))
    assert "work.dat must travel with it" in said


def test_a_folder_stands_for_the_share(tmp_path: Path) -> None:
    (tmp_path / "WORK.src").write_bytes(OLD)
    with hosted("kuka", {}) as here:
        link = connect(here.profile(tmp_path, options={"transfer": str(tmp_path)}))
        assert link.fetch("WORK.src") == OLD
        link.put("NEXT.src", OLD)
        link.take_in(["NEXT.src"])
        said = (tmp_path / GUIDE).read_text(encoding="cp1252")
        assert "pendant" in said and "NEXT.src" in said
        assert [one.name for one in link.files()] == ["NEXT.src", "WORK.src"], "what is said to people is no program"
        link.take_out(["NEXT.src"])
        assert not (tmp_path / GUIDE).exists()
        assert here.cabinet.transcript.requests == []
