"""Groups of signals that are no OG# or OGH# are written and read bit by bit."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

FORMS = {
    "vplus": (
        "t.v2",
        ".PROGRAM t()\n BITS 17,2 = 2\n BITS 3,5 = 19\n n = BITS(3,5)\n IF (BITS(17,2) == 2) AND (n == 19) THEN\n"
        "  SIGNAL 30\n END\n.END\n",
    ),
    "krl": (
        "t.src",
        "DEF T()\nINT N\nSIGNAL LOW $OUT[17] TO $OUT[18]\nSIGNAL KIND $OUT[3] TO $OUT[7]\nLOW=2\nKIND=19\nN=KIND\n"
        "WAIT FOR LOW==2\nIF N==19 THEN\n$OUT[30]=TRUE\nENDIF\nEND\n",
    ),
}


@pytest.mark.parametrize("language", FORMS)
def test_groups_of_any_place(language: str) -> None:
    name, text = FORMS[language]
    read = read_sources([source_from_text(name, text)], language, Diagnostics())
    diagnostics = Diagnostics()
    translation = translate_program(read, "inform", None, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "inform", Diagnostics())
    result = run_program(back.program, None, None, "T")
    on = {name for _, name, value in result.outputs if value}
    assert result.status == "finished"
    assert on == {f"OT#({n})" for n in (3, 4, 7, 18, 30)}
