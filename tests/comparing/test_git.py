"""Git shows and merges robot programs by these commands, in repositories of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SAMPLE = Path(__file__).parents[2] / "samples" / "krl" / "machine_tending"
RPL = f'"{sys.executable}" -m rpl.cli.main'

pytestmark = pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")


class Repository:
    """A repository that asks us about programs; nothing of the user's settings comes in."""

    def __init__(self, folder: Path) -> None:
        self.home = home = folder / "plant"
        home.mkdir()
        who = {
            f"GIT_{role}_{part}": value
            for role in ("AUTHOR", "COMMITTER")
            for part, value in (("NAME", "t"), ("EMAIL", "t@t"))
        }
        alone = {
            "GIT_CONFIG_GLOBAL": os.devnull,
            "GIT_CONFIG_NOSYSTEM": "1",
            "HOME": str(folder),
            "GIT_MERGE_AUTOEDIT": "no",
        }
        self.environment = {**os.environ, **who, **alone}
        self.environment.pop("GIT_PAGER_IN_USE", None)
        self.git("init", "-q")
        self.git("checkout", "-q", "-b", "office")
        self.git("config", "diff.rpl.command", f"{RPL} diff --git")
        self.git("config", "merge.rpl.name", "robot programs by what they mean")
        self.git("config", "merge.rpl.driver", f"{RPL} merge %O %A %B -o %A --path %P")
        (home / ".gitattributes").write_text("*.src diff=rpl merge=rpl\n*.dat diff=rpl merge=rpl\n")
        for file in SAMPLE.glob("machine_tending.*"):
            shutil.copy(file, home)
        self.git("add", ".")
        self.git("commit", "-q", "-m", "base")

    def git(self, *words: str, status: int = 0) -> str:
        done = subprocess.run(
            ["git", *words], cwd=self.home, env=self.environment, capture_output=True, text=True, timeout=300
        )
        assert done.returncode == status, done.stdout + done.stderr
        return done.stdout + done.stderr

    def edit(self, file: str, old: str, new: str) -> None:
        text = (self.home / file).read_text()
        assert old in text
        (self.home / file).write_text(text.replace(old, new))


@pytest.fixture
def repository(tmp_path: Path) -> Repository:
    return Repository(tmp_path)


def test_git_diff_tells_a_moved_point_a_new_file_and_one_that_is_gone(repository: Repository) -> None:
    repository.edit("machine_tending.dat", "XLOAD={X 680.0", "XLOAD={X 684.0")
    lines = repository.git("diff").splitlines()
    assert lines == [
        "rpl diff a/machine_tending.dat b/machine_tending.dat",
        "points:",
        "  ~ XLOAD: moved 4.00 mm (x +4)  (machine_tending.dat:6)",
        "differs: 1 point",
    ]
    (repository.home / "more.src").write_text("DEF more()\nHALT\nEND\n")
    (repository.home / "machine_tending.src").unlink()
    repository.git("add", "-A")
    text = repository.git("diff", "--cached")
    assert "new file more.src" in text and "deleted file machine_tending.src" in text


def test_a_touch_up_and_an_edit_are_merged_by_git(repository: Repository) -> None:
    repository.git("checkout", "-q", "-b", "floor")
    repository.edit("machine_tending.dat", "XLOAD={X 680.0", "XLOAD={X 684.0")
    repository.edit("machine_tending.src", "&REL 1", "&REL 7")
    repository.git("commit", "-q", "-a", "-m", "touched up")
    repository.git("checkout", "-q", "office")
    repository.edit("machine_tending.dat", "XBEFORE={X 500.0", "XBEFORE={X 505.0")
    repository.edit("machine_tending.src", "&REL 1", "&REL 3")
    repository.edit("machine_tending.src", "WAIT SEC 0.3", "WAIT SEC 0.5")
    repository.git("commit", "-q", "-a", "-m", "edited")
    repository.git("merge", "-q", "floor")
    data, program = ((repository.home / f"machine_tending.{part}").read_text() for part in ("dat", "src"))
    assert "XLOAD={X 684.0" in data and "XBEFORE={X 505.0" in data
    assert "WAIT SEC 0.5" in program and "&REL 3" in program
    assert repository.git("status", "--porcelain") == ""  # nothing of ours is left beside the files


def test_a_conflict_leaves_marks_and_what_it_is(repository: Repository) -> None:
    repository.git("checkout", "-q", "-b", "floor")
    repository.edit("machine_tending.dat", "XLOAD={X 680.0", "XLOAD={X 684.0")
    repository.git("commit", "-q", "-a", "-m", "touched up")
    repository.git("checkout", "-q", "office")
    repository.edit("machine_tending.dat", "XLOAD={X 680.0", "XLOAD={X 667.5")
    repository.git("commit", "-q", "-a", "-m", "edited")
    said = repository.git("merge", "floor", status=1)
    assert "XLOAD: ours moved 12.50 mm (x -12.5), theirs moved 4.00 mm (x +4)" in said
    assert repository.git("status", "--porcelain").splitlines() == ["UU machine_tending.dat"]
    lines = (repository.home / "machine_tending.dat").read_text().splitlines()
    assert [line for line in lines if line[:7] in ("<<<<<<<", "=======", ">>>>>>>")] == [
        "<<<<<<< ours",
        "=======",
        ">>>>>>> theirs",
    ]
