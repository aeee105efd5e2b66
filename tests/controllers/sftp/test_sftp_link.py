"""Files over SFTP: our client against our server, the pinned key, and a server that is hostile or fails."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from rpl.controllers.link import (
    GarbledError,
    LinkError,
    LoginError,
    LostError,
    NotThereError,
    OtherControllerError,
    RefusedError,
    RemoteFile,
)
from rpl.controllers.profile import Profile
from rpl.errors import UsageError
from tests.controllers.hosting import Hosted, hosted

pytest.importorskip("asyncssh", reason="the extra `ssh` is not installed")

from rpl.controllers.sftp.client import SftpLink

FILES = {"pick.script": b"def pick():\n  sleep(1)\nend\n", "cell/place.script": b"def place():\nend\n"}
PATIENCE_S = 20.0


@pytest.fixture
def here() -> Iterator[Hosted]:
    with hosted("ur", FILES) as found:
        yield found


def opened(here: Hosted, folder: Path, **more: object) -> SftpLink:
    return SftpLink(here.profile(folder, **{"patience_s": PATIENCE_S, **more}))


def test_files_come_and_go_byte_for_byte(here: Hosted, tmp_path: Path) -> None:
    link = opened(here, tmp_path)
    large = bytes(range(256)) * 4096 + b"\r\nend"
    assert link.files() == [RemoteFile("cell/place.script", 17), RemoteFile("pick.script", 27)]
    assert {name: link.fetch(name) for name in FILES} == FILES
    link.put("new/deep/large.script", large)
    assert link.fetch("new/deep/large.script") == large
    link.put("pick.new", b"def pick():\nend\n")
    link.rename("pick.new", "pick.script")
    assert here.cabinet.store.kept("pick.script") == b"def pick():\nend\n"
    link.delete("cell/place.script")
    with pytest.raises(NotThereError):
        link.fetch("cell/place.script")
    link.put("empty.script", b"")
    assert link.fetch("empty.script") == b""
    link.close()
    assert not here.kinds() & {"start", "select", "servo"}


def test_no_name_leads_out_of_the_folder(here: Hosted, tmp_path: Path) -> None:
    link = opened(here, tmp_path)
    with pytest.raises(GarbledError):
        link.put("../../etc/passwd", b"")
    link.close()


def test_the_key_is_kept_at_first_and_another_one_is_another_controller(tmp_path: Path) -> None:
    with hosted("ur", FILES) as first:
        opened(first, tmp_path).close()
        opened(first, tmp_path).close()
        ports = dict(first.endpoints.ports)
        known = (tmp_path / ".rpl/known_keys.toml").read_text(encoding="utf-8")
    assert f'"ssh 127.0.0.1:{ports["sftp"]}" = "SHA256:' in known
    with hosted("ur", FILES) as second:
        moved = known.replace(str(ports["sftp"]), str(second.endpoints.ports["sftp"]))
        (tmp_path / ".rpl/known_keys.toml").write_text(moved, encoding="utf-8")
        with pytest.raises(OtherControllerError, match="another controller"):
            opened(second, tmp_path)
        assert not any(told.kind == "login" for told in second.cabinet.transcript.requests)  # no password was sent
        with pytest.raises(OtherControllerError):
            opened(second, tmp_path / "other", options={"host_key": "SHA256:another"})


def test_a_wrong_password_and_a_missing_user_are_told(here: Hosted, tmp_path: Path) -> None:
    with pytest.raises(LoginError):
        opened(here, tmp_path, given_password="guess")
    with pytest.raises(UsageError, match="which user"):
        opened(here, tmp_path, user="")


def asked(profile: Profile) -> LinkError | None:
    """Everything that a link does; the error that ends it."""
    try:
        link = SftpLink(profile)
        try:
            link.files()
            link.fetch("pick.script")
            link.put("pick.new", b"def pick():\nend\n")
            assert link.fetch("pick.new") == b"def pick():\nend\n"
            link.rename("pick.new", "pick.script")
        finally:
            link.close()
    except LinkError as error:
        return error
    return None


@pytest.mark.parametrize(
    ("fault", "kind"),
    [
        ("login", LoginError),
        ("before:1", LostError),
        ("drop:3", LostError),
        ("drop:9", LostError),
        ("before:11", LostError),
        ("busy", RefusedError),
        ("protected", RefusedError),
        ("full", RefusedError),
        ("garbage:2", GarbledError),
        ("garbage:4", GarbledError),
        ("endless:1", GarbledError),
        ("endless:2", (GarbledError, LostError)),
        ("endless:4", (GarbledError, LostError)),
        ("names", GarbledError),
        ("huge", GarbledError),
        ("slow:30", LostError),
    ],
)
def test_every_fault_ends_in_its_error(fault: str, kind: type[LinkError], tmp_path: Path) -> None:
    with hosted("ur", FILES, fault) as here:
        profile = here.profile(tmp_path, 1.0 if fault.startswith(("slow", "endless")) else PATIENCE_S)
        assert isinstance(asked(profile), kind)


def test_what_is_written_half_stays_half(tmp_path: Path) -> None:
    with hosted("ur", FILES, "truncate") as here:
        link = SftpLink(here.profile(tmp_path, PATIENCE_S))
        link.put("pick.new", b"12345678")
        assert link.fetch("pick.new") == b"1234"
        link.close()


def test_a_link_that_is_lost_stays_lost(tmp_path: Path) -> None:
    with hosted("ur", FILES, "before:2") as here:
        link = SftpLink(replace(here.profile(tmp_path), patience_s=PATIENCE_S))
        with pytest.raises(LostError):
            link.files()
        with pytest.raises(LostError, match="given up"):
            link.fetch("pick.script")
        link.close()
