"""benchmarks/run_backups.py: projects of a folder, and how their programs end."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.append(str(ROOT / "benchmarks"))

import run_backups  # noqa: E402 (not on the usual path)


def test_projects_of_a_folder(tmp_path: Path) -> None:
    for name in ("KRC/R1/Program/a.src", "KRC/R1/System/b.src", "loose/c.src", "loose/sub/d.src", "loose/copy/c.src"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"DEF {path.stem}()\n$OUT[1]=TRUE\nEND\n")
    found = [sorted(path.name for path in paths) for _, paths in run_backups.projects(tmp_path)]
    assert sorted(found) == [["a.src", "b.src"], ["c.src"], ["c.src", "d.src"]]


@pytest.mark.parametrize(
    ("body", "kind", "what"),
    [
        ("$OUT[1]=TRUE", "end", "finished"),
        ("HALT", "end", "stopped"),
        ("WAIT FOR $IN[3]", "waits for input", "$IN[3]"),
        ("WHILE NOT $IN[4]\nWAIT SEC 0.1\nENDWHILE", "waits for input", "$IN[4]"),
        ("away(1)", "unknown routine", "away"),
        ("LOOP\n$OUT[1]=TRUE\nWAIT SEC 1\n$OUT[1]=FALSE\nWAIT SEC 1\nENDLOOP", "loops", ""),
        ("n=m", "unknown data", "m has no value yet"),
        ("n=lost", "unknown data", "lost"),
    ],
)
def test_classes(tmp_path: Path, body: str, kind: str, what: str) -> None:
    path = tmp_path / "main.src"
    path.write_text(f"DEF main()\nINT n,m\n{body}\nEND\n")
    (outcome,) = run_backups.measure((tmp_path.name, [path], 60.0, 60.0))
    assert (outcome.kind, outcome.what) == (kind, what)
    assert outcome.language == "krl" and outcome.entry == "main"


def test_versions_of_one_program_are_programs_of_their_own(tmp_path: Path) -> None:
    for name in ("old", "new"):
        module = "MODULE MainModule\nPROC main()\nhelp;\nENDPROC\nENDMODULE\n"
        (tmp_path / f"{name}.mod").write_text(module)
    (tmp_path / "helper.mod").write_text('MODULE Helper\nPROC help()\nTPWrite "a";\nENDPROC\nENDMODULE\n')
    ((name, paths),) = run_backups.projects(tmp_path)
    found = run_backups.measure((name, paths, 60.0, 60.0))
    assert [(one.entry, one.kind) for one in found] == [("main", "end"), ("main", "end")]
    assert run_backups.share(found) == 100.0
