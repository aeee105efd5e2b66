"""SPEED without ALWAYS counts for the next motion; in front of a program that moves it is refused for other targets."""

from __future__ import annotations

import pytest

from tests.refusing import refused

PROGRAM = """.PROGRAM main()
 SPEED 30
 CALL travel()
 SPEED 20
 MOVE #here
.END
.PROGRAM travel()
 MOVE #there
.END
.LOCATIONS
#here 0 -90 180 0 10 0
#there 10 -90 180 0 10 0
.END
"""


@pytest.mark.parametrize("target", ["rapid", "krl", "tp", "urscript", "inform"])
def test_refused_in_front_of_a_call(target: str) -> None:
    assert refused(PROGRAM, "vplus", target, "adept_viper_s650") == [("next-move-uncertain", 2)]
