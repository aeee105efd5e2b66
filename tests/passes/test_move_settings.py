"""Modal settings followed to the moves that they govern: through branches, loops and calls."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.project import read_sources
from rpl.source import source_from_text

HEAD = "VAR p: POSE = {x: 1, y: 0, z: 0, a: 0, b: 0, c: 0}\nVAR on: BOOL = FALSE\n"


def speeds(lines: str, more: str = "") -> list[float | None]:
    """The path speed that is known at each linear move, in the order of the text."""
    text = f"{HEAD}PROCEDURE main()\n{lines}\nEND PROCEDURE\n{more}"
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("main.rpl", text)], "rpl", diagnostics).program
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    flow = SettingsInForce.of(program, {"path_speed": 250.0})
    found = []
    for node in ir_moves(program):
        value = flow.at(node)["path_speed"]
        while isinstance(value, ir.Quantity):
            value = value.value
        found.append(float(value.value) if isinstance(value, ir.RealLiteral | ir.IntLiteral) else None)
    return found


def ir_moves(program: ir.Program) -> list[ir.Move]:
    from rpl.ir.walk import walk

    return [node for node in walk(*program.modules) if isinstance(node, ir.Move)]


MOVE = "MOVE LINEAR TO p"


def test_the_start_of_a_run_has_the_language_s_own_settings() -> None:
    assert speeds(MOVE) == [250.0]


def test_a_setting_holds_until_the_next_one() -> None:
    assert speeds(f"$path_speed = 100.0\n{MOVE}\n$path_speed = 50.0\n{MOVE}") == [100.0, 50.0]


def test_branches_that_differ_leave_it_unknown() -> None:
    lines = f"IF on THEN\n$path_speed = 100.0\nEND IF\n{MOVE}"
    assert speeds(lines) == [None]
    same = f"IF on THEN\n$path_speed = 100.0\nELSE\n$path_speed = 100.0\nEND IF\n{MOVE}"
    assert speeds(same) == [100.0]


def test_a_loop_s_later_passes_count() -> None:
    assert speeds(f"WHILE on\n{MOVE}\n$path_speed = 70.0\nEND WHILE") == [None]


def test_calls_carry_settings_in_and_out() -> None:
    more = f"PROCEDURE slow()\n{MOVE}\n$path_speed = 30.0\nEND PROCEDURE\n"
    assert speeds(f"$path_speed = 90.0\nslow()\n{MOVE}", more) == [30.0, 90.0]


def test_computed_settings_are_unknown() -> None:
    assert speeds(f"$path_speed = p.x\np.x = 2\n{MOVE}") == [None]


def test_a_routine_that_sets_nothing_changes_nothing_for_its_other_callers() -> None:
    more = "PROCEDURE quiet()\non = TRUE\nEND PROCEDURE\n"
    more += "PROCEDURE other()\n$path_speed = 10.0\nquiet()\nEND PROCEDURE\n"
    assert speeds(f"$path_speed = 90.0\nquiet()\n{MOVE}\nother()\nquiet()", more) == [90.0]


def test_a_loop_left_in_the_middle_leaves_what_was_set_there() -> None:
    lines = f"WHILE on\nIF on THEN\n$path_speed = 70.0\nEXIT\nEND IF\nEND WHILE\n{MOVE}"
    assert speeds(lines) == [None]
    out = f"WHILE on\n$path_speed = 70.0\nGOTO behind\nEND WHILE\nLABEL behind\n{MOVE}"
    assert speeds(out) == [None]


def test_a_jump_into_a_block_that_nothing_else_reaches() -> None:
    lines = f"$path_speed = 70.0\nGOTO inside\nIF on THEN\nLABEL inside\n{MOVE}\nEND IF\n{MOVE}"
    assert speeds(lines) == [70.0, 70.0]


FAILING = "PROCEDURE risky()\n$path_speed = 70.0\nRAISE 5\nEND PROCEDURE\n"


@pytest.mark.parametrize(
    ("handler", "known"),
    [
        ("TRY NEXT", [90.0, None]),  # behind the failed call
        ("RETRY", [90.0, 90.0]),  # in front of it; it ends well at last
        ("$path_speed = 40.0\nRETRY", [None, None]),  # the first move may have failed as well
        ("$path_speed = 40.0\nTRY NEXT", [90.0, None]),
        ("RETURN", [90.0, 90.0]),  # the second move is reached when nothing failed
    ],
)
def test_a_handler_goes_on_with_what_was_set_where_it_failed(handler: str, known: list[float | None]) -> None:
    text = f"$path_speed = 90.0\n{MOVE}\nrisky()\n{MOVE}\nON ERROR\n{handler}"
    assert speeds(text, FAILING.replace("RAISE 5", "IF on THEN\nRAISE 5\nEND IF\n$path_speed = 90.0")) == known


def test_a_handler_begins_with_what_holds_anywhere_in_the_routine() -> None:
    text = f"$path_speed = 90.0\nrisky()\n{MOVE}\nON ERROR\n{MOVE}"
    assert speeds(text, FAILING) == [None, None]
    assert speeds(f"{MOVE}\nON ERROR\n{MOVE}") == [250.0, 250.0]


@pytest.mark.parametrize(
    "arming",
    [
        "DECLARE INTERRUPT 3 WHEN on DO slow()",
        "DECLARE INTERRUPT 3 WHEN on DO $path_speed = 40.0",
        "TRAP ERRORS WITH slow",
    ],
)
def test_what_may_run_at_any_time_leaves_its_settings_unknown(arming: str) -> None:
    more = "PROCEDURE slow()\n$path_speed = 40.0\nEND PROCEDURE\n"
    assert speeds(f"{arming}\n{MOVE}\n$path_speed = 90.0\n{MOVE}", more) == [None, None]


LEAVES = """PROCEDURE feel()
INTERRUPT ON 3
$path_speed = 30.0
MOVE LINEAR TO p
INTERRUPT OFF 3
END PROCEDURE
PROCEDURE plain()
$path_speed = 30.0
END PROCEDURE
PROCEDURE leave()
RESUME LEVEL
END PROCEDURE
"""


@pytest.mark.parametrize(("called", "known"), [("feel", None), ("plain", 30.0)])
def test_an_interrupt_that_leaves_a_routine_may_come_before_its_settings(called: str, known: float | None) -> None:
    lines = f"DECLARE INTERRUPT 3 WHEN on DO leave()\n$path_speed = 200.0\n{called}()\n{MOVE}"
    assert speeds(lines, LEAVES) == [known, 30.0]
