"""The sign of a number, and turned offsets in the tool, in every target."""

from __future__ import annotations

import pytest

from .helpers import means_the_same

PROGRAM = """PROCEDURE main()
    VAR x: REAL = -4.0
    VAR a: POSE
    VAR turn: REAL = 30.0
    SET do[1] TO sign(x) = -1 AND sign(-x) = 1 AND sign(0.0) = 0
    a = {x: 420, y: -80, z: 320, a: 0, b: 180, c: 0}
    MOVE TO a
    MOVE LINEAR TO tool_offset(a, 0, 0, -20, 10, -15, turn)
END PROCEDURE
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus", "inform", "tp"])
def test_signs_and_turns(target: str) -> None:
    means_the_same(PROGRAM, target)
