"""Angles about z, new y, new z, and BOOLs as 0 and -1, for targets that know neither: the same numbers."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rpl.passes.legalise.source.places.rotationvectors import rotation_vectors
from rpl.passes.legalise.statements.calls import rewrite_calls

from .executed import EVERYTHING, context, passed, read, run

NO_ZYZ = replace(
    EVERYTHING, functions=EVERYTHING.functions - {"zyz_yaw", "zyz_pitch", "zyz_roll", "pose_zyz", "rotation_angle"}
)
NO_BITS = replace(EVERYTHING, conversions=EVERYTHING.conversions - {"minus_bit", "bit", "floor", "truth"})
ANGLES = [
    (0, 0, 0), (30, 0, 40), (30, 180, 40), (0, 180, 0), (0, 90, 0), (-170, 35, 120), (10, 90, -20),
    (0, 0.5, 0), (90, 179.5, 90), (180, 45, 180), (-45, 120, 5),
]  # fmt: skip


def numbers(text: str) -> list[float]:
    return [float(word) for word in text.split()]


@pytest.mark.parametrize("angles", ANGLES)
def test_zyz_angles(angles: tuple[float, float, float]) -> None:
    program = read(f"""
MODULE m
    PROCEDURE main()
        VAR p: POSE
        VAR q: POSE
        VAR yaw, pitch, roll: REAL
        yaw = {angles[0]}
        pitch = {angles[1]}
        roll = {angles[2]}
        p = pose_zyz(1, 2, 3, yaw, pitch, roll)
        q = pose_zyz(1, 2, 3, {angles[0]}, {angles[1]}, {angles[2]})
        MESSAGE number_text(zyz_yaw(p), 4) & " " & number_text(zyz_pitch(p), 4) & " " & number_text(zyz_roll(p), 4)
        MESSAGE number_text(zyz_yaw(q), 4) & " " & number_text(zyz_pitch(q), 4) & " " & number_text(zyz_roll(q), 4)
        MESSAGE number_text(p.x + p.y + p.z, 4) & " " & number_text(rotation_angle(p, q), 4)
    END PROCEDURE
END MODULE
""")
    after = passed(program, (rotation_vectors,), context(program, NO_ZYZ))
    wanted, found = run(program).messages, run(after).messages
    assert len(found) == 3
    for one, other in zip(wanted, found, strict=True):
        difference = [a - b for a, b in zip(numbers(one), numbers(other), strict=True)]
        assert all(abs((d + 180.0) % 360.0 - 180.0) < 2e-4 for d in difference), (wanted, found)


TRUTHS = """.PROGRAM main()
        AUTO REAL n, m
        n = 3
        m = (n == 3)*2
        IF m == -2 THEN
            SIGNAL 1
        END
        IF (n > 2) == -1 THEN
            SIGNAL 2
        END
        IF 0 == (n > 5) THEN
            SIGNAL 3
        END
        IF (n > 2) == (m < 0) THEN
            SIGNAL 4
        END
        m = n > 7
        IF m == FALSE THEN
            SIGNAL 5
        END
        IF n-3 THEN
            SIGNAL 6
        END
        m = 2+(SIG(1) AND SIG(2))
        IF m == 1 THEN
            SIGNAL 7
        END
.END
"""


def test_truth_as_numbers() -> None:
    program = read(TRUTHS, "vplus")
    after = rewrite_calls(program, context(program, NO_BITS))
    wanted = {(name, value) for _, name, value in run(program).outputs}
    assert len(wanted) == 6
    assert {(name, value) for _, name, value in run(after).outputs} == wanted
