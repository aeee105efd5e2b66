"""`rpl translate --keep-taught`: what was touched up on the floor stays when the program is translated anew."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from rpl.cli.main import run

SAMPLE = Path(__file__).parents[2] / "samples" / "krl" / "palletiser"
# The file of a target that holds the taught place XPick, and how 430 mm stands in it there; how 440 of XAbovePick does.
PLACES = {
    "rapid": ("Palletiser.mod", "[[430,220,180]", "[[431.5,220,180]", "[[440,220,330]"),
    "krl": ("Palletiser.dat", PICK := "XPick={X 430.0,Y 220.0,Z 180.0", PICK.replace("430.0", "431.5"),
            "XAbovePick={X 440.0,Y 220.0,Z 330.0"),
    "vplus": ("palletiser.v2", "xpick 430 220 180", "xpick 431.5 220 180", "xabovepick 440 220 330"),
    "urscript": ("Palletiser.script", WAY := "XPick = p[0.43, 0.22, 0.18", WAY.replace("0.43", "0.4315"),
                 "p[0.44, 0.22, 0.33"),
    "tp": ("PICK.LS", P := "X =   430.000  mm,\tY =   220.000  mm,\tZ =   180.000", P.replace("430.0", "431.5"),
           "X =   440.000  mm,\tY =   220.000  mm,\tZ =   330.000"),
}  # fmt: skip


def translate(source: Path, target: str, folder: Path, *more: str) -> int:
    arguments = [str(source), "--to", target, "--robot", "kuka_kr6r900sixx", "-o", str(folder), "--keep-taught", *more]
    return run(["translate", *arguments])


def edited(path: Path, old: str, new: str) -> None:
    text = path.read_bytes().decode("latin-1")
    assert text.count(old) == 1
    path.write_bytes(text.replace(old, new).encode("latin-1"))


@pytest.fixture
def source(tmp_path: Path) -> Path:
    return Path(shutil.copytree(SAMPLE, tmp_path / "palletiser"))


@pytest.mark.parametrize("target", PLACES)
def test_a_point_of_the_floor_stays_and_one_of_the_source_comes(
    target: str, source: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    name, before, touched, moved = PLACES[target]
    out = tmp_path / "out"
    assert translate(source, target, out) == 0
    original = (out / name).read_bytes()
    edited(out / name, before, touched)
    edited(source / "palletiser.dat", "XAbovePick={X 430.0", "XAbovePick={X 440.0")
    for _ in range(2):  # what was kept once is kept again
        capsys.readouterr()
        assert translate(source, target, out) == 0
        told = capsys.readouterr()
        text = (out / name).read_bytes().decode("latin-1")
        assert touched in text
        assert moved in text
        assert "1.5 mm" in told.err + told.out
    changed = len(set(original.decode("latin-1").splitlines()) ^ set(text.splitlines()))
    assert changed <= 10  # two points, and what is worked out from them
    assert touched in (out / ".rpl-before" / name).read_text("latin-1")


def test_a_value_that_both_have_changed_is_a_warning_and_the_floors_stays(
    source: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    name, before, touched, _ = PLACES["rapid"]
    out = tmp_path / "out"
    translate(source, "rapid", out)
    edited(out / name, before, touched)
    edited(source / "palletiser.dat", "XPick={X 430.0,Y 220.0,Z 180.0", "XPick={X 430.0,Y 225.0,Z 180.0")
    translate(source, "rapid", out)
    assert "taught-twice" in capsys.readouterr().err
    assert touched in (out / name).read_text("latin-1")


def test_without_a_folder_nothing_can_be_kept(source: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["translate", str(source), "--to", "rapid", "--keep-taught"]) == 2
    assert "name it with -o" in capsys.readouterr().err
