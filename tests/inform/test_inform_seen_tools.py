"""Where the robot is, seen with the tool that the source has set: a job sees it with the tool of its own moves."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

HOME = "[0, -1.5708, 1.5708, -1.5708, -1.5708, 0]"
HEAD = f"def job():\n  set_tcp(p[0, 0, 0.1, 0, 0, 0])\n  movej({HOME})\n"
LONGER = "set_tcp(p[0, 0, 0.15, 0, 0, 0])\n"
FORMS = [
    f"one = get_actual_tcp_pose()\n{LONGER}other = get_actual_tcp_pose()\nway = point_dist(one, other) - 0.05",
    f"{LONGER}place = get_forward_kin({HOME})\nway = point_dist(place, get_actual_tcp_pose())",
    f"one = get_actual_tcp_pose()\n{LONGER}place = get_forward_kin({HOME})\nway = point_dist(place, one) - 0.05",
    f"{LONGER}there = pose_trans(get_actual_tcp_pose(), p[0, 0, -0.05, 0, 0, 0])\nmovel(there)\n"
    "way = point_dist(get_actual_tcp_pose(), there)",
]


@pytest.mark.parametrize("body", FORMS)
def test_the_tool_of_the_moment(body: str) -> None:
    lines = [*body.splitlines(), "if norm(way) < 0.0005:", "  set_standard_digital_out(0, True)", "end"]
    text = HEAD + "".join(f"  {line}\n" for line in lines) + "end\n"
    source = read_sources([source_from_text("job.script", text)], "urscript", Diagnostics())
    assert run_program(source.program, "ur5e").outputs
    diagnostics = Diagnostics()
    translation = translate_program(source, "inform", "ur5e", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "inform", Diagnostics())
    result = run_program(back.program, "ur5e", None, "JOB")
    assert result.status == "finished" and result.outputs
