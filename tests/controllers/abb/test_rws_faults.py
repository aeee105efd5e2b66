"""What the client makes of a controller that misbehaves: an error that says what is known, within its time, and the
controller holds what it held or what it was given."""

import socket
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from rpl.controllers.link import GarbledError, LinkError, LoginError, LostError, RefusedError
from rpl.controllers.profile import Profile
from rpl.controllers.vendors import vendor
from rpl.controllers.virtual.faults import fault_of
from tests.controllers.hosting import Hosted, hosted

pytest.importorskip("aiohttp", reason="the extra `rws` is not installed")
pytest.importorskip("cryptography", reason="the extra `rws` is not installed")

NEW = b"MODULE extra\r\n  PROC further()\r\n  ENDPROC\r\nENDMODULE\r\n"


SAMPLE = Path(__file__).parents[3] / "samples/rapid/project"
FILES = {path.name: path.read_bytes() for path in sorted(SAMPLE.iterdir())}
NEVER = "misread:1000000"


def misbehave(here: Hosted, fault: str) -> None:
    """From now on, counted from here."""
    here.cabinet.faults = here.cabinet.store.faults = fault_of(fault)


def connected(here: Hosted, folder: Path, generation: str = "1", **more: Any) -> Any:
    from rpl.controllers.abb.client import connect

    who = {"user": "Default User", "given_password": "robot"} | more
    return connect(here.profile(folder, options={"generation": generation}, **who))


@pytest.fixture(scope="module")
def here() -> Iterator[Hosted]:
    with hosted("abb", FILES) as found:
        yield found


ACTS: dict[str, Callable[[Any], object]] = {
    "list": lambda link: link.files(),
    "fetch": lambda link: link.fetch("main.mod"),
    "put": lambda link: link.put("extra.mod", NEW),
    "delete": lambda link: link.delete("tools.sys"),
    "lock": lambda link: link.lock(),
    "take in": lambda link: link.take_in(["main.mod"]),
}


@pytest.mark.parametrize("generation", ["1", "2"])
@pytest.mark.parametrize("act", list(ACTS))
@pytest.mark.parametrize(
    ("fault", "error"),
    [("drop", LostError), ("before", LostError), ("garbage", GarbledError), ("endless", GarbledError)],
)
def test_a_lost_or_senseless_answer_is_an_error(
    here: Hosted, tmp_path: Path, fault: str, error: type[LinkError], act: str, generation: str
) -> None:
    link = connected(here, tmp_path, generation)
    try:
        misbehave(here, fault)
        with pytest.raises(error):
            ACTS[act](link)
        if act == "put":
            assert ("extra.mod" in here.cabinet.store) == (fault == "drop")  # others are answered before they are read
    finally:
        misbehave(here, NEVER)  # never
        here.cabinet.store.put([("tools.sys", FILES["tools.sys"])])
        if "extra.mod" in here.cabinet.store:
            here.cabinet.store.delete("extra.mod")
        link.unlock() if act == "lock" and fault == "drop" else None
        link.close()


@pytest.mark.parametrize("fault", ["protected", "full"])
def test_a_refused_write_changes_nothing(here: Hosted, tmp_path: Path, fault: str) -> None:
    link = connected(here, tmp_path)
    misbehave(here, fault)
    with pytest.raises(RefusedError):
        link.put("main.mod", NEW)
    assert here.cabinet.store.kept("main.mod") == FILES["main.mod"]
    link.close()


