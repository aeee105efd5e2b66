"""docs/rpl.md is true: its examples are RPL, its tables are those of the code, it names every statement."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from rpl import registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.ir.verify import verify
from rpl.passes.typing import normalise
from rpl.reading.shapes import load_grammar
from rpl.source import source_from_text
from rpl.writing.target import WriteContext

sys.path.insert(0, str(Path(__file__).resolve().parent))
from tables import PAGE, with_tables

TEXT = PAGE.read_text("utf-8")
EXAMPLES = re.findall(r"^```rpl\n(.*?)^```", TEXT, re.DOTALL | re.MULTILINE)
NOT_SHOWN = {"BNOT", "BXOR", "BOR", "BAND", "XOR", "QUO", "CROSS", "OR_ELSE", "PATH_KIND", "PLUS"}


@pytest.mark.parametrize("number", range(len(EXAMPLES)))
def test_examples_are_read(number: int) -> None:
    diagnostics = Diagnostics()
    program = registry.dialect("rpl").read([source_from_text("page.rpl", EXAMPLES[number])], diagnostics).program
    assert [item.as_text() for item in diagnostics] == []
    verify(program, diagnostics)
    normal = normalise(program, diagnostics)
    wrong = [item.as_text() for item in diagnostics if item.severity == Severity.ERROR]
    assert wrong == []
    text = registry.target("rpl").write(normal, WriteContext(diagnostics))[0].data.decode()
    assert registry.dialect("rpl").read([source_from_text("t.rpl", text)], diagnostics).program == normal


def test_tables_are_current() -> None:
    """Run tests/rpl/tables.py to bring them up to date."""
    assert with_tables(TEXT) == TEXT


def test_every_keyword_has_an_example() -> None:
    shown = "\n".join(re.sub(r"--.*", "", example) for example in EXAMPLES)
    missing = []
    for terminal in load_grammar("rpl.lark").terminals:
        if "i" not in terminal.pattern.flags or terminal.name in NOT_SHOWN:
            continue
        if not re.search(rf"\b{terminal.pattern.to_regexp()}", shown):
            missing.append(terminal.name)
    assert " ".join(missing) == ""
