"""What is damaged, cut off, twice there or too large is an error with its name, never a shorter program."""

import gzip
import io
import os
import stat
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from rpl import archives
from rpl.cli.main import run
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_program

MAIN = b"DEF main()\nWAIT SEC 1\nEND\n"
OTHER = b"DEF other()\nWAIT SEC 2\nEND\n"


def zipped(**stored: bytes) -> bytes:
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w", zipfile.ZIP_STORED) as archive:
        for name, data in stored.items():
            archive.writestr(f"{name}.src", data)
    return held.getvalue()


def tarred(mode: str = "w", *members: tuple[str, bytes]) -> bytes:
    held = io.BytesIO()
    with tarfile.open(fileobj=held, mode=mode) as archive:  # type: ignore[call-overload]
        for name, data in members or (("main.src", MAIN), ("other.src", OTHER)):
            info = tarfile.TarInfo(name)
            info.size = len(data)
            archive.addfile(info, io.BytesIO(data))
    return held.getvalue()


def reports(path: Path) -> tuple[int, list[str], list[str]]:
    """Files read, errors, warnings."""
    diagnostics = Diagnostics()
    read = read_program([path], diagnostics=diagnostics)
    told = {one: [item.as_text() for item in diagnostics.of(one)] for one in (Severity.ERROR, Severity.WARNING)}
    return len(read.files), told[Severity.ERROR], told[Severity.WARNING]


def test_whole_archives_are_read(tmp_path: Path) -> None:
    for name, data in (
        ("b.zip", zipped(main=MAIN, other=OTHER)),
        ("b.tar", tarred()),
        ("b.tar.gz", tarred("w:gz")),
        ("b.tar.bz2", tarred("w:bz2")),
        ("b.tar.xz", tarred("w:xz")),
    ):
        (tmp_path / name).write_bytes(data)
        assert reports(tmp_path / name) == (2, [], [])


def test_a_damaged_member_is_named_and_the_others_are_read(tmp_path: Path) -> None:
    data = zipped(main=MAIN, other=OTHER)
    path = tmp_path / "b.zip"
    path.write_bytes(data.replace(b"WAIT SEC 2", b"WAIT SEC 9", 1))
    files, errors, _ = reports(path)
    assert files == 1
    assert len(errors) == 1 and "b.zip/other.src" in errors[0] and "unreadable-file" in errors[0]


@pytest.mark.parametrize("kind", ["w", "w:gz", "w:bz2", "w:xz"])
def test_a_cut_end_of_a_tar_is_an_error_wherever_it_is_cut(tmp_path: Path, kind: str) -> None:
    whole = tarred(kind)
    path = tmp_path / "b.tar"
    content = 4 * 512  # headers and contents of both members; behind them is nothing but zeros
    ends = [512, 700, 1024, 1100, 1536, 1600, content] if kind == "w" else range(20, len(whole) - 10, 7)
    for end in ends:
        path.write_bytes(whole[:end])
        assert reports(path)[1], end


def test_a_cut_end_of_a_zip_is_an_error_wherever_it_is_cut(tmp_path: Path) -> None:
    whole = zipped(main=MAIN, other=OTHER)
    path = tmp_path / "b.zip"
    for end in range(0, len(whole), 11):
        path.write_bytes(whole[:end])
        assert reports(path)[1], end


def test_damage_anywhere_in_an_archive_never_ends_in_another_exception(tmp_path: Path) -> None:
    path = tmp_path / "b.zip"
    for whole in (zipped(main=MAIN, other=OTHER), tarred(), tarred("w:gz"), tarred("w:xz"), tarred("w:bz2")):
        for at in range(0, min(len(whole), 2200), 13):
            path.write_bytes(whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1 :])
            reports(path)


def test_two_members_of_one_name_are_an_error(tmp_path: Path) -> None:
    path = tmp_path / "b.tar"
    path.write_bytes(tarred("w", ("main.src", MAIN), ("main.src", OTHER)))
    _, errors, _ = reports(path)
    assert any("b.tar/main.src" in each and "two files of this name" in each for each in errors)


def test_members_and_archives_beyond_the_limits_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(archives, "LARGEST_MEMBER", 30)
    path = tmp_path / "b.zip"
    path.write_bytes(zipped(main=MAIN, other=OTHER + b";" * 100))
    files, errors, _ = reports(path)
    assert files == 1 and len(errors) == 1 and "b.zip/other.src" in errors[0] and "larger than" in errors[0]
    monkeypatch.setattr(archives, "MOST_MEMBERS", 1)
    path.write_bytes(zipped(main=MAIN, other=b"x"))
    assert any("more than 1 files" in each for each in reports(path)[1])


