"""Jobs that end too early are said to; whole ones are not."""

from __future__ import annotations

import pytest
from inform_helpers import job, read

WHOLE = job("DOUT OT#(1) ON\nDOUT OT#(2) ON")


@pytest.mark.parametrize(("text", "cut"), [(WHOLE, False), (WHOLE[: -len("END\n")], True), (WHOLE[:-1], False)])
def test_a_job_without_its_end(text: str, cut: bool) -> None:
    _, diagnostics = read(text)
    assert ("inform-cut-off" in [item.code.name for item in diagnostics]) == cut
