"""Arcs on which the tool stays as it is to the arc: languages without them get the end orientation worked out."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """def main():
  movej([0, -1.8, -1.9, -1.0, 1.57, 0.8], a=1.4, v=1.05)
  movel(pose_trans(get_actual_tcp_pose(), p[0, 0, 0.02, 0, 0, 0]), v=0.1{blend})
  here = get_actual_tcp_pose()
  movec(pose_trans(here, p[{via}]), pose_trans(here, p[{end}, 0, 0, 0.3]), a=0.8, v=0.1, r=0, mode=1)
  movel(pose_trans(get_actual_tcp_pose(), p[0.02, 0, 0, 0, 0, 0]), v=0.1)
end
"""
ARCS = [
    ("0.03, 0.03, 0, 0, 0, 0", "0.06, 0, 0"),
    ("0.01, 0.03, 0.01, 0, 0, 0", "0.02, 0.04, 0.03"),
    ("0.04, 0.04, 0, 0, 0, 0", "0.01, 0.03, 0"),
]


def _translated(text: str, target: str) -> tuple[object, object, Diagnostics]:
    read = read_sources([source_from_text("p.script", text)], "urscript", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, "ur5e", None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = prove_programs(read.program, back.program, "ur5e", entry="main", to_entry=entry_name(back.program))
    return result.equal, result.as_text(), diagnostics


CASES = [
    *((target, via, end) for target in ("tp", "vplus") for via, end in ARCS),
    ("rapid", "0.03, 0.005, 0, 0, 0, 0", "0.06, 0, 0"),  # further round, the quadrant that CRobT tells no longer holds
]


@pytest.mark.parametrize(("target", "via", "end"), CASES)
def test_the_tool_turns_with_the_arc(target: str, via: str, end: str) -> None:
    equal, text, diagnostics = _translated(PROGRAM.format(blend="", via=via, end=end), target)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert equal, text


def test_a_start_that_is_passed_is_named() -> None:
    via, end = ARCS[0]
    text = PROGRAM.format(blend=", r=0.01", via=via, end=end)
    _, _, diagnostics = _translated(text, "tp")
    assert "constant-orientation-lost" in {item.code.name for item in diagnostics}
