"""The generated executable programs are sound: well built, well typed, ending, and the same after RPL."""

from __future__ import annotations

import sys
from pathlib import Path

from hypothesis import HealthCheck, given, settings

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir.verify import verify
from rpl.passes.typing import normalise
from rpl.source import source_from_text
from rpl.writing.target import WriteContext

sys.path.insert(0, str(Path(__file__).resolve().parent))
from oracle import expected_outputs
from programs import executable_programs

slow = (HealthCheck.too_slow, HealthCheck.data_too_large)


@settings(max_examples=60, deadline=None, suppress_health_check=slow, derandomize=True)
@given(executable_programs())
def test_generated_programs_are_sound(program: ir.Program) -> None:
    diagnostics = Diagnostics()
    assert verify(program, diagnostics), [item.as_text() for item in diagnostics]
    normal = normalise(program, diagnostics)
    assert [item.as_text() for item in diagnostics] == []
    outputs = expected_outputs(program)
    assert len(outputs) == 4 + 9 * 8
    text = registry.target("rpl").write(normal, WriteContext(diagnostics))[0].data.decode()
    again = registry.dialect("rpl").read([source_from_text("t.rpl", text)], diagnostics).program
    assert again == normal
    assert expected_outputs(again) == outputs
