"""What has to be on the controller beside the modules: signals, as lines of EIO.cfg."""

from __future__ import annotations

from pathlib import Path

from rpl.api import read, translate
from rpl.cli.main import run
from rpl.registry import dialect
from rpl.source import source_from_bytes

DATA = "DEFDAT m\nSIGNAL doGrip $OUT[3]\nSIGNAL diPart $IN[7]\nENDDAT\n"
PROGRAM = "DEF m()\nWAIT FOR diPart\ndoGrip=TRUE\n$OUT[4]=FALSE\nEND\n"


def written(folder: Path, *, program: str = PROGRAM) -> Path:
    """The folder with a KRL module."""
    folder.mkdir()
    (folder / "m.src").write_text(program)
    (folder / "m.dat").write_text(DATA)
    return folder


def test_signals_of_the_program_with_what_the_source_calls_them(tmp_path: Path) -> None:
    (file,) = translate(read(written(tmp_path / "m")), "rapid").setup
    lines = [line.strip() for line in file.data.decode("ascii").splitlines()]
    assert file.path == "EIO.cfg" and lines[:3] == ["EIO:CFG_1.0:6:0::", "#", "EIO_SIGNAL:"]
    assert [line for line in lines[3:] if line] == [
        '-Name "diPart" -SignalType "DI" -Label "digital in 7"',
        '-Name "do4" -SignalType "DO" -Label "digital out 4"',
        '-Name "doGrip" -SignalType "DO" -Label "digital out 3"',
    ]


def test_a_program_without_signals_asks_for_none(tmp_path: Path) -> None:
    assert translate(read(written(tmp_path / "m", program="DEF m()\nWAIT SEC 1\nEND\n")), "rapid").setup == ()


def test_it_stands_beside_the_modules_and_is_what_a_backup_would_say(tmp_path: Path) -> None:
    source, out, again = written(tmp_path / "m"), tmp_path / "out", tmp_path / "again"
    assert run(["translate", str(source), "--to", "rapid", "-o", str(out)]) == 0
    assert {"m.mod", "EIO.cfg", "map.toml"} <= {one.name for one in out.iterdir()}
    assert run(["check", str(out)]) == 0
    file = out / "EIO.cfg"
    assert set(dialect("rapid").standing([source_from_bytes(file.name, file.read_bytes())]).names) == {
        "dipart",
        "dogrip",
        "do4",
    }
    backup = ["--target-backup", str(out)]
    assert run(["translate", str(source), "--to", "rapid", "-o", str(again), *backup]) in (0, 3)
    assert "EIO.cfg" not in {one.name for one in again.iterdir()}
