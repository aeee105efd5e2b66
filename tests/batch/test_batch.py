"""Whole batches: rows, files, what is lost with a process, what is done already. Processes are slow: few start here."""

import csv
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from rpl.batch import rows
from rpl.batch.asked import CHECK, RUN, Asked
from rpl.batch.finding import projects
from rpl.batch.journal import read_journal
from rpl.batch.processes import Worker, answers
from rpl.batch.work import answer
from rpl.cli.main import run
from rpl.runtime.limits import Limits

GOOD = "DEF {}()\n$OUT[1]=TRUE\nEND\n"
BROKEN = "DEF {}()\n$OUT[1]==TRUE)(\nEND\n"
ENDLESS = "DEF {}()\nINT i\ni = 0\nWHILE TRUE\ni = 1 - i\nENDWHILE\nEND\n"
ROOT = Path(__file__).parents[2]
PATIENCE_S = 120.0


@pytest.fixture
def plant(tmp_path: Path) -> Path:
    """Four programs in two halls, one of them broken; the binary one is a program by its name only."""
    home = tmp_path / "plant"
    for name, text in (("hall1/a", GOOD), ("hall1/b", BROKEN), ("hall2/c", GOOD), ("hall2/d", "")):
        path = home / f"{name}.src"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.format(path.stem).encode() or b"\x00\x01" * 50)
    return home


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as stream:
        return list(csv.DictReader(stream))


