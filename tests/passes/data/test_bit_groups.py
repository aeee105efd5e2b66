"""Groups of signals bit by bit: the same numbers go in and out."""

from __future__ import annotations

from dataclasses import replace

import pytest

from postprocessors.tp.passes.bitgroups import groups_to_bits
from rpl import ir
from rpl.cell import parse_cell
from rpl.ir.walk import walk
from rpl.passes.capabilities import GroupRule
from rpl.passes.legalise.io.bitgroups import shared_groups_to_bits
from rpl.passes.legalise.io.signals import number_signals
from rpl.proof.prove import prove_programs
from rpl.proof.wiring import wired_bits

from .executed import EVERYTHING, context, passed, read, run

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
    after = passed(program, (groups_to_bits,), context(program, EVERYTHING))
    wanted = run(program).messages
    assert len(wanted) == 4
    assert run(after).messages == wanted
    assert not any("to" in name for _, name, _ in run(after).outputs)


NAMED = replace(
    EVERYTHING, io=replace(EVERYTHING.io, signal_prefixes={"digital_out": "do", "digital_in": "di", "group_out": "go"})
)
OVERLAP = """PROCEDURE main()
VAR n: INT
SET do[33 TO 36] TO 10
IF do[34] THEN SET do[1] TO ON
SET do[34] TO OFF
n = do[33 TO 36]
SET do[33 TO 36] TO n / 2
SET do[41 TO 44] TO 3
IF do[33 TO 36] = 4 THEN SET do[2] TO ON
SET do[50 TO 53] TO 6
SET do[52 TO 55] TO 6
WAIT UNTIL do[52 TO 55] = 6
END PROCEDURE
"""


def test_named_groups_that_share_signals_with_others_become_bits() -> None:
    program = read(OVERLAP)
    after = passed(program, (shared_groups_to_bits,), context(program, NAMED))
    groups = {str(one) for one in _groups(after)}
    assert groups == {"41-44"}
    wanted = [(name, value) for _, name, value in run(program).outputs]
    assert [(name, value) for _, name, value in run(after).outputs] == wanted
    assert ("do[2]", True) in wanted and ("do[1]", True) in wanted


def test_a_number_known_at_run_time_only_may_be_any_of_the_bits() -> None:
    program = read("PROCEDURE main(k: INT)\nSET do[k] TO ON\nSET do[3 TO 4] TO 1\nSET ao[k] TO 1\nEND PROCEDURE\n")
    assert not _groups(passed(program, (shared_groups_to_bits,), context(program, NAMED)))


def test_groups_stay_where_signals_have_numbers() -> None:
    program = read(OVERLAP)
    assert shared_groups_to_bits(program, context(program, EVERYTHING)) is program


def _groups(program: ir.Program) -> set[str]:
    found = set()
    for node in walk(*program.modules):
        if isinstance(node, ir.Signal) and isinstance(node.last, ir.IntLiteral):
            assert isinstance(node.index, ir.IntLiteral)
            found.add(f"{node.index.value}-{node.last.value}")
    return found


NUMBERED_GROUPS = """PROCEDURE main()
SET go[2] TO 5
SET do[3] TO ON
IF go[2] = 5 THEN SET do[9] TO ON
WAIT UNTIL gi[1] = 7
SET go[1] TO gi[1]
END PROCEDURE
"""


@pytest.mark.parametrize("numbered", [True, False])
def test_groups_with_numbers_of_their_own_get_free_bits(numbered: bool) -> None:
    program = read(NUMBERED_GROUPS)
    groups = EVERYTHING.io.groups - ({GroupRule.NUMBERED} if not numbered else frozenset())
    given = context(program, replace(EVERYTHING, io=replace(EVERYTHING.io, groups=groups)))
    after = passed(program, (number_signals,), given)
    found = {
        one.name: f"{one.signal.kind} {one.signal.index.value}-{one.signal.last.value}"  # type: ignore[union-attr]
        for module in after.modules
        for one in module.declarations
        if isinstance(one, ir.SignalDeclaration)
    }
    # Bytes in which the program switches nothing singly.
    chosen = {"go2": "digital_out 17-24", "go1": "digital_out 25-32", "gi1": "digital_in 1-8"}
    assert found == ({} if numbered else chosen)


