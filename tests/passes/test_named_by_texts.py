"""Procedures that are only called by a text are no programs of their own that might be started."""

from __future__ import annotations

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.facts.values.heldtexts import named_by_texts
from rpl.passes.legalise.rewriting.startdata import entries_of
from rpl.simulation import entry_name
from rpl.source import source_from_text

JOBS = """
PROCEDURE part1()
END PROCEDURE
PROCEDURE part2()
END PROCEDURE
PROCEDURE other()
END PROCEDURE
"""


def read(body: str) -> ir.Program:
    text = f"VAR no: STRING\nVAR job: STRING\nPROCEDURE shift()\n{body}\nother()\nEND PROCEDURE\n{JOBS}"
    return registry.dialect("rpl").read([source_from_text("p.rpl", text)], Diagnostics()).program


@pytest.mark.parametrize(
    ("body", "named"),
    [
        ('CALL BY "part" & no', {"part1", "part2"}),
        ('CALL BY "part" & "2"', {"part2"}),
        ('job = "PART1"\nCALL BY job', {"part1"}),
        ('job = "part"\njob = job & no\nCALL BY job', {"part1", "part2"}),
        ('IF TRUE THEN\njob = "part"\nCALL BY job & no\nEND IF', {"part1", "part2"}),
        ("job = no\nCALL BY job", set()),
        ("CALL BY no & job", set()),
    ],
)
def test_what_a_text_names(body: str, named: set[str]) -> None:
    program = read(body)
    assert named_by_texts(program) == named
    assert entries_of(program) == {"shift", "part1", "part2"} - named


def test_a_routine_for_errors_is_no_program() -> None:
    text = "PROCEDURE shift()\nTRAP ERRORS WITH trap\nEND PROCEDURE\nPROCEDURE trap()\nEND PROCEDURE\n"
    program = registry.dialect("rpl").read([source_from_text("p.rpl", text)], Diagnostics()).program
    assert entries_of(program) == {"shift"}


def test_a_run_starts_with_none_of_them() -> None:
    program = read('other()\njob = "part"\njob = job & no\nCALL BY job')
    assert entry_name(program) == "shift"
