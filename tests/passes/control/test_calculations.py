"""Calculating programs put out the same bits after all passes of control, for both kinds of target."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.capabilities import Capabilities
from rpl.passes.typing import normalise

from .common import PLAIN, RICH, same_run
from .test_generated import PASSES

sys.path.insert(0, str(Path(__file__).parents[2] / "ir"))
from programs import executable_programs


@pytest.mark.parametrize("capabilities", [PLAIN, RICH], ids=["plain", "rich"])
@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.differing_executors])
@given(data=st.data())
def test_programs_that_calculate(capabilities: Capabilities, data: st.DataObject) -> None:
    program: ir.Program = data.draw(executable_programs())
    same_run(normalise(program, Diagnostics()), capabilities, *PASSES)
