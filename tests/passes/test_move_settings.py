"""Modal settings followed to the moves that they govern: through branches, loops and calls."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.facts.modalflow import Flow
from rpl.project import read_sources
from rpl.source import source_from_text

HEAD = "VAR p: POSE = {x: 1, y: 0, z: 0, a: 0, b: 0, c: 0}\nVAR on: BOOL = FALSE\n"


def speeds(lines: str, more: str = "") -> list[float | None]:
    """The path speed that is known at each linear move, in the order of the text."""
    text = f"{HEAD}PROCEDURE main()\n{lines}\nEND PROCEDURE\n{more}"
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("main.rpl", text)], "rpl", diagnostics).program
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    flow = Flow.of(program, {"path_speed": 250.0})
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
