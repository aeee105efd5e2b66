"""Remarks on their way to another controller: those at declarations stay where data have numbers only, those of the
source's editor go."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """MODULE demo

-- what this is for, in one sentence of some length
VAR limit: INT = 4
-- what is counted
VAR n: INT = 0 -- at its line

PROCEDURE main()
    -- first of all
    n = limit
    SET do[1] TO n = 4 -- behind it
END PROCEDURE
"""
FOLDED = """DEF demo()
;FOLD INI
;an own remark
;ENDFOLD (INI)
;FOLD OUT 1 'lamp' State=TRUE;%{PE}%R 8.3.32,%MKUKATPBASIS,%COUT,%VOUTX,%P 2:1, 3:lamp
$OUT[1] = TRUE
;ENDFOLD
END
"""


def _written(text: str, name: str, source: str, target: str) -> str:
    read = read_sources([source_from_text(name, text)], source, Diagnostics())
    written = translate_program(read, target, "kuka_kr6r900sixx", None, Diagnostics())
    return "".join(file.data.decode("ascii") for file in written.files)


def _said(written: str) -> str:
    """The words of all remarks in a row; controllers with short lines cut them."""
    lines = (line.partition("!" if " ;" in line else "'")[2] for line in written.splitlines())
    return " ".join(" ".join(lines).replace(";", " ").split())


@pytest.mark.parametrize("target", ["tp", "inform"])
def test_remarks_at_declarations_stay(target: str) -> None:
    said = _said(_written(PROGRAM, "demo.rpl", "rpl", target))
    places = [
        said.index(part)
        for part in (
            "what this is for, in one sentence of some length",
            "what is counted",
            "n: at its line",
            "first of all",
            "behind it",
        )
    ]
    assert places == sorted(places)


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform"])
def test_folds_mean_nothing_elsewhere(target: str) -> None:
    written = _written(FOLDED, "demo.src", "krl", target)
    assert "an own remark" in written
    assert "FOLD" not in written and "%R" not in written


@pytest.mark.parametrize("target", ["krl", "rpl"])
def test_folds_come_back(target: str) -> None:
    assert "FOLD INI" in _written(FOLDED, "demo.src", "krl", target)
