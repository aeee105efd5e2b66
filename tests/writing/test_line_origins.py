"""Lines of written files know the statement of the source that they come from."""

from pathlib import PurePath

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import Translation, translate_program
from rpl.writing.lineorigins import text_lines

PROGRAM = """DEF cell()
DECL INT i
; the first place
PTP {A1 0,A2 -90,A3 90,A4 0,A5 10,A6 0}
FOR i = 1 TO 3
  $OUT[1] = TRUE
  IF $IN[2] THEN
    WAIT SEC 0.5
  ENDIF
  $OUT[1] = FALSE
ENDFOR
$OUT[7] = TRUE
END
"""


def translated(target: str, text: str = PROGRAM) -> Translation:
    source = source_from_text("cell.src", text)
    read = read_sources([source], "krl", Diagnostics())
    return translate_program(read, target, "kuka_kr6r900sixx")


def lines_of(translation: Translation, number: int) -> list[str]:
    """The lines that come from this line of the source, without blanks at their sides."""
    origins = translation.line_origins()
    return [
        text.strip()
        for file in translation.files
        for text, origin in zip(text_lines(file), origins[file.path], strict=True)
        if origin is not None and origin.source is not None and origin.line == number
    ]


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript", "vplus", "rpl", "val3"])
def test_each_statement_has_its_lines(target: str) -> None:
    translation = translated(target)
    origins = translation.line_origins()
    assert all(len(origins[file.path]) == len(text_lines(file)) for file in translation.files)
    assert all(lines_of(translation, number) for number in (4, 5, 6, 7, 8, 10, 12))
    assert any("7" in line or "6" in line for line in lines_of(translation, 12))
    assert not any("0.5" in line for number in (6, 7, 10, 12) for line in lines_of(translation, number))


def test_the_end_of_a_block_belongs_to_its_head() -> None:
    translation = translated("rapid")
    assert [line for line in lines_of(translation, 7) if line == "ENDIF"]
    assert [line for line in lines_of(translation, 5) if line in ("ENDFOR", "ENDWHILE")]


def test_what_stands_behind_the_statements_comes_from_none() -> None:
    assert not any("J1" in line or line.startswith("/") for line in lines_of(translated("tp"), 12))


def test_remarks_of_the_source_that_look_like_marks_are_remarks() -> None:
    text = PROGRAM.replace("; the first place", "; see @1@ and @99999@")
    origins = translated("rapid", text).line_origins()
    assert {PurePath(path).suffix for path in origins} <= {".mod"}
    assert len(lines_of(translated("rapid", text), 12)) == len(lines_of(translated("rapid"), 12)) == 1
