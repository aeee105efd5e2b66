"""Conditions of many parts are put together in several lines where one is too short."""

from __future__ import annotations

import pytest

from .helpers import means_the_same

PARTS = " AND ".join(f"measured_value_{n} * {n} < highest_value_{n}" for n in range(1, 10))
EITHER = " OR ".join(f"measured_value_{n} > highest_value_{n} + {n}" for n in range(1, 9))
DATA = "".join(f"VAR measured_value_{n}: REAL = {n}.0\nVAR highest_value_{n}: REAL = {n * n}.5\n" for n in range(1, 10))
PROGRAM = f"""{DATA}
PROCEDURE main()
    VAR good: BOOL
    SET do[1] TO {PARTS}
    good = NOT ({EITHER})
    IF good AND {PARTS} THEN
        SET do[2] TO ON
    ELSE
        SET do[3] TO ON
    END IF
    measured_value_8 = 100.0
    IF {PARTS} THEN
        SET do[4] TO ON
    END IF
    SET do[5] TO {EITHER}
END PROCEDURE
"""


@pytest.mark.parametrize("target", ["tp", "inform", "vplus"])
def test_long_conditions(target: str) -> None:
    means_the_same(PROGRAM, target)
