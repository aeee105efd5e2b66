"""Signals by computed numbers: what calls hand to a routine is in reach of the routine that is generated for them."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

TEXT = """.PROGRAM main()
 AUTO ok
 CALL wait.sig({number}, 0.5, ok)
.END
.PROGRAM wait.sig(sig.no, limit, ok)
 TIMER 3 = 0
 WAIT SIG(sig.no) OR (TIMER(3) > limit)
 ok = SIG(sig.no)
 TYPE "waited for", sig.no
.END
"""


@pytest.mark.parametrize(("number", "last"), [(1005, 32), (1036, 36), (1200, 200), (9000, 32)])
def test_numbers_that_calls_pass(number: int, last: int) -> None:
    """Inputs 1001 ... are inputs 1 ...; a number that no controller has counts for nothing."""
    read = read_sources([source_from_text("main.v2", TEXT.format(number=number))], "vplus", Diagnostics())
    files = translate_program(read, "rapid", None, None, Diagnostics()).files
    text = "".join(one.data.decode() for one in files)
    assert f"RETURN di{last}=1" in text and f"RETURN di{last + 1}=1" not in text
