"""Stages in their order, and passes that a target places among those of the core."""

from importlib import import_module

import pytest

from rpl import ir
from rpl.errors import InternalError
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.pipeline import PASSES, STAGES
from rpl.passes.legalise.stages import Placed, Stage, legalising, with_placed


def test_stages_have_names_of_their_own_and_say_what_they_are_for() -> None:
    names = [stage.name for stage in STAGES]
    assert len(set(names)) == len(names)
    for name in names:
        home = import_module(f"rpl.passes.legalise.{name}.stage")
        assert home.STAGE.name == name
        assert home.__doc__


def test_every_pass_stands_once() -> None:
    """What runs again says why, and has its own place besides."""
    names = [one.name for one in PASSES]
    assert [name for name in names if names.count(name) > 1] == []
    assert [one.name for one in PASSES if one.again and one.run.__name__ not in names] == []


# Passes that stand in the folder of another stage than the one that runs them, with the reason.
ELSEWHERE = {
    "without_shared_references": "routines, before interrupts: what these call gets routines of its own, and tasks",
}


def test_the_passes_of_a_stage_stand_in_its_folder() -> None:
    outside = [
        one.name
        for stage in STAGES
        for one in stage.passes
        if not one.again and not f"{one.run.__module__}.".startswith(f"rpl.passes.legalise.{stage.name}.")
    ]
    assert outside == list(ELSEWHERE)


@legalising()
def first(program: ir.Program, context: Context) -> ir.Program:
    return program


@legalising()
def second(program: ir.Program, context: Context) -> ir.Program:
    return program


@legalising()
def own(program: ir.Program, context: Context) -> ir.Program:
    return program


@legalising()
def further(program: ir.Program, context: Context) -> ir.Program:
    return program


@pytest.mark.parametrize(
    ("placed", "order"),
    [
        ((), "first second"),
        ((Placed(own, "one", behind="first"),), "first own second"),
        ((Placed(own, "one", before="first"),), "own first second"),
        ((Placed(own, "one", behind="second"), Placed(further, "one", behind="second")), "first second own further"),
        ((Placed(own, "one", behind="first"), Placed(further, "one", before="second")), "first own further second"),
    ],
)
def test_a_pass_of_a_target_stands_beside_the_one_that_it_names(placed: tuple[Placed, ...], order: str) -> None:
    core = (Stage("one", (first, second)), Stage("two", (first,)))
    assert " ".join(one.name for one in with_placed(core, placed)[0].passes) == order
    assert with_placed(core, placed)[1] == core[1]


def test_a_place_beside_no_pass_is_a_mistake_of_the_target() -> None:
    with pytest.raises(InternalError, match="own stands beside third of one, which is not one pass"):
        with_placed((Stage("one", (first, second)),), (Placed(own, "one", before="third"),))
