"""Interrupts whose routine does nothing are left out of the translation, with a remark where they are the program's."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

INIT = "GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )\nINTERRUPT ON 3\n"
PROGRAM = "DEF main( )\n%s$OUT[1]=TRUE\nEND\n"
OWN = "DEF hit( )\n%sEND\n"


def read(text: str) -> ReadProgram:
    return read_sources([source_from_text("main.src", text)], "krl", Diagnostics())


def written(text: str, target: str) -> tuple[str, Diagnostics, ReadProgram]:
    diagnostics = Diagnostics()
    done = translate_program(read(text), target, None, None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    return "".join(file.data.decode() for file in done.files), diagnostics, back


@pytest.mark.parametrize("target", ["rapid", "vplus", "tp", "urscript", "inform"])
def test_the_stop_message_of_inline_forms(target: str) -> None:
    text, diagnostics, back = written(PROGRAM % INIT, target)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert "controller-reaction-left-out" in [item.code.name for item in diagnostics]
    assert "left out: " not in text.lower()
    assert run_program(back.program).status == "finished"


@pytest.mark.parametrize(("body", "stays"), [("", False), ("$OUT[2]=TRUE\n", True)])
def test_only_what_does_nothing(body: str, stays: bool) -> None:
    declared = "INTERRUPT DECL 4 WHEN $IN[1]==TRUE DO hit( )\nINTERRUPT ON 4\n"
    text, _, _ = written(PROGRAM % (declared + "INTERRUPT OFF\n") + OWN % body, "rapid")
    assert ("left out: " in text) != stays
    assert ("CONNECT" in text) == stays and ("ISignalDI" in text) == stays and ("IDelete" in text) == stays


def test_another_one_of_the_same_number_stays() -> None:
    again = "INTERRUPT DECL 3 WHEN $IN[1]==TRUE DO hit( )\nINTERRUPT ON 3\n"
    _, diagnostics, _ = written(PROGRAM % (INIT + again) + OWN % "$OUT[2]=TRUE\n", "vplus")
    assert "empty-reaction-left-out" not in [item.code.name for item in diagnostics]
