"""Programs whose poses are computed mean the same in languages that know no rotation vectors, metres or radians."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """def poses():
  a = p[0.1, 0.2, 0.3, 0.4, -0.2, 0.9]
  b = p[-0.3, 0.1, 0, 2.1, 0.3, -1.7]
  turn = 0.7
  c = p[turn, 0, 0, turn / 2, turn, -turn]
  half = interpolate_pose(a, b, 0.5)
  sum = pose_add(a, c)
  rest = pose_sub(sum, c)
  angles = rotvec2rpy([turn, 0.1, 0.2])
  back = rpy2rotvec([angles[0], angles[1], angles[2]])
  set_digital_out(0, norm(half[0] + 0.1) < 0.0001 and norm(half[2] - 0.15) < 0.0001)
  set_digital_out(1, norm(c[3] - 0.35) < 0.0001 and norm(c[5] + 0.7) < 0.0001)
  set_digital_out(2, norm(sum[0] - 0.8) < 0.0001 and norm(rest[0] - 0.1) < 0.0001)
  set_digital_out(3, norm(back[0] - turn) < 0.0001 and norm(back[2] - 0.2) < 0.0001)
  list = [turn, 2, 3]
  list[1] = list[0] * 2
  set_digital_out(4, norm(list[1] - 1.4) < 0.0001 and list[2] == 3)
  set_digital_out(5, norm(pose_dist(a, a)) < 0.0001)
end
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "rpl"])
def test_computed_poses(target: str) -> None:
    source = source_from_text("poses.script", PROGRAM)
    program = read_sources([source], "urscript", Diagnostics())
    diagnostics = Diagnostics()
    result = translate_program(program, target, "ur5e", diagnostics=diagnostics)
    assert not diagnostics.has_losses, [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    written = [source_from_bytes(file.path, file.data) for file in result.files]
    again = read_sources(written, target, Diagnostics())
    proof = prove_programs(
        program.program, again.program, "ur5e", entry="poses", to_entry=result.renamed.get("poses", "poses")
    )
    assert proof.agrees, proof.difference
