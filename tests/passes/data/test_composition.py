"""Products and inverses of poses by components give the same poses."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st
from rpl.postprocessors.tp.passes.composition import compositions

from .executed import EVERYTHING, context, passed, read, run

TARGET = replace(
    EVERYTHING, operators=EVERYTHING.operators - {":"}, functions=EVERYTHING.functions - {"compose", "inverse"}
)
TEXT = """
MODULE m
    VAR p: POSE = {p}
    VAR q: POSE = {q}
    PROCEDURE main()
        VAR d: POSE
        VAR v: VECTOR
        VAR k: INT
        d = p : inverse(q) : p
        FOR k = 1 TO 2
            v = transform(d, {{x: 100, y: 20, z: 3}})
            MESSAGE number_text(v.x, 4) & " " & number_text(v.y, 4) & " " & number_text(v.z, 4)
            d = inverse(p : q)
        END FOR
    END PROCEDURE
END MODULE
"""
_ANGLES = st.one_of(st.sampled_from((0.0, 90.0, -90.0, 180.0, 45.0)), st.floats(-180.0, 180.0))
_POSES = st.tuples(*[st.floats(-500.0, 500.0)] * 3, _ANGLES, _ANGLES, _ANGLES)


def _written(pose: tuple[float, ...]) -> str:
    return "{" + ", ".join(f"{name}: {value:.6f}" for name, value in zip("xyzabc", pose, strict=True)) + "}"


def _numbers(messages: tuple[str, ...]) -> list[float]:
    return [float(word) for line in messages for word in line.split()]


@settings(max_examples=40, deadline=None)
@given(_POSES, _POSES)
def test_any_two_poses(p: tuple[float, ...], q: tuple[float, ...]) -> None:
    before = read(TEXT.format(p=_written(p), q=_written(q)))
    after = passed(before, (compositions,), context(before, TARGET))
    one, other = run(before, entry="main"), run(after, entry="main")
    assert one.status == other.status == "finished"
    for a, b in zip(_numbers(one.messages), _numbers(other.messages), strict=True):
        assert abs(a - b) < 2e-3
