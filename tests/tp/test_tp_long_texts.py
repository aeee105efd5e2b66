"""Texts of more pieces than one plain line joins: they are put together in steps."""

from __future__ import annotations

import re

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SHORT = '$r = "<"+$a+"/"+$b+"/"+$a'
LONG = '$r = "<"+$a+"/"+$b+"/"+$a+"/"+$b+"/"+$a+"/"+$b+"/"+$a+"/"+$b+">"'
NUMBERS = '$r = $ENCODE("Kit ",$a,": ",/I2,k," kinds, ",/F7.1,w," g")'
ITSELF = '$r = "r"\n $r = $a+"/"+$b+"/"+$a+"/"+$r+"/"+$r'
FORMS = {
    "short": (SHORT, "<one/two/one", 0),
    "long": (LONG, "<one/two/one/two/one/two/one/two>", 3),
    "numbers": (NUMBERS, "Kit one:  3 kinds,   532.5 g", 1),
    "itself": (ITSELF, "one/two/one/r/r", 1),
}


@pytest.mark.parametrize("form", FORMS)
def test_a_text_of_many_pieces(form: str) -> None:
    lines, text, steps = FORMS[form]
    program = (
        f'.PROGRAM t()\n $a = "one"\n $b = "two"\n k = 3\n w = 532.5\n {lines}\n'
        f' IF $r == "{text}" THEN\n  SIGNAL 1\n END\n.END\n'
    )
    read = read_sources([source_from_text("t.v2", program)], "vplus", Diagnostics())
    diagnostics = Diagnostics()
    files = translate_program(read, "tp", None, None, diagnostics).files
    assert {one.code.name for one in diagnostics.of(Severity.LOSS)} <= {"tp-text-case"}
    assert len(re.findall(r":step\d*\]=", files[0].data.decode())) == steps
    back = read_sources([source_from_bytes(f.path, f.data) for f in files], "tp", Diagnostics())
    assert [value for _, _, value in run_program(back.program, None, None, "T").outputs] == [True]
