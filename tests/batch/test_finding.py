"""What the projects of an archive are: by names, backups whole, programs with what belongs to them."""

from pathlib import Path

import pytest

from rpl.batch.finding import Project, projects
from rpl.errors import UsageError


def plant(root: Path, *files: str) -> Path:
    for name in files:
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    return root


def names(found: list[Project]) -> list[str]:
    return [one.name for one in found]


@pytest.mark.parametrize(
    "files",
    [
        ("BACKINFO/backinfo.txt", "RAPID/TASK1/PROGMOD/Main.mod", "SYSPAR/MOC.cfg"),
        ("am.ini", "KRC/R1/Program/main.src", "KRC/R1/System/$config.dat"),
        ("R1/Program/main.src", "R1/System/$config.dat"),
        ("MAIN.LS", "SYSVARS.VA", "MAIN.TP"),
        ("MAIN.JBI", "TOOL.CND", "ALL.PRM"),
        ("app.pjx", "start.pgx", "app.dtx"),
    ],
)
def test_a_backup_is_one_project(tmp_path: Path, files: tuple[str, ...]) -> None:
    plant(tmp_path, *(f"hall/cell 1/{name}" for name in files), "hall/lone.src")
    assert names(projects(tmp_path)) == ["hall/cell 1", "hall/lone.src"]
    (whole,) = projects(tmp_path / "hall/cell 1")
    assert whole.name == "cell 1"


def test_a_program_takes_along_what_belongs_to_it(tmp_path: Path) -> None:
    plant(tmp_path, "a/b.src", "a/b.dat", "a/$config.dat", "a/notes.txt", "a/.hidden.src", "c.zip", "d.JBI", "e.script")
    found = projects(tmp_path)
    assert names(found) == ["a/b.src", "c.zip", "d.JBI", "e.script"]
    assert [Path(one).name for one in found[0].beside] == ["b.dat", "$config.dat"]


def test_programs_of_one_folder_are_one_project_when_asked_for(tmp_path: Path) -> None:
    plant(tmp_path, "a/b.src", "a/b.dat", "a/c.src", "a/inner/d.src", "e.src")
    found = projects(tmp_path, together=True)
    assert names(found) == sorted([tmp_path.name, "a", "a/inner"])
    assert [len(one.paths) for one in found if one.name == "a"] == [2]


def test_the_digest_changes_with_every_byte_that_is_read(tmp_path: Path) -> None:
    plant(tmp_path, "b.src", "b.dat", "other.src")
    before = projects(tmp_path)[0].digest()
    (tmp_path / "other.src").write_text("another")
    assert projects(tmp_path)[0].digest() == before
    (tmp_path / "b.dat").write_text("another")
    assert projects(tmp_path)[0].digest() != before


def test_a_folder_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no such folder"):
        projects(tmp_path / "nowhere")