def test_half_a_write_and_a_wrong_read_are_seen_by_reading_back(here: Hosted, tmp_path: Path) -> None:
    link = connected(here, tmp_path)
    misbehave(here, "truncate")
    link.put("extra.mod", NEW)
    assert link.fetch("extra.mod") == NEW[: len(NEW) // 2]
    misbehave(here, "misread")
    link.put("extra.mod", NEW)
    assert link.fetch("extra.mod") != NEW
    assert link.fetch("extra.mod") == NEW
    link.delete("extra.mod")
    link.close()


def test_a_running_program_keeps_modules_out(tmp_path: Path) -> None:
    with hosted("abb", FILES, "busy") as here:
        link = connected(here, tmp_path)
        assert link.state().running is True
        link.lock()
        with pytest.raises(RefusedError, match="PGM state"):
            link.take_in(["main.mod"])
        link.unlock()
        link.close()


@pytest.mark.parametrize("generation", ["1", "2"])
def test_a_refused_login_is_said(tmp_path: Path, generation: str) -> None:
    with hosted("abb", FILES, "login") as here:
        with pytest.raises(LoginError):
            connected(here, tmp_path, generation)
        connected(here, tmp_path, generation).close()


def test_an_emergency_stop_is_seen(here: Hosted, tmp_path: Path) -> None:
    link = connected(here, tmp_path)
    misbehave(here, "estop")
    link.put("extra.mod", NEW)
    assert (link.state().emergency_stop, link.state().motors_on) == (True, False)
    here.cabinet.release_emergency_stop()
    here.cabinet.motors_on = True
    link.delete("extra.mod")
    link.close()


def test_slow_answers_are_waited_for_and_too_slow_ones_are_not(here: Hosted, tmp_path: Path) -> None:
    link = connected(here, tmp_path)
    misbehave(here, "slow:0.05")
    assert len(link.files()) == 4
    link.close()
    misbehave(here, NEVER)
    link = connected(here, tmp_path, patience_s=0.5)
    misbehave(here, "slow:2")
    began = time.monotonic()
    with pytest.raises(LostError, match="in time"):
        link.files()
    assert time.monotonic() - began < 10.0
    misbehave(here, NEVER)
    link.close()


def test_names_that_lead_elsewhere_and_sizes_that_no_file_has(here: Hosted, tmp_path: Path) -> None:
    link = connected(here, tmp_path)
    misbehave(here, "names")
    with pytest.raises(GarbledError, match="evil"):
        link.files()
    with pytest.raises(GarbledError):
        link.put("../evil.mod", NEW)
    misbehave(here, "huge")
    with pytest.raises(GarbledError, match="too much"):
        link.fetch("main.mod")
    misbehave(here, NEVER)
    link.close()


@pytest.mark.parametrize(
    ("head", "drip", "error"),
    [
        (b"HTTP/1.1 200 OK\r\n", b"A: b\r\n", (LostError, GarbledError)),
        (b"HTTP/1.1 200 OK\r\nContent-Length: 100000\r\n\r\n", b" ", (LostError,)),
        (b"HTTP/1.1 200 OK\r\n\r\n", b" ", (LostError,)),
        (b"", b"HTTP/1.1 100 Continue\r\n\r\n", (LostError,)),
        (b"HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\n[]", b"", (GarbledError,)),
        (b'HTTP/1.1 200 OK\r\nContent-Length: 14\r\n\r\n{"state": "x"}', b"", (GarbledError,)),
        (b"HTTP/1.1 200 OK\r\nContent-Length: 9000\r\n\r\n" + b"[" * 9000, b"", (GarbledError,)),
    ],
)
def test_a_server_that_never_comes_to_an_end(
    tmp_path: Path, head: bytes, drip: bytes, error: tuple[type[LinkError], ...]
) -> None:
    over = threading.Event()

    def answers(listener: socket.socket) -> None:
        connection, _ = listener.accept()
        with connection:
            connection.recv(4096)
            try:
                connection.sendall(head)
                while drip and not over.wait(0.02):
                    connection.sendall(drip)
            except OSError:
                return

    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = threading.Thread(target=answers, args=(listener,), daemon=True)
        thread.start()

        made = vendor("abb")
        profile = Profile(
            "here",
            "abb",
            made.rules,
            made.ports,
            made.path,
            host="127.0.0.1",
            port=listener.getsockname()[1],
            patience_s=0.5,
            state_folder=tmp_path,
            given_password="robot",
        )
        began = time.monotonic()
        with pytest.raises(error):
            vendor("abb").connect(profile).files()
        assert time.monotonic() - began < 5.0
        over.set()
        thread.join(10.0)