def test_a_check_goes_past_bad_files_and_goes_on_where_it_was(plant: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results = plant.parent / "all.csv"
    arguments = ["batch", str(plant), "--check", "--results", str(results), "--jobs", "1"]
    assert run(arguments) == 1
    made = table(results)
    assert [(row["project"], row["outcome"]) for row in made] == [
        ("hall1/a.src", "good"),
        ("hall1/b.src", "errors"),
        ("hall2/c.src", "good"),
        ("hall2/d.src", "no program"),
    ]
    assert made[1]["unread"] == made[1]["errors"] == "1"
    assert made[1]["reason"].startswith("hall1/b.src:2: ")
    capsys.readouterr()

    (plant / "hall1/b.src").write_text(GOOD.format("b"))
    assert run(arguments) == 0
    assert "3 of 4 projects are done already" in capsys.readouterr().err
    assert [row["outcome"] for row in table(results)] == ["good", "good", "good", "no program"]


def test_rows_are_lines_of_json_and_each_project_has_a_folder(plant: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (plant / "hall1/a.mod").write_text("MODULE a\nPROC a()\nSetDO do1,1;\nENDPROC\nENDMODULE\n")
    out = plant.parent / "out"
    assert run(["batch", str(plant), "--to", "rapid", "-o", str(out), "--json", "--jobs", "1", "--timings"]) == 1
    made = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [(row["project"], row["outcome"], row["written"]) for row in made][:3] == [
        ("hall1/a.mod", "good", 1),
        ("hall1/a.src", "good", made[1]["written"]),
        ("hall1/b.src", "errors", None),
    ]
    assert all(row["seconds"] > 0 for row in made)
    assert (out / "hall1/a.mod/a.mod").is_file() and (out / "hall1/a.src/a.mod").is_file()
    assert (out / "hall2/c/c.mod").is_file()
    assert not (out / "hall1/b").exists()


def test_a_process_that_hangs_or_dies_loses_its_project_only(plant: Path) -> None:
    (plant / "hall1/b.src").write_text(ENDLESS.format("b"))
    asked = Asked(RUN, limits=Limits(steps=10**12))
    a, b, *_ = projects(plant)
    worker = Worker(PATIENCE_S)
    assert [row.status for row in worker.do(a, asked).rows] == ["finished"]
    worker.limit_s = 1.0
    (late,) = worker.do(b, asked).rows
    assert (late.outcome, late.reason) == (rows.TOO_LONG, "ended after 1 s")
    worker.limit_s = PATIENCE_S
    assert [row.status for row in worker.do(a, asked).rows] == ["finished"]
    killed = threading.Timer(1.0, worker.end)
    killed.start()
    (lost,) = worker.do(b, asked).rows
    assert (lost.outcome, lost.reason) == (rows.LOST, "its process was ended: killed")
    worker.close()


def test_who_stops_asking_ends_the_processes(plant: Path) -> None:
    (plant / "hall1/b.src").write_text(ENDLESS.format("b"))
    ahead = answers(projects(plant), Asked(RUN, limits=Limits(steps=10**12)), 1, PATIENCE_S)
    project, answer = next(ahead)
    assert (project.name, answer.rows[0].outcome) == ("hall1/a.src", "good")
    begun = time.monotonic()
    ahead.close()
    assert time.monotonic() - begun < PATIENCE_S / 2


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Tests that run in the background ignore SIGINT, and so would what they start."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(os.name != "posix", reason="Ctrl-C is sent as a signal")
def test_after_ctrl_c_the_same_command_goes_on(plant: Path, interruptible: None) -> None:
    (plant / "hall1/b.src").write_text(ENDLESS.format("b"))
    results = plant.parent / "all.csv"
    command = [sys.executable, "-m", "rpl.cli.main", "batch", str(plant), "--run", "--max-steps", str(10**12)]
    command += ["--results", str(results), "--jobs", "1"]
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=env)
    journal, until = results.with_name(".all.csv.rpl-batch.jsonl"), time.monotonic() + PATIENCE_S
    while not (journal.exists() and journal.read_text()) and time.monotonic() < until:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 130
    assert told.strip() == ("rpl: interrupted with 1 of 4 projects done; the same command goes on from there")
    assert not results.exists()
    assert set(read_journal(journal)) == {"hall1/a.src"}

    (plant / "hall1/b.src").write_text(GOOD.format("b"))
    done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    assert done.returncode == 0
    assert "1 of 4 projects are done already" in done.stderr
    assert [row["status"] for row in table(results)] == ["finished", "finished", "finished", ""]


def test_every_program_of_a_project_is_run_where_none_is_the_main_one(plant: Path) -> None:
    """Strangers among the files of a folder are no errors; a subprogram of a file is no program."""
    (plant / "hall1/b.src").write_text(GOOD.format("b") + "DEF inner()\nWAIT FOR $IN[3]\nEND\n")
    (plant / "hall1/e.src").write_text("DEF e()\nWAIT FOR $IN[3]\nEND\n")
    (plant / "hall1/d.src").write_bytes(b"\x00\x01" * 50)
    hall = next(one for one in projects(plant, together=True) if one.name == "hall1")
    found = [made for made in answer(hall, Asked(RUN)) if isinstance(made, rows.Row)]
    assert [(row.entry, row.outcome) for row in found] == [("a", "good"), ("b", "good"), ("e", "deadlock")]
    assert found[2].place is not None and found[2].place.startswith("hall1/e.src:")


def test_results_as_parquet_are_the_same_each_time(plant: Path) -> None:
    pytest.importorskip("pyarrow", reason="Parquet needs pyarrow")
    from pyarrow import parquet

    from rpl.batch.tables import table as made

    columns = rows.columns(Asked(RUN))
    some = [rows.Row("a", time_s=1.5, moves=2), rows.Row("b", outcome="fault", fault="reach")]
    path = plant.parent / "all.parquet"
    path.write_bytes(made(path, some, columns))
    assert path.read_bytes() == made(path, some, columns)
    assert parquet.read_table(path).to_pylist() == [one.cells(columns) for one in some]


def test_a_cluster_of_dask_does_the_same(plant: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="a cluster needs distributed")
    from rpl.batch import cluster

    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None, protocol="tcp"
    ) as machines:
        found = cluster.answers(projects(plant), Asked(CHECK), machines.scheduler_address, PATIENCE_S)
        outcomes = {project.name: [row.outcome for row in answer.rows] for project, answer in found}
    assert outcomes == {
        "hall1/a.src": ["good"],
        "hall1/b.src": ["errors"],
        "hall2/c.src": ["good"],
        "hall2/d.src": ["no program"],
    }


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (["--check", "--run"], "--check, --run or --to"),
        ([], "--check, --run or --to"),
        (["--check", "-o", "out"], "give both or none"),
        (["--to", "rapid"], "give both or none"),
        (["--to", "rapid", "-o", "{plant}/out"], "would be one of the projects"),
        (["--check", "--results", "all.xls"], ".csv or .parquet"),
        (["--check", "--jobs", "0"], "--jobs"),
        (["--check", "--limit", "0"], "--limit"),
        (["--check", "--prove"], "--prove"),
        (["--run", "--robot", "nobody"], "nobody"),
    ],
)
def test_a_wrong_call_is_said_at_once(
    plant: Path, arguments: list[str], hint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["batch", str(plant), *(one.format(plant=plant) for one in arguments)]) == 2
    assert hint in capsys.readouterr().err
