"""How large V+ arrays are read, which grow as they are used, and what becomes of them where data has numbers."""

from __future__ import annotations

import pytest
from vplus_helpers import outputs, program_of, read, run, variable

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

MORE = {
    "put": ".PROGRAM put(at)\na[at] = 1\n.END\n",
    "up": ".PROGRAM up(at)\nat = at+1\n.END\n",
    "six": ".PROGRAM six(at)\nat = 6\n.END\n",
}
REALS = ".REALS\nlist[0] 3\nlist[1] 7\n.END"
SIZES = [
    ("FOR n = 1 TO 3\na[n] = 1\nEND", 3),
    ("FOR n = 1 TO 3\nEND\na[n] = 1", 4),  # behind the loop the counter has passed its end
    ("FOR n = 5 TO 1 STEP -1\na[n] = 1\nEND", 5),
    ("CALL put(2)\nCALL put(4)", 4),
    ("n = 3\nCALL put(n)", 3),
    ("CALL six(n)\na[n] = 1", 6),
    ("FOR n = 0 TO 1\na[list[n]] = 1\nEND", 7),
    ("FOR n = 0 TO 1\nm = list[n]\nCALL put(m)\nEND", 7),
    ("n = 9 MOD 4\na[n] = 1\na[INT(9/2)] = 1", 4),
    ("a[2] = 1\nm = 7\nn = a[m]", 2),  # what was never filled cannot be read
    ("n = 1\nCALL up(n)\na[n] = 1", 255),
    ("n = n+1\na[n] = 1", 255),
    ("n = 2\nWHILE n < 9 DO\nn = n*n\nEND\na[n] = 1", 255),
    ("PROMPT n\na[n] = 1", 255),
    ("a[3] = 1\nIF DEFINED(a[9]) THEN\nEND", 9),
]


@pytest.mark.parametrize(("steps", "last"), SIZES)
def test_the_last_index(steps: str, last: int) -> None:
    more = "".join(text for name, text in MORE.items() if f"CALL {name}" in steps)
    program, _ = read({"p.v2": program_of(steps, more), "p.re": REALS})
    type = variable(program, "a").type
    assert isinstance(type, ir.ArrayType) and type.dimensions == (ir.IntLiteral(last),)
    assert bool(type.grows) == (last == 255)


def test_behind_its_loop_the_counter_is_an_index() -> None:
    assert outputs(run("FOR n = 1 TO 3\na[n] = n\nEND\na[n] = 9\nIF a[4] == 9 THEN\nSIGNAL 1\nEND")) == [("1", True)]


GROWING = (
    "k = 0\nFOR n = 1 TO 12\nIF n MOD 3 == 0 THEN\nk = k+1\nfound[k] = n\nEND\nEND\n"
    "FOR n = 1 TO 2\nSET place[n,k] = TRANS(n,k)\nEND\n"
    "IF (found[4] == 12) AND (DX(place[2,4]) == 2) THEN\nSIGNAL 1\nEND"
)


@pytest.mark.parametrize(("target", "sizes"), [("tp", 2), ("inform", 2), ("krl", 0)])
def test_numbers_of_a_controller_are_shared_out(target: str, sizes: int) -> None:
    source = read_sources([source_from_text("main.v2", program_of(GROWING))], "vplus", Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, "adept_viper_s650", None, found)
    assert not [item.as_text() for item in found.of(Severity.LOSS)]
    assert sum(item.code.name == "array-size-chosen" for item in found) == sizes
    files = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(files, target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("test", "test"))
    assert result.status == "finished" and [value for _, _, value in result.outputs] == [True]