NAMED_GROUPS = """MODULE t
  PROC t()
    SetGO goJob,5;
    SetGO go3,giType;
    SetDO do1,1;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(
    ("numbered", "expected"),
    [
        (False, {"goJob": (9, 16), "go3": (17, 24), "giType": (1, 8)}),
        (True, {"goJob": (1, None), "giType": (1, None)}),  # GO[1:goJob]; go3 is GO[3]
    ],
)
def test_named_groups_get_bits_or_a_number_of_their_own(
    numbered: bool, expected: dict[str, tuple[int, int | None]]
) -> None:
    program = read(NAMED_GROUPS, "rapid")
    groups = EVERYTHING.io.groups - ({GroupRule.NUMBERED} if not numbered else frozenset())
    given = context(program, replace(EVERYTHING, io=replace(EVERYTHING.io, groups=groups)))
    found = {}
    for module in number_signals(program, given).modules:
        for one in module.declarations:
            if isinstance(one, ir.SignalDeclaration) and isinstance(one.signal.index, ir.IntLiteral):
                last = one.signal.last
                found[one.name] = (one.signal.index.value, last.value if isinstance(last, ir.IntLiteral) else None)
    assert found == expected


def test_the_proof_knows_the_bits_of_a_group_that_has_a_name_only() -> None:
    program = read(NAMED_GROUPS, "rapid")
    given = context(
        program, replace(EVERYTHING, io=replace(EVERYTHING.io, groups=EVERYTHING.io.groups - {GroupRule.NUMBERED}))
    )
    assert wired_bits(number_signals(program, given))["gojob"] == "group_out:9-16"


def test_the_proof_knows_where_these_groups_are_wired() -> None:
    program = read(NUMBERED_GROUPS)
    after = passed(
        program,
        (number_signals,),
        context(
            program, replace(EVERYTHING, io=replace(EVERYTHING.io, groups=EVERYTHING.io.groups - {GroupRule.NUMBERED}))
        ),
    )
    other = replace(after, modules=tuple(replace(one, dialect="krl") for one in after.modules))
    cell = parse_cell('[[input]]\nsignal = "gi[1]"\nvalue = 7\ntime = 1.0\n')
    verdict = prove_programs(program, other, cell=cell)
    assert verdict.agrees, verdict.as_text()


WAITS = """PROCEDURE main()
VAR n: INT
n = 165
WAIT UNTIL di[17 TO 24] = 165
SET do[1] TO ON
WAIT UNTIL di[17 TO 24] = n
SET do[2] TO ON
WAIT UNTIL di[17 TO 24] <> 165
SET do[3] TO ON
WAIT UNTIL di[17 TO 24] = 0
SET do[4] TO ON
WAIT UNTIL di[17 TO 24] > 0 AND do[4]
SET do[5] TO ON
WAIT UNTIL di[17 TO 20] >= 7 OR di[24]
SET do[6] TO ON
WAIT UNTIL di[17 TO 20] <> 16
SET do[7] TO ON
END PROCEDURE
"""
# Input, from when to when it is on (s).
CHANGES = [
    (17, 1.0, 2.0),
    (19, 1.2, 2.5),
    (22, 1.3, 2.5),
    (24, 1.5, 2.5),
    (18, 3.0, 9.0),
    (20, 4.0, 9.0),
    (17, 5.0, 9.0),
]


def test_waits_for_groups() -> None:
    """A number that stands there is compared bit by bit, others are looked at again and again."""
    inputs = "".join(
        f'[[input]]\ntime = {begin}\nsignal = "di[{number}]"\nvalue = true\nduration = {end - begin}\n'
        for number, begin, end in CHANGES
    )
    program = read(WAITS)
    after = passed(program, (groups_to_bits,), context(program, EVERYTHING))
    assert not [node for node in walk(*after.modules) if isinstance(node, ir.Signal) and node.last is not None]
    wanted, given = (run(one, inputs).outputs for one in (program, after))
    assert [(round(t, 1), name) for t, name, _ in given] == [(round(t, 1), name) for t, name, _ in wanted]
    assert len(wanted) == 7
    assert sum(isinstance(node, ir.Wait) for node in walk(*after.modules)) == 2


def test_a_number_that_is_written_bit_by_bit_is_named_once_a_routine() -> None:
    """A cell that waits for an in-between number (3 to 4 goes over 2 and 0) meets it in the translation only."""
    program = read(PROGRAM, "vplus")
    given = context(program, EVERYTHING)
    passed(program, (groups_to_bits,), given)
    told = [item for item in given.diagnostics if item.code.name == "group-bit-by-bit"]
    assert [item.message.partition(" are")[0] for item in told] == ["the outputs 3 to 6"]
    assert told[0].origin.line == 3