@pytest.mark.parametrize(
    ("kind", "leads_to", "reason"),
    [
        (tarfile.SYMTYPE, "/etc/passwd", "a link to what is not in the archive"),
        (tarfile.SYMTYPE, "other.src", "damaged"),  # to itself
        (tarfile.LNKTYPE, "missing.src", "a link to what is not in the archive"),
        (tarfile.FIFOTYPE, "", "a link, a pipe or a device"),
        (tarfile.CHRTYPE, "", "a link, a pipe or a device"),
    ],
)
def test_members_that_are_no_files_are_named(tmp_path: Path, kind: bytes, leads_to: str, reason: str) -> None:
    held = io.BytesIO()
    with tarfile.open(fileobj=held, mode="w") as archive:
        info = tarfile.TarInfo("main.src")
        info.size = len(MAIN)
        archive.addfile(info, io.BytesIO(MAIN))
        other = tarfile.TarInfo("other.src")
        other.type, other.linkname = kind, leads_to
        archive.addfile(other)
    path = tmp_path / "b.tar"
    path.write_bytes(held.getvalue())
    files, errors, _ = reports(path)
    assert files == 1 and len(errors) == 1
    assert "b.tar/other.src" in errors[0] and reason in errors[0]


def test_a_link_to_another_member_is_that_member(tmp_path: Path) -> None:
    held = io.BytesIO()
    with tarfile.open(fileobj=held, mode="w") as archive:
        info = tarfile.TarInfo("kept/main.src")
        info.size = len(MAIN)
        archive.addfile(info, io.BytesIO(MAIN))
        link = tarfile.TarInfo("main.src")
        link.type, link.linkname = tarfile.LNKTYPE, "kept/main.src"
        archive.addfile(link)
    path = tmp_path / "b.tar"
    path.write_bytes(held.getvalue())
    assert reports(path)[0] == 2


def test_a_link_in_a_zip_archive_is_named(tmp_path: Path) -> None:
    link = zipfile.ZipInfo("other.src")
    link.create_system, link.external_attr = 3, (stat.S_IFLNK | 0o777) << 16
    path = tmp_path / "b.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("main.src", MAIN)
        archive.writestr(link, "/etc/passwd")
    files, errors, _ = reports(path)
    assert files == 1 and len(errors) == 1
    assert "b.zip/other.src" in errors[0] and "a link, a pipe or a device" in errors[0]


def test_an_archive_in_an_archive_is_named(tmp_path: Path) -> None:
    path = tmp_path / "b.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("main.src", MAIN)
        archive.writestr("inner.zip", zipped(other=OTHER))
    files, errors, warnings = reports(path)
    assert (files, errors) == (1, [])
    assert any("b.zip/inner.zip" in each and "an archive in an archive" in each for each in warnings)


@pytest.mark.parametrize("kind", ["zip", "gz", "bz2", "xz", "many"])
def test_decompression_bombs_end_at_a_limit(tmp_path: Path, kind: str) -> None:
    held, path = io.BytesIO(), tmp_path / ("b.zip" if kind in ("zip", "many") else f"b.tar.{kind}")
    zeros = bytes(2**20)
    if kind == "zip":
        with zipfile.ZipFile(held, "w", zipfile.ZIP_DEFLATED) as archive:
            for number in range(8):
                archive.writestr(f"z{number}.src", zeros * 60)
    elif kind == "many":
        with zipfile.ZipFile(held, "w") as archive:
            for number in range(archives.MOST_MEMBERS + 5):
                archive.writestr(f"{number}.bin", b"")
    else:
        with tarfile.open(fileobj=held, mode=f"w:{kind}") as tar:  # type: ignore[call-overload]
            info = tarfile.TarInfo("z.src")
            info.size = 300 * 2**20
            tar.addfile(info, io.BufferedReader(io.BytesIO(zeros * 300)))
    path.write_bytes(held.getvalue())
    assert any("more than" in each or "larger than" in each for each in reports(path)[1])


def test_a_packed_file_that_is_cut_is_an_error(tmp_path: Path) -> None:
    whole = gzip.compress(MAIN * 50)
    (tmp_path / "a.src").write_bytes(whole[:-9])
    assert any("its end is missing" in each for each in reports(tmp_path)[1])


