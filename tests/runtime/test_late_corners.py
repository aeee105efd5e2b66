"""A fly-by point whose next move comes too late: RAPID makes a stop point of it and logs 50024, Corner path failure.

Source: ABB RAPID Reference Manual, overview 5, 3.2: the program goes on about 0.1 s before the zone, which planning the
corner takes. The number and name of the event: published logs of controllers (M: its conditions).
"""

from __future__ import annotations

import numpy as np
import pytest
from helpers import ABB, moves, run

from rpl.runtime.trace import RunResult

HEAD = """MODULE m
VAR num n:=0;
CONST robtarget p0:=[[400,-100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p1:=[[400,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p2:=[[500,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
ConfJ\\Off; ConfL\\Off;
MoveJ p0,v200,fine,tool0;
"""


def warnings(*lines: str) -> tuple[list[tuple[str, int]], RunResult]:
    """Codes and lines of the warnings; the statements begin in line 9."""
    result = run("rapid", HEAD + "\n".join(lines) + "\nENDPROC\nENDMODULE\n", ABB)
    assert result.status == "finished", result.fault
    return [(str(e.data["code"]), e.origin.line) for e in result.trace if e.kind == "warning"], result


def closest(result: RunResult) -> float:
    """How near the path comes to p1, mm."""
    near = np.inf
    for leg in (leg for event in moves(result)[1:] for leg in event.legs):
        points = leg.plan.tcp_at(leg.offset_s + np.linspace(0.0, leg.duration_s, 400))[:, :3, 3]
        near = min(near, float(np.linalg.norm(points - [400, 0, 400], axis=1).min()))
    return near


LATE = [("corner-path-failure", 9)]
CASES: list[tuple[tuple[str, ...], list[tuple[str, int]]]] = [
    (("MoveL p1,v100,z20,tool0;", "WaitTime 0.5;", "MoveL p2,v100,fine,tool0;"), LATE),
    (("MoveL p1,v100,z20,tool0;",), LATE),  # no next move at all
    (("MoveL p1,v100,z20,tool0;", "n:=n+1;", "MoveL p2,v100,fine,tool0;"), []),
    (("MoveL p1,v100,fine,tool0;", "WaitTime 0.5;", "MoveL p2,v100,fine,tool0;"), []),
    (("MoveL p1,v100,z20,tool0;", "WaitTime\\InPos,0;", "MoveL p2,v100,fine,tool0;"), LATE),
]


@pytest.mark.parametrize(("lines", "expected"), CASES)
def test_a_late_next_move_is_a_stop_point_and_a_warning(
    lines: tuple[str, ...], expected: list[tuple[str, int]]
) -> None:
    found, result = warnings(*lines)
    assert found == expected
    assert (closest(result) < 1e-6) == (bool(expected) or "fine" in lines[0])
    assert moves(result)[1].stops == (bool(expected) or "fine" in lines[0])


def test_other_controllers_log_nothing() -> None:
    text = (
        "def p():\n  movej([0,-1.57,1.57,-1.57,-1.57,0])\n"
        "  movel(p[0.4,-0.3,0.3,0,3.14,0], v=0.1, r=0.02)\n  sleep(1)\nend\n"
    )
    result = run("urscript", text, "ur5e")
    assert result.status == "finished" and not [e for e in result.trace if e.kind == "warning"]
