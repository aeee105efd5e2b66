"""Hashes of every file that translation writes: all samples and self-checking projects, in every language.

    python tests/conformance/written.py            compares with `written.json`; exit status 1 at a difference
    python tests/conformance/written.py write      writes it anew
    ... [words of project names] [to:TARGET ...] [keep:FOLDER]    some pairs only; keep the files, to look at them

A change that is to change no output leaves the table as it is. Where it does not, `keep:` before and behind the change
and a comparison of the two folders show what became of each file.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tomllib
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from rpl import registry
from rpl.cell import Cell, read_cell
from rpl.diagnostics import Diagnostics
from rpl.errors import RplError
from rpl.project import ReadProgram, read_program
from rpl.translation import translate_program

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
FILE = HERE / "written.json"
_DIGITS = 16  # of a hash: enough to tell files apart, short enough to read

Table = dict[str, dict[str, dict[str, str]]]  # project -> target -> path -> hash


@dataclass(frozen=True)
class Project:
    """Programs that are translated together: a sample or a self-checking project. `cell`: its surroundings."""

    folder: Path
    robot: str
    cell: Path | None = None


def projects() -> dict[str, Project]:
    """Every project by its name, `samples/krl/palletiser` or `selfcheck/krl_logic`."""
    found = {}
    for expected in sorted((ROOT / "samples").glob("*/*/expected.toml")):
        folder, data = expected.parent, tomllib.loads(expected.read_text("utf-8"))
        cell = folder / str(data["cell"]) if "cell" in data else None
        found[f"samples/{folder.parent.name}/{folder.name}"] = Project(folder, str(data["robot"]), cell)
    sys.path.insert(0, str(ROOT / "tests" / "selfcheck"))
    from pairs import PROJECTS  # a table of its own; the folder is no package

    for name, one in PROJECTS.items():
        folder = ROOT / "tests" / "selfcheck" / name
        cell = folder / "cell.toml"
        found[f"selfcheck/{name}"] = Project(folder, one.robot, cell if cell.exists() else None)
    return found


@cache
def _read(folder: Path) -> ReadProgram:
    return read_program([folder], diagnostics=Diagnostics())


def files_of(project: Project, target: str) -> dict[str, bytes]:
    """path -> bytes of what is written for the project. Of a translation that is refused as a whole: its words."""
    cell = read_cell(str(project.cell)) if project.cell is not None else Cell()
    try:
        written = translate_program(
            _read(project.folder),
            target,
            project.robot,
            None,
            Diagnostics(),
            given=cell.variables,
            mechanisms=cell.mechanisms,
            analog=cell.analog,
        )
    except RplError as error:
        return {"": str(error).encode()}
    return {file.path: file.data for file in written.files}


def _hashes(job: tuple[str, Project, str, str]) -> dict[str, str]:
    name, project, target, keep = job
    files = files_of(project, target)
    if keep:
        for path, data in files.items():
            place = Path(keep) / name / target / (path or "refused.txt")
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(data)
    return {path: hashlib.sha256(data).hexdigest()[:_DIGITS] for path, data in sorted(files.items())}


def differences(old: Table, new: Table) -> list[str]:
    """One line for each file of the pairs in `new` that is another one, is gone, or was not there."""
    lines = []
    for name, targets in new.items():
        for target, files in targets.items():
            before = old.get(name, {}).get(target)
            if before is None:
                lines.append(f"{name} -> {target}: not in the table")
                continue
            for path in sorted({*before, *files}):
                if before.get(path) != files.get(path):
                    what = "new" if path not in before else "gone" if path not in files else "changed"
                    lines.append(f"{name} -> {target}: {path or 'the refusal'} {what}")
    return lines


def main(words: list[str]) -> int:
    targets = [word[3:] for word in words if word.startswith("to:")] or list(registry.target_names())
    keep = next((word[5:] for word in words if word.startswith("keep:")), "")
    wanted = [word for word in words if word != "write" and not word.startswith(("to:", "keep:"))]
    named = {name: one for name, one in projects().items() if not wanted or any(word in name for word in wanted)}
    jobs = [(name, one, target, keep) for name, one in named.items() for target in targets]
    table: Table = {}
    with ProcessPoolExecutor(2) as pool:
        for (name, _, target, _), hashes in zip(jobs, pool.map(_hashes, jobs, chunksize=len(targets)), strict=True):
            table.setdefault(name, {})[target] = hashes
    old: Table = json.loads(FILE.read_text("utf-8")) if FILE.exists() else {}
    told = differences(old, table)
    print(*told, sep="\n", end="\n" if told else "")
    print(f"{len(jobs)} translations, {sum(map(len, (f for t in table.values() for f in t.values())))} files", end="; ")
    print(f"{len(told)} differ" if told else "all as in the table")
    if "write" not in words:
        return 1 if told else 0
    merged = {name: old.get(name, {}) | found for name, found in table.items()}
    rows = merged if not wanted else old | merged
    FILE.write_text(json.dumps(rows, indent=0, sort_keys=True) + "\n", "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
