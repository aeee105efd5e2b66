"""The plain way by FTP: our client against our server, pyftpdlib's own server, and servers that mean no good."""

from __future__ import annotations

import ftplib
import io
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from rpl.controllers.ftp.client import FtpLink, connect
from rpl.controllers.link import GarbledError, LinkError, LoginError, LostError, NotThereError, RefusedError
from rpl.controllers.profile import Profile
from rpl.controllers.vendors import vendor
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints
from rpl.controllers.virtual.faults import fault_of
from rpl.controllers.virtual.store import Store

HOST = "127.0.0.1"
FILES = {"PICK.V2": b"program one\r\n", "sub/deep/PLACE.V2": b"two\r\n" * 20_000, "empty.v2": b""}
# No client hangs longer (s), however busy the machine is.
LONGEST_S = 60.0


def profile_of(port: int, folder: Path, patience_s: float = 10.0, password: str = "robot") -> Profile:
    made = vendor("ftp")
    return Profile(
        "here",
        "ftp",
        made.rules,
        made.ports,
        host=HOST,
        port=port,
        user="robot",
        given_password=password,
        patience_s=patience_s,
        state_folder=folder,
    )


@contextmanager
def opened(fault: str = "") -> Iterator[tuple[Cabinet, int]]:
    """Our server over some files, with a fault."""
    pytest.importorskip("pyftpdlib", reason="the server needs pyftpdlib")
    from rpl.controllers.ftp.server import StoreShelf, serve_files

    faults = fault_of(fault)
    cabinet = Cabinet("ftp", "vplus", None, Store(faults), faults)
    cabinet.store.may_write = cabinet.may_write
    cabinet.store.put(FILES.items())
    endpoints = Endpoints(HOST, any_port=True)
    serve_files(cabinet, endpoints, StoreShelf(cabinet))
    try:
        yield cabinet, endpoints.ports["ftp"]
    finally:
        for close in endpoints._closing:
            close()


@contextmanager
def linked(fault: str = "", patience_s: float = 10.0, folder: Path = Path()) -> Iterator[tuple[FtpLink, Cabinet]]:
    with opened(fault) as (cabinet, port):
        link = connect(profile_of(port, folder, patience_s))
        try:
            yield link, cabinet
        finally:
            link.close()


def test_files_of_folders_are_listed_with_sizes_and_carried_as_they_are() -> None:
    with linked() as (link, cabinet):
        assert {one.name: one.size for one in link.files()} == {name: len(data) for name, data in FILES.items()}
        assert {name: link.fetch(name) for name in FILES} == FILES
        link.put("new/place/X.V2", bytes(range(256)) * 300)
        assert link.fetch("new/place/X.V2") == bytes(range(256)) * 300
        link.rename("new/place/X.V2", "PICK.V2")
        assert cabinet.store.kept("PICK.V2") == bytes(range(256)) * 300
        link.delete("PICK.V2")
        for missing in (link.fetch, link.delete):
            with pytest.raises(NotThereError):
                missing("PICK.V2")
        with pytest.raises(GarbledError):
            link.fetch("../etc/passwd")
        assert {one.kind for one in cabinet.transcript.requests} <= {
            *("connect", "login", "look", "list", "read", "write", "delete", "other")
        }


def test_a_wrong_password_is_told() -> None:
    with opened() as (_, port), pytest.raises(LoginError):
        connect(profile_of(port, Path(), password="wrong")).close()


@pytest.mark.parametrize(
    ("fault", "error"),
    [("protected", "Permission denied"), ("full", "No space"), ("busy", "busy")],
)
def test_what_the_controller_refuses_changes_nothing(fault: str, error: str) -> None:
    with linked(fault) as (link, cabinet):
        with pytest.raises(RefusedError, match=error):
            link.put("PICK.V2", b"other")
        assert cabinet.store.kept("PICK.V2") == FILES["PICK.V2"]


def _fetches(link: FtpLink) -> None:
    link.files()
    link.fetch("sub/deep/PLACE.V2")


def _writes(link: FtpLink) -> None:
    link.put("PICK.V2", b"other")
    link.rename("PICK.V2", "NEXT.V2")


