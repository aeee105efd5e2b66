"""Questions that a target cannot ask are refused by a name of their own."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

KEYS = 'ASK "Go on?" INTO answer KEYS ("Yes", "No")'
NUMBER = 'ASK "How many?" INTO answer KIND number'
PROGRAM = "VAR answer: INT = 0\nPROCEDURE main()\n    {question}\n    SET do[1] TO answer > 2\nEND PROCEDURE\n"


@pytest.mark.parametrize(
    ("target", "question", "lost"),
    [
        ("tp", KEYS, "tp-dialog-lost"),
        ("tp", NUMBER, "tp-dialog-lost"),
        ("krl", NUMBER, "krl-dialog-lost"),
        ("krl", KEYS, None),
        ("rapid", NUMBER, None),
        ("urscript", NUMBER, None),
        ("vplus", NUMBER, None),
    ],
)
def test_what_is_lost_has_a_name(target: str, question: str, lost: str | None) -> None:
    diagnostics = Diagnostics()
    text = PROGRAM.replace("{question}", question)
    read = read_sources([source_from_text("main.rpl", text)], "rpl", diagnostics)
    translate_program(read, target, None, None, diagnostics)
    assert [item.code.name for item in diagnostics.of(Severity.LOSS)] == ([lost] if lost else [])
