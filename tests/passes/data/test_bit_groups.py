"""Groups of signals bit by bit: the same numbers go in and out."""

from __future__ import annotations

from dataclasses import replace

from rpl.passes.legalise.bitgroups import groups_to_bits

from .executed import EVERYTHING, context, passed, read, run

SINGLE = replace(EVERYTHING, signal_groups=False)
PROGRAM = """.PROGRAM main()
        AUTO REAL n
        BITS 3,4 = 10
        n = BITS(3,4)
        TYPE n
        BITS 3,4 = INT((n+1)/2)
        IF (BITS(3,4) == 5) AND SIG(3,-4) THEN
            TYPE "five"
        END
        TYPE BITS(4,3)
        BITS 5 = 1
        TYPE BITS(3,3)
.END
"""


def test_the_same_numbers() -> None:
    program = read(PROGRAM, "vplus")
    after = passed(program, (groups_to_bits,), context(program, SINGLE))
    wanted = run(program).messages
    assert len(wanted) == 4
    assert run(after).messages == wanted
    assert not any("to" in name for _, name, _ in run(after).outputs)
