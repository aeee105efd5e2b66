"""Settings for the next move that a called routine makes: the routine has a form of its own that begins with them."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.passes.legalise.places.nextmove.nextmovecalls import next_moves_behind_calls

from .common import count, nodes
from .shaped import ALL, assign, less, number, program, rewritten, step, target, when
from .test_losses import move, once

PLAIN = target(ALL)
INNER = ir.Routine("inner", body=(move(),))
TRAVEL = ir.Routine("travel", body=(step(1), ir.CallRoutine("inner")))
QUIET = ir.Routine("quiet", body=(assign("a", 2),))
KEEPING = ir.Routine(
    "keeping", declarations=(ir.Variable("n", ir.IntType(), storage="persistent", scope="routine"),), body=(move(),)
)
ROUTINES = (TRAVEL, INNER, QUIET, KEEPING)
CASES: list[tuple[str, ir.Body, list[str]]] = [
    ("in the routine", (once(), ir.CallRoutine("inner")), ["inner_next"]),
    ("one level down", (once(), ir.CallRoutine("travel")), ["inner_next", "travel_next"]),
    ("behind what does not move", (once(), ir.CallRoutine("quiet"), step(1), ir.CallRoutine("inner")), ["inner_next"]),
    ("two settings", (once(), once(1, "blend_distance"), ir.CallRoutine("inner")), ["inner_next"]),
    ("in a branch", (when(less("a", 1), once(), ir.CallRoutine("inner")),), ["inner_next"]),
    ("a move first", (once(), move(), ir.CallRoutine("inner")), []),
    ("a choice between", (once(), when(less("a", 1), move()), ir.CallRoutine("inner")), []),
    ("data kept between calls", (once(), ir.CallRoutine("keeping")), []),
    ("a value that may change", (once(ir.Name("a")), ir.CallRoutine("inner")), []),
]


@pytest.mark.parametrize(("body", "forms"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_a_routine_begins_with_what_was_set(body: ir.Body, forms: list[str]) -> None:
    before = program(*body, routines=ROUTINES)
    after, _ = rewritten(before, PLAIN, next_moves_behind_calls)
    found = {one.name: one for module in after.modules for one in module.routines}
    assert sorted(name for name in found if name.endswith("_next")) == forms
    assert count(after, ir.SetForNextMove) == count(before, ir.SetForNextMove)
    if "inner_next" in forms:
        assert isinstance(found["inner_next"].body[0], ir.SetForNextMove)


def test_the_same_settings_share_a_form() -> None:
    call = ir.CallRoutine("inner")
    after, _ = rewritten(program(once(), call, once(), call, call, routines=ROUTINES), PLAIN, next_moves_behind_calls)
    called = [one.name for one in nodes(after) if isinstance(one, ir.CallRoutine)]
    assert called.count("inner_next") == 2
    assert called.count("inner") == 2
    assert number(50) in [one.value for one in nodes(after) if isinstance(one, ir.SetForNextMove)]
