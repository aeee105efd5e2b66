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
        ("LOOP\nWAIT SEC 0.5\nIF $IN[5] THEN\nEXIT\nENDIF\nENDLOOP", "waits for input", "$IN[5]"),
        ("n=m", "unknown data", "m has no value yet"),
        ("n=lost", "unknown data", "lost"),
        ("WAIT FOR $OUT[3]", "waits for what is outside", "$OUT[3]"),
        ("$OUT[3]=FALSE\nWAIT FOR $OUT[3]", "waits for what is outside", "$OUT[3]"),
        ("WAIT FOR $OUT[3]\n$OUT[3]=TRUE", "waits for something else", "main waits for a condition (WAIT FOR $OUT[3])"),
    ],
)
def test_classes(tmp_path: Path, body: str, kind: str, what: str) -> None:
    path = tmp_path / "main.src"
    path.write_text(f"DEF main()\nINT n,m\n{body}\nEND\n")
    (outcome,) = run_backups.measure((tmp_path.name, [path], 60.0, 60.0))
    assert (outcome.kind, outcome.what.partition(" at /")[0]) == (kind, what)
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


@pytest.mark.parametrize(
    ("body", "kind", "what"),
    [
        ("n=lost", "end", "finished"),
        ("n=lost\nWAIT FOR $IN[2]", "waits for input", "$IN[2]"),
        ("WAIT FOR lost AND seen", "waits for what is outside", "lost, seen"),
        ("WAIT FOR lost\nlost=TRUE", "waits for something else", "main waits for a condition (WAIT FOR lost)"),
        ("n=m", "unknown data", "m has no value yet"),  # of the routine: a fault of the program
        ("n=lost\naway(n)", "unknown routine", "away"),
    ],
)
def test_classes_with_assumed_data(tmp_path: Path, body: str, kind: str, what: str) -> None:
    path = tmp_path / "main.src"
    path.write_text(f"DEF main()\nINT n,m\n{body}\nEND\n")
    (outcome,) = run_backups.measure((tmp_path.name, [path], 60.0, 60.0))
    assert outcome.kind == "unknown data"
    assert (outcome.assumed_kind, outcome.assumed_what.partition(" at /")[0]) == (kind, what)
    assert outcome.assumed == ("lost" in body) + ("seen" in body)
    assert ("lost = " in outcome.assumed_data) == ("lost" in body)
    text = "\n".join(run_backups.table([outcome]))
    assert f"{kind} with assumed data" in text and "share as they are, %" in text


def test_copies_are_counted_once(tmp_path: Path) -> None:
    for name in ("a", "b", "c"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "main.src").write_text(f"DEF main()\n$OUT[{1 + (name == 'c')}]=TRUE\nEND\n")
    found = [one for task in run_backups.projects(tmp_path) for one in run_backups.measure((*task, 60.0, 60.0))]
    assert len(found) == 3 and len(run_backups.without_copies(found)) == 2


def test_a_wait_with_a_time_out_that_comes_round_waits_for_its_input(tmp_path: Path) -> None:
    path = tmp_path / "MAIN.LS"
    path.write_text(
        "/PROG  MAIN\n/ATTR\n/MN\n   1:  LBL[1] ;\n   2:  $WAITTMOUT=200 ;\n   3:  WAIT DI[7]=ON TIMEOUT,LBL[2] ;\n"
        "   4:  END ;\n   5:  LBL[2] ;\n   6:  DO[3]=PULSE,1.0sec ;\n   7:  JMP LBL[1] ;\n/POS\n/END\n"
    )
    (outcome,) = run_backups.measure((tmp_path.name, [path], 600.0, 60.0))
    assert (outcome.kind, outcome.what) == ("waits for input", "DI[7]")
