"""Listings that end too early are said to; whole ones are not."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text

LISTING = "/PROG  A\n/ATTR\n/MN\n   1:  DO[1]=ON ;\n   2:  DO[2]=ON ;\n/POS\n/END\n"


@pytest.mark.parametrize(("length", "cut"), [(len(LISTING), False), (30, True), (len(LISTING) - 6, True)])
def test_a_listing_without_its_end(length: int, cut: bool) -> None:
    diagnostics = Diagnostics()
    read_sources([source_from_text("a.ls", LISTING[:length])], "tp", diagnostics)
    assert ("tp-cut-off" in [item.code.name for item in diagnostics]) == cut
