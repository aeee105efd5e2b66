"""Settings for one move, error routines, searches, critical sections, tasks and interrupts: kept, or named."""

from __future__ import annotations

from dataclasses import replace

import pytest

from postprocessors.krl.passes.searches import searches
from rpl import ir
from rpl.passes.capabilities import Motion, SearchResult, SettingRule, Settings, Tasks
from rpl.passes.legalise.places.nextmove.nextmove import settings_of_next_move
from rpl.passes.legalise.refusals import refuse
from rpl.passes.legalise.searches.searchparts import search_parts
from rpl.passes.legalise.statements.structure import labels_to_structure

from .common import count, nodes
from .shaped import ALL, STRUCTURED, assign, context_for, less, number, program, rewritten, same, step, target, when

PLAIN = target(ALL - {"Critical", "TaskControl", "OnError", "DeclareInterrupt", "ControlInterrupt"})
A = less("a", 1)


def move(**further: object) -> ir.Move:
    zero = tuple((f"j{at}", ir.RealLiteral(float(at))) for at in range(1, 7))
    return ir.Move("joint", ir.Aggregate(zero, "joints"), **further)  # type: ignore[arg-type]


def once(value: ir.Expression | int = 50, name: str = "path_speed") -> ir.SetForNextMove:
    return ir.SetForNextMove(ir.System(name), number(value) if isinstance(value, int) else value)


def settings(after: ir.Program) -> list[list[object]]:
    return [
        [(place.name, value) for place, value in one.settings if isinstance(place, ir.System)]
        for one in nodes(after)
        if isinstance(one, ir.Move)
    ]


FIFTY = [("path_speed", ir.IntLiteral(50))]
KEPT: list[tuple[str, ir.Body, list[list[object]]]] = [
    ("straight on", (once(), move(), move()), [FIFTY, []]),
    ("the later one", (once(20), once(), move()), [FIFTY]),
    ("two of them", (once(), once(1, "blend_distance"), move()), [[*FIFTY, ("blend_distance", ir.IntLiteral(1))]]),
    ("other statements between", (once(), step(1), ir.Wait(number(1)), move()), [FIFTY]),
    ("every branch", (once(), when(A, move(), otherwise=(step(1), move())), move()), [FIFTY, FIFTY, []]),
    ("no branch", (once(), when(A, step(1)), move()), [FIFTY]),
    ("set in every branch", (when(A, once(), move(), otherwise=(once(), move())),), [FIFTY, FIFTY]),
    ("a branch that ends", (once(), when(A, ir.Return()), move()), [FIFTY]),
    ("a loop without moves", (once(), ir.While(A, (assign("a", 5),)), move()), [FIFTY]),
    ("inside of a loop", (ir.While(A, (once(), move(), assign("a", 5))),), [FIFTY]),
    ("no move behind", (once(), step(1)), []),
]
LOST: list[tuple[str, ir.Body]] = [
    ("one branch", (once(), when(A, move()), move())),
    ("set in one branch", (when(A, once()), move())),
    ("a loop", (once(), ir.While(A, (move(), assign("a", 5))))),
    ("over the end of a loop", (ir.While(A, (move(), once(), assign("a", 5))), move())),
    ("a routine that moves", (once(), ir.CallRoutine("travel"), move())),
    ("a label", (once(), ir.Label("x"), move(), when(A, assign("a", 5), ir.Goto("x")))),
    ("a jump", (once(), when(A, ir.Goto("x")), ir.Label("x"), move())),
]
TRAVEL = ir.Routine("travel", body=(move(),))


@pytest.mark.parametrize("body, wanted", [case[1:] for case in KEPT], ids=[case[0] for case in KEPT])
def test_a_setting_goes_to_its_move(body: ir.Body, wanted: list[list[object]]) -> None:
    after = same(program(*body, routines=(TRAVEL,)), PLAIN, settings_of_next_move)
    assert settings(after)[: len(wanted)] == wanted
    assert not count(after, ir.SetForNextMove)


@pytest.mark.parametrize("body", [case[1] for case in LOST], ids=[case[0] for case in LOST])
def test_a_setting_for_no_certain_move_is_refused(body: ir.Body) -> None:
    after, context = rewritten(program(*body, routines=(TRAVEL,)), PLAIN, settings_of_next_move)
    assert [item.code.name for item in context.diagnostics] == ["next-move-uncertain"]
    assert count(after, ir.Opaque) == 1 and not count(after, ir.SetForNextMove)
    assert not any(settings(after))


def test_a_value_that_may_change_is_kept() -> None:
    after = same(program(once(ir.Name("a")), assign("a", 7), move()), PLAIN, settings_of_next_move)
    assert settings(after) == [[("path_speed", ir.Name("for_next_move"))]]


