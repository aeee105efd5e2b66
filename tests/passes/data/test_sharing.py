"""Temporaries of routines that are never active together share a number where a bank would run out."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rpl import ir
from rpl.passes.capabilities import Bank, Local
from rpl.passes.legalise.storage.sharing import share_temporaries
from rpl.source import NOWHERE

from .executed import NUMBERED, context, read, same

PROGRAM = """MODULE m
VAR kept, total: INT
PROCEDURE main()
    VAR a: INT
    a = 1
    kept = 0
    total = 0
    first()
    second()
    a = a + total
    first()
    MESSAGE value_text(a + total + kept)
END PROCEDURE
PROCEDURE first()
    VAR x, y, n: INT
    n = n + 1
    x = 2 + n
    y = x * 3
    total = total + y + kept
END PROCEDURE
PROCEDURE second()
    VAR z, w: INT
    z = 5
    inner()
    w = z + 1
    total = total + w
END PROCEDURE
PROCEDURE inner()
    VAR v: INT
    v = 7
    IF total > 100 THEN v = 8
    kept = kept + v
END PROCEDURE
END MODULE
"""


def _given(first: str = "a x y n z w v") -> ir.Program:
    """The program, its variables in the module, those named as if passes had made them."""
    program = read(PROGRAM)
    module = program.modules[0]
    made = []
    for routine in module.routines:
        for one in routine.declarations:
            assert isinstance(one, ir.Variable)
            origin = NOWHERE if one.name in first.split() else one.origin
            made.append(replace(one, scope="module", origin=origin))
    routines = tuple(replace(one, declarations=()) for one in module.routines)
    declarations = tuple(replace(one, initial=ir.IntLiteral(0)) if one.name == "n" else one for one in made)
    return replace(program, modules=(replace(module, declarations=(*module.declarations, *declarations),
                                             routines=routines),))  # fmt: skip


def _names(program: ir.Program) -> set[str]:
    return {one.name for module in program.modules for one in module.declarations if isinstance(one, ir.Variable)}


def _can(numbers: int, **more: object) -> object:
    bank = Bank("R", 1, numbers)
    return replace(
        NUMBERED,
        **more,
        routines=replace(NUMBERED.routines, locals=NUMBERED.routines.locals - {Local.VARIABLES}),
        storage=replace(NUMBERED.storage, banks={**NUMBERED.storage.banks, "RealType": bank, "IntType": bank}),
    )


def test_what_never_meets_shares() -> None:
    program = _given()
    after = same(program, (share_temporaries,), context(program, _can(12)), entry="main")  # type: ignore[arg-type]
    # a lasts over all calls; x, y share with z, w; v may not share with those; n keeps its value, so it stays
    assert _names(after) == {"kept", "total", "n", "rpl_work", "rpl_work2", "rpl_work3", "rpl_work4"}


@pytest.mark.parametrize("numbers", [30, 200])
def test_nothing_is_shared_while_the_numbers_suffice(numbers: int) -> None:
    program = _given()
    assert share_temporaries(program, context(program, _can(numbers))) is program  # type: ignore[arg-type]


def test_variables_of_the_source_keep_their_own() -> None:
    program = _given("x y z")
    after = same(program, (share_temporaries,), context(program, _can(12)), entry="main")  # type: ignore[arg-type]
    assert {"a", "w", "v", "n"} <= _names(after)


def test_only_for_targets_without_variables_of_routines() -> None:
    program = _given()
    assert (
        share_temporaries(
            program,
            context(
                program,
                replace(
                    NUMBERED, routines=replace(NUMBERED.routines, locals=NUMBERED.routines.locals | {Local.VARIABLES})
                ),
            ),
        )
        is program
    )
