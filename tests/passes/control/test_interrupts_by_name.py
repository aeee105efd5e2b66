"""Conditions and delayed outputs that name signals and data of their module, where others look at them for it."""

from __future__ import annotations

import pytest

from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
PROGRAM = """ENTRY go
MODULE line
    SIGNAL lid = di[3]
    SIGNAL gun = do[12]
    VAR count: INT = 0
    VAR hits: INT = 0
    VAR watch: INTERRUPT
    PROCEDURE go()
        CONNECT watch TO seen
        ARM watch ON edge WHEN CONDITION
        SET gun TO ON AFTER 0.4 s
        WAIT 2 s
        SET do[1] TO hits = 1
        SET do[2] TO gun
    END PROCEDURE
    TRAP seen()
        hits = hits + 1
    END TRAP
END MODULE
"""
CELL = """
[[input]]
time = 0.9
signal = "di3"
value = true
"""


@pytest.mark.parametrize("condition", ["lid", "lid AND count = 0"])
@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus", "inform", "tp"])
def test_an_interrupt_sees_what_its_module_names(target: str, condition: str) -> None:
    if target == "rapid" and "AND" in condition:
        pytest.skip("RAPID's interrupts watch one signal; that is refused by name")
    read = read_sources([source_from_text("line.rpl", PROGRAM.replace("CONDITION", condition))], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    named = with_signal_names(back.program, written.program)
    cell = in_words_of(parse_cell(CELL), read.program, named)
    entry = entry_name(back.program, written.renamed.get("go", "go"))
    result = run_program(named, KUKA, cell, entry, 30.0)
    assert result.status == "finished", result.fault
    on = {event.data["signal"] for event in result.trace if event.kind == "output" and event.data["value"] is True}
    assert len(on) >= 3, on
