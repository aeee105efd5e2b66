"""Programs of a virtual FANUC controller by FTP: our client, and the standard library's."""

from __future__ import annotations

import ftplib
import io
from collections.abc import Iterator
from pathlib import Path

import pytest

from rpl.controllers.fanuc.client import connect, status
from rpl.controllers.fanuc.listing import same_program
from rpl.controllers.link import NotThereError, RefusedError
from tests.controllers.serving import Served, served

pytest.importorskip("pyftpdlib", reason="the virtual controller needs pyftpdlib")

SAMPLES = Path(__file__).resolve().parents[3] / "samples/tp"
PICK = (SAMPLES / "palletiser/pick.ls").read_bytes()


@pytest.fixture(scope="module")
def fanuc(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    folder = tmp_path_factory.mktemp("fanuc")
    with served("fanuc", folder, SAMPLES / "palletiser", "--robot", "fanuc_lrmate200id") as one:
        yield one


def test_programs_are_listed_in_capitals_and_given_back_as_they_are(fanuc: Served, tmp_path: Path) -> None:
    link = connect(fanuc.profile(tmp_path))
    names = [one.name for one in link.files()]
    assert {"PALLETISER.LS", "PLACE.LS", "SYSFRAME.VA", "PRGSTATE.DG"} <= set(names)
    assert link.fetch("place.ls") == (SAMPLES / "palletiser/place.ls").read_bytes().replace(b"\n", b"\r\n")
    assert "ERRALL.LS" not in names
    link.close()


def test_what_is_loaded_is_written_anew_and_still_the_same_program(fanuc: Served, tmp_path: Path) -> None:
    link = connect(fanuc.profile(tmp_path))
    link.put("AGAIN.LS", PICK)
    found = link.fetch("AGAIN.LS")
    assert found != PICK
    assert b"\r\n" in found
    assert same_program("AGAIN.LS", PICK, found)
    assert not same_program("AGAIN.LS", PICK.replace(b"300mm", b"301mm"), found)
    link.delete("AGAIN.LS")
    with pytest.raises(NotThereError):
        link.fetch("AGAIN.LS")
    link.close()


@pytest.mark.parametrize(
    ("good", "bad"), [(b"UFRAME_NUM=0", b"R[1]=)"), (b"UFRAME_NUM=0", b"R[1]=R[1]*10+R[2]"), (b"/PROG", b"/PROC")]
)
def test_the_loader_says_where_it_stops_and_nothing_changes(
    fanuc: Served, tmp_path: Path, good: bytes, bad: bytes
) -> None:
    link = connect(fanuc.profile(tmp_path))
    before = link.fetch("PICK.LS")
    with pytest.raises(RefusedError, match=r"ASBN-009 on line \d+, column \d+; ASBN-\d+"):
        link.put("PICK.LS", PICK.replace(good, bad))
    assert link.fetch("PICK.LS") == before
    assert b"ASBN-009 on line" in link.fetch("ERRALL.LS")
    link.close()


def test_a_protected_program_is_refused(fanuc: Served, tmp_path: Path) -> None:
    link = connect(fanuc.profile(tmp_path))
    link.put("SHUT.LS", PICK.replace(b"READ_WRITE", b"READ"))
    with pytest.raises(RefusedError, match="protected"):
        link.put("SHUT.LS", PICK)
    link.close()


def test_it_says_who_it_is_and_that_it_stands(fanuc: Served, tmp_path: Path) -> None:
    profile = fanuc.profile(tmp_path)
    link = connect(profile)
    assert link.identity().said() == {
        "maker": "FANUC",
        "serial": "F20260001",
        "firmware": "V9.40P/01",
        "name": "HandlingTool",
    }
    state = link.state()
    assert (state.running, state.emergency_stop, state.selected) == (False, False, ())
    seen = status(profile)
    assert seen.joints is not None
    assert len(seen.joints) == 6
    assert seen.xyz_mm is not None
    link.close()


def test_the_standard_client_is_served_with_devices_and_both_slashes(fanuc: Served) -> None:
    client = ftplib.FTP()
    client.connect(fanuc.host, fanuc.ports["ftp"], timeout=30)
    client.login()
    client.cwd("MD:")
    assert "PICK.LS" in client.nlst()
    client.storbinary("STOR md:\\FROMPC.LS", io.BytesIO(PICK))
    pieces: list[bytes] = []
    client.retrbinary("RETR MD:FROMPC.LS", pieces.append)
    assert same_program("FROMPC.LS", PICK, b"".join(pieces))
    client.delete("FROMPC.TP")
    with pytest.raises(ftplib.error_perm, match="550"):
        client.cwd("XX:")
    with pytest.raises(ftplib.error_perm, match="502"):
        client.sendcmd("RNFR PICK.LS")
    client.quit()


def test_nothing_that_was_asked_moves_the_robot(fanuc: Served, tmp_path: Path) -> None:
    link = connect(fanuc.profile(tmp_path))
    link.put("LAST.LS", PICK)
    link.close()
    assert fanuc.kinds() <= {"connect", "login", "look", "list", "read", "write", "delete", "other"}
