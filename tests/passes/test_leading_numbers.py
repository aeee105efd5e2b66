"""Numbers at the beginning of a text (V+ VAL) in every language; none is 0."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

TEXTS = {
    "12.5mm": 12.5,
    "  -3.25E2x": -325.0,
    "+7,8": 7.0,
    ".5": 0.5,
    "1e-2": 0.01,
    "37.25": 37.25,
    "": 0.0,  # M: without a number VAL gives 0
    "abc": 0.0,
    "2E": 2.0,
}
BASES = {"^H1F ": 31.0, "^B1012": 5.0, "^17": 15.0}


def program(texts: dict[str, float]) -> str:
    checks = [
        f'$t = "{text}"\nIF VAL($t) == {number} THEN\nn = n+1\nEND\nIF VAL("{text}") == {number} THEN\nn = n+1\nEND'
        for text, number in texts.items()
    ]
    return "\n".join([".PROGRAM main()", "n = 0", *checks, f"IF n == {2 * len(texts)} THEN", "SIGNAL 1", "END", ".END"])


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "inform", "vplus", "rpl"])
def test_texts_are_read_as_far_as_the_number_goes(target: str) -> None:
    texts = TEXTS if target == "tp" else TEXTS | BASES
    source = read_sources([source_from_text("main.v2", program(texts))], "vplus", Diagnostics())
    assert run_program(source.program, "adept_viper_s650", None, "main").outputs
    found = Diagnostics()
    translation = translate_program(source, target, "adept_viper_s650", None, found)
    assert not [item.as_text() for item in found.of(Severity.LOSS) if item.code.name != "tp-text-case"]
    files = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(files, target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and len(result.outputs) == 1
