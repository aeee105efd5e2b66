"""Shared by the tests of TP's writer: programs in the form that the passes give, written in RPL."""

from __future__ import annotations

import re
from collections.abc import Mapping

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.passes.typing import normalise
from rpl.source import source_from_text
from rpl.writing.target import OutputFile, WriteContext

BANKS = """MODULE registers
    GLOBAL VAR R: ARRAY[200] OF REAL
    GLOBAL VAR F: ARRAY[1024] OF BOOL
    GLOBAL VAR PR: ARRAY[100] OF POSE
    GLOBAL VAR SR: ARRAY[25] OF STRING
    GLOBAL VAR TIMER: ARRAY[20] OF CLOCK
END MODULE
"""
POINTS = """        VAR P1: POSE = {x: 400, y: 0, z: 300, a: 180, b: 0, c: 180}
        VAR P2: JOINTS = {j1: 0, j2: 10, j3: -20.5, j4: 0, j5: -90, j6: 0}
"""
HELPERS = """    PROCEDURE helper(AR1: REAL)
        R[9] = AR1
    END PROCEDURE
    PROCEDURE other()
        R[9] = 0.0
    END PROCEDURE
"""
_NUMBERED = re.compile(r"^ *\d+:(.*?) *;?$")


def write(text: str, names: Mapping[tuple[str, int], str] | None = None) -> tuple[dict[str, str], list[str]]:
    """The listings of an RPL project by file name, and the codes that were reported."""
    diagnostics = Diagnostics()
    program = registry.dialect("rpl").read([source_from_text("p.rpl", text)], diagnostics).program
    program = normalise(program, diagnostics)
    assert not [item.as_text() for item in diagnostics], "the test's own program has to be clean"
    context = WriteContext(diagnostics, None, register_names=names or {})
    files: list[OutputFile] = registry.target("tp").write(program, context)
    return {file.path: file.data.decode("ascii") for file in files}, [item.code.name for item in diagnostics]


def listing(
    statements: str, names: Mapping[tuple[str, int], str] | None = None, entry: str = "m"
) -> tuple[str, list[str]]:
    """The listing of program p with these statements. It is called by program m, or started itself (`entry`)."""
    body = "\n".join(f"        {line}" for line in statements.splitlines())
    caller = "    PROCEDURE m()\n        p()\n    END PROCEDURE\n"
    own = f"    PROCEDURE p()\n{POINTS}{body}\n    END PROCEDURE\n"
    text = f"{BANKS}ENTRY {entry}\nMODULE cell\n{caller}{own}{HELPERS}END MODULE\n"
    files, codes = write(text, names)
    return files["P.LS"], codes


def lines(statements: str, names: Mapping[tuple[str, int], str] | None = None, entry: str = "m") -> list[str]:
    """The numbered lines of these statements without their numbers; nothing may be reported."""
    text, codes = listing(statements, names, entry)
    assert not codes
    return numbered(text)


def numbered(text: str) -> list[str]:
    body = text.split("/MN")[1].split("/POS")[0].strip("\r\n").splitlines()
    return [(match[1] if (match := _NUMBERED.match(line)) else line.rstrip(" ;")).strip() for line in body]