def test_a_setting_before_a_label_that_structure_takes_away() -> None:
    body = (once(), when(A, ir.Goto("x")), step(1), ir.Label("x"), move())
    after = same(program(*body), target(STRUCTURED), labels_to_structure, settings_of_next_move)
    assert settings(after) == [FIFTY]


def test_a_target_that_has_such_settings_keeps_them() -> None:
    given = program(once(), move())
    assert (
        rewritten(
            given,
            target(settings=Settings(modal=True, rules=frozenset((SettingRule.NEXT_MOVE,)))),
            settings_of_next_move,
        )[0]
        is given
    )


# ---- searches


def _search(**further: object) -> ir.Program:
    names = {"found": ir.TargetType("rpl"), "hit": ir.BoolType()}
    search = ir.Search(ir.Signal("digital_in", number(1)), **further)  # type: ignore[arg-type]
    given = program(move(search=search), step(1))
    (module,) = given.modules
    variables = tuple(ir.Variable(name, type, scope="routine") for name, type in names.items())
    main = replace(module.routines[0], declarations=variables)
    return ir.Program((replace(module, routines=(main, *module.routines[1:])),))


WITH_SEARCH = ALL | {"Search"}


def test_a_target_that_gives_the_place_only() -> None:
    after, context = rewritten(_search(stop="quick"), target(WITH_SEARCH), search_parts)
    (one,) = [node for node in nodes(after) if isinstance(node, ir.Move)]
    assert one.search is not None and one.search.found == ir.Name("found2") and not len(context.diagnostics)
    _, context = rewritten(_search(stop="quick", hit=ir.Name("hit")), target(WITH_SEARCH), search_parts)
    assert [item.code.name for item in context.diagnostics] == ["search-hit-lost"]


def test_a_target_that_says_only_whether() -> None:
    says = target(WITH_SEARCH, motion=Motion(search_results=frozenset((SearchResult.HIT,))))
    after, context = rewritten(_search(stop="quick", found=ir.Name("found")), says, search_parts)
    (one,) = [node for node in nodes(after) if isinstance(node, ir.Move)]
    assert one.search == ir.Search(ir.Signal("digital_in", number(1)), None, "quick", hit=ir.Name("hit2"))
    assert not len(context.diagnostics)
    _, context = rewritten(_search(found=ir.Name("found")), says, search_parts)
    assert [item.code.name for item in context.diagnostics] == ["search-place-lost"]


@pytest.mark.parametrize("given", [{}, {"hit": ir.Name("hit")}, {"hit": ir.Name("hit"), "found": ir.Name("found")}])
def test_searches_by_interrupts_give_what_is_asked(given: dict[str, object]) -> None:
    capabilities = target(ALL | {"ResumeLevel"})
    after, _ = rewritten(_search(stop="quick", **given), capabilities, searches)
    assert not any(isinstance(one, ir.Move) and one.search is not None for one in nodes(after))
    written = {one.target for one in nodes(after) if isinstance(one, ir.Assign)}
    assert set(given.values()) <= written


# ---- what no rewriting can give


def test_a_critical_section_of_one_task_says_nothing() -> None:
    after = same(program(ir.Critical(True), step(1), ir.Critical(False)), PLAIN, refuse)
    assert not count(after, ir.Critical)


@pytest.mark.parametrize(
    "statement, name",
    [
        (ir.TaskControl("join", "other"), "task-control-lost"),
        (ir.TaskControl("start", "other"), "task-control-lost"),
        (ir.DeclareInterrupt(number(5), ir.Signal("digital_in", number(1)), step(1)), "interrupt-lost"),
        (ir.ConnectInterrupt(ir.Name("a"), "other"), "interrupt-lost"),
    ],
)
def test_what_is_lost_is_named_and_stays(statement: ir.Statement, name: str) -> None:
    given = program(statement, step(1), routines=(ir.Routine("other", body=(ir.Critical(True), ir.Critical(False))),))
    context = context_for(given, PLAIN)
    after = refuse(given, context)
    names = [item.code.name for item in context.diagnostics]
    assert names[0] == name
    assert statement in list(nodes(after))
    if isinstance(statement, ir.TaskControl):
        assert names[1:] == ["critical-section-lost"]


def test_only_the_operations_that_are_lacking_are_named() -> None:
    capabilities = target(tasks=Tasks(operations=frozenset(("start",))))
    given = program(ir.TaskControl("start", "other"), ir.TaskControl("join", "other"), routines=(ir.Routine("other"),))
    context = context_for(given, capabilities)
    refuse(given, context)
    assert [item.message for item in context.diagnostics] == [
        "the target's programs cannot wait for the end of another task (other)"
    ]
