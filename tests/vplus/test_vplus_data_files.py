"""Files that hold data of a program (.lc, .re) and the program make one file in another language, with all of it."""

from pathlib import Path

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_program
from rpl.translation import translate_program

PROJECT = Path(__file__).parents[2] / "samples" / "vplus" / "project"


@pytest.mark.parametrize("target", ["krl", "rapid"])
def test_data_of_several_files_is_in_one(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_program([PROJECT], None, diagnostics)
    files = translate_program(read, target, "ur5e", None, diagnostics).files
    assert not [item for item in diagnostics.of(Severity.ERROR) if item.code.name == "same-output-file"]
    assert len({file.path.lower() for file in files}) == len(files)
    text = b"\n".join(file.data for file in files).lower()
    for name in (b"station_count", b"put_down", b"stations"):
        assert name in text