def test_files_of_a_folder_that_hold_no_program_are_named(tmp_path: Path) -> None:
    (tmp_path / "main.src").write_bytes(MAIN)
    (tmp_path / "empty.src").write_bytes(b"")
    (tmp_path / "nuls.src").write_bytes(OTHER[:12] + bytes(20) + OTHER[12:])
    (tmp_path / "wide.src").write_bytes(OTHER.decode().encode("utf-16-le"))
    (tmp_path / "cut.src").write_bytes(b"\xff\xfe" + OTHER.decode().encode("utf-16-le")[:-1])
    (tmp_path / "marked.src").write_bytes(OTHER.decode().encode("utf-16"))
    files, errors, warnings = reports(tmp_path)
    assert (files, errors) == (2, [])
    for name, word in (("empty", "empty"), ("nuls", "zero bytes"), ("wide", "UTF-16"), ("cut", "UTF-16")):
        assert any(f"{name}.src" in each and word in each for each in warnings), name


@pytest.mark.parametrize("language", ["krl", "rapid", "urscript", "vplus", "rpl", "tp", "inform"])
@pytest.mark.parametrize("data", [MAIN + b"\0", MAIN[:12] + b"\0" + MAIN[12:], MAIN.decode().encode("utf-16-be")])
def test_zero_bytes_are_an_error_whatever_the_language_is_said_to_be(
    tmp_path: Path, language: str, data: bytes
) -> None:
    path = tmp_path / "main.src"
    path.write_bytes(data)
    diagnostics = Diagnostics()
    read_program([path], language, diagnostics)
    assert [item.code.name for item in diagnostics] == ["zero-bytes"]


def test_zero_bytes_far_behind_the_beginning_are_named(tmp_path: Path) -> None:
    text = b"DEF main()\n" + b"; remark\n" * 9000
    (tmp_path / "main.src").write_bytes(text + b"HALT\0\nEND\n")
    files, errors, warnings = reports(tmp_path)
    assert files == 0 and any("zero bytes, the first one in line 9002" in each for each in errors + warnings)


@pytest.mark.parametrize(
    "arguments",
    [
        ["translate", "main.src", "--to", "tp", "--map"],
        ["prove", "--check"],
        ["fk", "--robot", "ur5e", "--points"],
        ["fk", "--joints", "0,0,0,0,0,0", "--robot"],
        ["fit", "--robot", "ur5e"],
        ["run", "main.src", "--cell"],
        ["run", "main.src", "--controller"],
    ],
)
def test_no_command_waits_for_a_pipe_or_reads_a_device(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("main.src").write_bytes(MAIN)
    for name in ("x.toml", "x.urdf"):
        os.mkfifo(name)
        command = [sys.executable, "-m", "rpl.cli.main", *arguments, name]
        made = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
        assert made.returncode == 2
        assert "pipe or a device" in made.stderr or "no controller" in made.stderr


LONG_CELL = "x" * 200_000
TO_TP = ["translate", "main.src", "--to", "tp", "--map"]
JOINTS = "j1,j2,j3,j4,j5,j6\n"


@pytest.mark.parametrize(
    ("arguments", "text", "complaint"),
    [
        (["fk", "--robot", "ur5e", "--points"], f"j1,j2,j3,j4,j5,j6,n\n0,0,0,0,0,0,{LONG_CELL}\n", "x.csv:2: field"),
        (["fit", "--robot", "ur5e"], f"time,j1,j2,j3,j4,j5,j6,n\n0,0,0,0,0,0,0,{LONG_CELL}\n", "x.csv:2: field"),
        (TO_TP, f'target = "tp"\n[numbers.R]\n{"9" * 5000} = "a"\n', "x.csv:3: 999"),
        (TO_TP, 'target = "tp"\n[numbers.R]\n"\u00b2" = "a"\n', "x.csv:3: \u00b2: a line"),
        (TO_TP, b'target = "tp"\n\xff\n', "no text in UTF-8"),
        (["fk", "--robot", "ur5e", "--points"], f"{JOINTS}0,0,0,0,0,{'9' * 400}\n", "a number is needed"),
        (["fk", "--robot", "ur5e", "--points"], JOINTS + "0,0,0,0,0,1e300\n", "beyond 1,000,000, a number is needed"),
    ],
)
def test_tables_with_cells_that_nobody_writes_are_refused(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    text: str | bytes,
    complaint: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("main.src").write_bytes(MAIN)
    Path("x.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    assert run([*arguments, "x.csv"]) in (1, 2)
    told = capsys.readouterr().err
    assert complaint in told and len(told) < 500


def test_pipes_and_devices_are_refused_and_never_waited_for(tmp_path: Path) -> None:
    pipe = tmp_path / "main.src"
    os.mkfifo(pipe)
    for path in (pipe, tmp_path, Path("/dev/zero")):
        _, errors, _ = reports(path)
        assert any("pipe or a device" in each for each in errors)
