"""Functions that few targets have, in terms of what they have."""

from __future__ import annotations

import pytest

from .helpers import means_the_same

PROGRAM = """VAR x: REAL = 2.5
VAR name: STRING[40] = "cover"
PROCEDURE main()
    SET do[1] TO abs(log10(x) - 0.39794) < 0.001
    SET do[3] TO to_code("A") = 65
    SET do[2] TO text_capacity(name) = 40 AND text_length(name) = 5
END PROCEDURE
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus", "inform", "tp"])
def test_rare_functions(target: str) -> None:
    means_the_same(PROGRAM, target)
