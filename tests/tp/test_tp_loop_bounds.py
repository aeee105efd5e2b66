"""A TP loop looks at its last value before each pass; loops that look once keep it."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

LIST = "\n".join(f"a[{n}] = {n}" for n in range(1, 10))
CASES = {
    "the body changes it": "j = 3\nFOR i = 1 TO j\nj = j+1\nn = n+1\nEND",
    "the body works with elements": f"{LIST}\nj = 3\nFOR i = 1 TO j\na[i+1] = a[i]*2+a[i+2]\nj = j+a[i]\nn = n+1\nEND",
    "a routine changes it": "k = 3\nFOR i = 1 TO k\nCALL more()\nn = n+1\nEND",
    "it is calculated": "k = 1\nFOR i = 1 TO 2*k+1\nk = k+1\nn = n+1\nEND",
    "it stays": "k = 3\nFOR i = 1 TO k\nn = n+1\nEND",
}


@pytest.mark.parametrize("name", CASES)
def test_there_are_three_passes(name: str) -> None:
    text = f".PROGRAM main()\nAUTO i, j, n\nn = 0\n{CASES[name]}\nIF n == 3 THEN\nSIGNAL 1\nEND\n.END\n"
    text += ".PROGRAM more()\nk = k+1\n.END\n" if "more" in text else ""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.v2", text)], "vplus", diagnostics)
    assert [value for _, _, value in run_program(read.program, entry="main").outputs] == [True]
    done = translate_program(read, "tp", None, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], "tp", Diagnostics())
    result = run_program(back.program, entry=done.renamed.get("main", "main"))
    assert [value for _, _, value in result.outputs] == [True]
    assert any("FOR R[" in file.data.decode("latin-1") for file in done.files)
