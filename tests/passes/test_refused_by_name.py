"""Constructs that no rewriting serves: each is named at its line, and the target's own stop stands there."""

from __future__ import annotations

import pytest

from tests.refusing import refused

VIPER, KUKA, ABB, UR = "adept_viper_s650", "kuka_kr6r900sixx", "abb_irb1200_5_90", "ur10e"
RANDOM = """.PROGRAM main()
 SIGNAL 1
 IF RANDOM < 0.5 THEN
 SIGNAL 2
 END
.END
"""


@pytest.mark.parametrize(
    ("program", "source", "arm", "lost", "targets"),
    [
        (RANDOM, "vplus", VIPER, [("random-numbers-lost", 3)], "rapid tp inform"),
    ],
)
def test_the_construct_is_named_at_its_line(
    program: str, source: str, arm: str, lost: list[tuple[str, int]], targets: str
) -> None:
    for target in targets.split():
        assert refused(program, source, target, arm) == lost, target
