"""Reads the tables of clauses in clauses/*.txt and makes programs of them.

A clause is one word or form of RPL in a context where it is used, with what the manual says it does:

    ## its name => the targets in which it is looked at after translation too
    % a line of the module: declarations, and routines behind them
    a line of the clause's own procedure
    ? what holds at its end

Each clause has an output that is on when that holds; `~` stands for the output's number, so that names differ.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

FOLDER = Path(__file__).parent / "clauses"
_ROUTINE = re.compile(r"(?:GLOBAL |LOCAL )?(?:PROCEDURE|FUNCTION|TRAP)\b")
_HOME = "CONST home: JOINTS = {j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0}"


@dataclass
class Clause:
    """`before`: lines in front of the module."""

    table: str
    name: str
    targets: tuple[str, ...]
    before: list[str] = field(default_factory=list)
    module: list[str] = field(default_factory=list)
    body: list[str] = field(default_factory=list)
    holds: str = "TRUE"


def clauses() -> list[Clause]:
    """All clauses of all tables."""
    found: list[Clause] = []
    for path in sorted(FOLDER.glob("*.txt")):
        for line in path.read_text("utf-8").splitlines():
            mark, rest = line[:2], line[2:].strip()
            if line.startswith("## "):
                name, _, targets = line[3:].partition(" => ")
                found.append(Clause(path.stem, name, tuple(targets.split())))
            elif mark == "% ":
                (found[-1].before if rest.startswith("TASK ") else found[-1].module).append(line[2:])
            elif mark == "? ":
                found[-1].holds = rest
            elif line.strip():
                found[-1].body.append(line)
    return found


def program_of(clauses: list[Clause]) -> str:
    """The program whose output n is on when clause n (from 1) holds."""
    before, declared, routines = ["ENTRY main"], [_HOME], []
    calls = ["PROCEDURE main()", "    MOVE TO home"]
    for number, clause in enumerate(clauses, 1):
        at = next((at for at, line in enumerate(clause.module) if _ROUTINE.match(line)), len(clause.module))
        own = ["PROCEDURE clause~()", *(f"    {line}" for line in clause.body), f"    SET do[~] TO {clause.holds}"]
        routines += [line.replace("~", str(number)) for line in (*own, "END PROCEDURE", *clause.module[at:])]
        before += [line.replace("~", str(number)) for line in clause.before]
        declared += [line.replace("~", str(number)) for line in clause.module[:at]]
        calls.append(f"    clause{number}()")
    return "\n".join((*before, "MODULE table", *declared, *calls, "END PROCEDURE", *routines, "END MODULE", ""))
