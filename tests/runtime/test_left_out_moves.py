"""Moves that a controller leaves out. Source: URScript Manual 5.2, movej: if the blend region of a move overlaps with
the blend radius of previous or following waypoints, this move is skipped, with a warning. M: of two the later one.
"""

from __future__ import annotations

import numpy as np
import pytest
from helpers import moves, run

UR = "ur5e"


def program(*moves: str) -> str:
    """A start in joints; the moves from line 4 on."""
    start = "  movej([0.0,-1.57,1.57,-1.57,-1.57,0])\n  movel(p[0.4,-0.2,0.3,0,3.14,0], v=0.1)\n"
    return "def prog():\n" + start + "".join(f"  movel(p[{move}, v=0.1{r}\n" for move, _, r in _parts(moves)) + "end\n"


def _parts(texts: tuple[str, ...]) -> list[tuple[str, str, str]]:
    found = []
    for text in texts:
        x, y, radius = text.split()
        found.append((f"{x},{y},0.3,0,3.14,0]", "", f", r={radius})"))
    return found


# Moves (x, y, radius in m); lines of those that are left out.
CASES: list[tuple[tuple[str, ...], list[int]]] = [
    (("0.4 -0.1 0.05", "0.4 -0.04 0.05", "0.5 0.1 0"), [5]),
    (("0.4 -0.1 0.03", "0.4 -0.04 0.03", "0.5 0.1 0"), []),  # they touch
    (("0.4 -0.1 0.05", "0.4 -0.04 0", "0.5 0.1 0"), []),
    (("0.4 -0.1 0", "0.4 -0.04 0.05", "0.5 0.1 0"), []),
    (("0.4 -0.1 0.05", "0.4 -0.04 0.05", "0.4 0.0 0.05", "0.5 0.1 0"), [5]),  # 100 mm from the first to the third
    (("0.4 -0.1 0.05", "0.4 -0.04 0.05", "0.4 -0.02 0.05", "0.5 0.1 0"), [5, 6]),
]


@pytest.mark.parametrize(("lines", "left_out"), CASES)
def test_a_move_whose_blend_overlaps_is_left_out(lines: tuple[str, ...], left_out: list[int]) -> None:
    result = run("urscript", program(*lines), UR)
    assert result.status == "finished", result.fault
    warned = [(e.data["code"], e.origin.line) for e in result.trace if e.kind == "warning"]
    assert warned == [("overlapping-blends", line) for line in left_out]
    made = [event.origin.line for event in moves(result)]
    assert made == [line for line in range(2, 4 + len(lines)) if line not in left_out]


def test_the_robot_goes_straight_on_to_the_move_behind() -> None:
    """From the first corner the way leads to the last point, 5 mm beside the one that is left out."""
    result = run("urscript", program("0.4 -0.1 0.05", "0.46 -0.1 0.05", "0.52 -0.08 0"), UR)
    last = moves(result)[-1]
    points = np.concatenate(
        [leg.plan.tcp_at(leg.offset_s + np.linspace(0.0, leg.duration_s, 200))[:, :3, 3] for leg in last.legs]
    )
    way = np.array([120.0, 20.0]) / np.hypot(120.0, 20.0)
    off = (points[:, :2] - [520.0, -80.0]) @ np.array([-way[1], way[0]])
    assert np.abs(off).max() < 1e-6
    assert np.linalg.norm(points[0, :2] - [400.0, -100.0]) == pytest.approx(50.0, abs=0.01)