@pytest.mark.parametrize("work", [_fetches, _writes], ids=["fetch", "write"])
@pytest.mark.parametrize("fault", ["drop", "before", "endless", "garbage"])
def test_every_request_may_fail_and_the_client_says_so_in_time(fault: str, work: Callable[[FtpLink], None]) -> None:
    with opened() as (cabinet, port):
        link = connect(profile_of(port, Path()))
        work(link)
        link.close()
        requests = cabinet.requests
    for number in range(1, requests + 1):
        began = time.monotonic()
        with opened(f"{fault}:{number}") as (_, port), pytest.raises(LinkError):
            link = connect(profile_of(port, Path(), 0.4))
            try:
                work(link)
            finally:
                link.close()
        assert time.monotonic() - began < LONGEST_S


@pytest.mark.parametrize("fault", ["names", "huge"])
def test_names_that_lead_elsewhere_and_sizes_that_none_has_are_told(fault: str) -> None:
    with linked(fault) as (link, _), pytest.raises(GarbledError):
        _fetches(link)


def test_a_slow_controller_is_waited_for_as_long_as_patience_lasts() -> None:
    with linked("slow:0.02") as (link, _):
        assert link.fetch("PICK.V2") == FILES["PICK.V2"]
    with opened("slow:3") as (_, port), pytest.raises(LostError):
        connect(profile_of(port, Path(), 0.3))


def test_half_a_write_and_a_wrong_read_are_seen_by_reading_back() -> None:
    for fault in ("truncate", "misread"):
        with linked(fault) as (link, _):
            link.put("PICK.V2", b"another program")
            assert link.fetch("PICK.V2") != b"another program"


def test_the_standard_client_is_served() -> None:
    with opened() as (_, port):
        client = ftplib.FTP()
        client.connect(HOST, port, timeout=30)
        client.login("robot", "robot")
        assert client.nlst() == ["PICK.V2", "empty.v2", "sub"]
        client.cwd("sub/deep")
        assert client.pwd() == "/sub/deep"
        client.voidcmd("TYPE I")
        assert client.size("PLACE.V2") == len(FILES["sub/deep/PLACE.V2"])
        lines: list[str] = []
        client.dir(lines.append)
        assert lines[0].endswith("PLACE.V2")
        client.storbinary("STOR ../NEXT.V2", io.BytesIO(b"next"))
        client.rename("../NEXT.V2", "/LAST.V2")
        assert [name for name, _ in client.mlsd("/")] == ["LAST.V2", "PICK.V2", "empty.v2", "sub"]
        client.quit()


@contextmanager
def saying(*said: bytes) -> Iterator[int]:
    """A server that says these, one after the other, whatever it is asked, then the last one for ever."""
    listener = socket.create_server((HOST, 0))
    over = threading.Event()

    def run() -> None:
        try:
            peer, _ = listener.accept()
        except OSError:
            return
        with peer:
            peer.settimeout(0.05)
            queue = list(said)
            while not over.is_set():
                try:
                    peer.sendall(queue.pop(0) if len(queue) > 1 else queue[0])
                    peer.recv(4096)
                except TimeoutError:
                    continue
                except OSError:
                    return

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        yield listener.getsockname()[1]
    finally:
        over.set()
        listener.close()
        thread.join(timeout=10.0)


HOSTILE = {
    "a greeting without end": (b"220-hello\r\n" * 100,),
    "a line without end": (b"220 " + b"x" * 3000,),
    "single bytes": (b"2",),
    "no FTP at all": (b"HTTP/1.1 400 Bad Request\r\n\r\n",),
    "silence": (b"",),
    "noise": (bytes(range(128, 256)) * 10 + b"\r\n",),
    "another host for the data": (
        *(b"220 a\r\n", b"331 b\r\n", b"230 c\r\n", b"200 d\r\n", b"211-x\r\n211 y\r\n"),
        b"227 Entering Passive Mode (999,1,1,1,1,1)\r\n",
    ),
}


@pytest.mark.parametrize("said", HOSTILE.values(), ids=HOSTILE)
def test_a_hostile_server_ends_in_an_error_in_time(said: tuple[bytes, ...], tmp_path: Path) -> None:
    began = time.monotonic()
    with saying(*said) as port, pytest.raises(LinkError):
        link = connect(profile_of(port, tmp_path, 0.5))
        link.files()
    assert time.monotonic() - began < LONGEST_S


def test_a_port_where_nobody_listens_is_told(tmp_path: Path) -> None:
    with socket.create_server((HOST, 0)) as listener:
        port = listener.getsockname()[1]
    with pytest.raises(LostError):
        connect(profile_of(port, tmp_path))
