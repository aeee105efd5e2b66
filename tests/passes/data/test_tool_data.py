"""Poses that moves name as tool or frame become records of tool and work object data, and nothing else changes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from postprocessors.rapid.passes.explicit import modal_to_explicit
from postprocessors.rapid.passes.tooldata import tool_data
from rpl import ir
from rpl.cell import parse_cell
from rpl.simulation import run_program

from .executed import EVERYTHING, context, passed, read, same, shown

# A target whose moves name records; its data without an offset is declared by the program itself here.
RECORDS = replace(EVERYTHING, settings=replace(EVERYTHING.settings, bare=("no_tool", "no_frame"), modal=False))
HEAD = """
PERSISTENT grip: POSE = pose {x: 0.0, y: 0.0, z: 120.0, a: 0.0, b: 0.0, c: 0.0}
PERSISTENT table: POSE = pose {x: 50.0, y: -20.0, z: 0.0, a: 10.0, b: 0.0, c: 0.0}
PERSISTENT no_tool: TOOL = tool {held: TRUE}
PERSISTENT no_frame: WORKOBJECT
CONST p: TARGET.rpl = target.rpl {x: 400.0, y: 100.0, z: 300.0, a: 0.0, b: 0.0, c: 180.0}
VAR here: TARGET.rpl = p
VAR height: REAL = 0.0
"""
ROBOT = "ur5e"


def program(lines: str, more: str = "") -> ir.Program:
    return read(f"{HEAD}PROCEDURE main()\n{lines}\nEND PROCEDURE\n{more}")


def variables(one: ir.Program) -> dict[str, ir.Variable]:
    return {v.name: v for module in one.modules for v in module.declarations if isinstance(v, ir.Variable)}


CHECK = "IF abs(height) < 0.001 THEN\nSET do[1] TO ON\nELSE\nSET do[2] TO ON\nEND IF"


@pytest.mark.parametrize(
    "lines",
    [
        "MOVE TO p TOOL grip FRAME table",
        "MOVE TO p TOOL grip\ngrip.z = 200.0\nMOVE LINEAR TO p TOOL grip",
        "grip = pose {x: 1.0, y: 2.0, z: 3.0, a: 0.0, b: 20.0, c: 0.0}\nMOVE TO p TOOL grip\nheight = grip.z - 3.0",
        "MOVE TO p TOOL grip\nhere = current_target(grip, $null_frame)\nheight = here.z - 300.0",
        "MOVE TO p TOOL grip FRAME table\nhere = current_target(grip, table)\nheight = here.x - 400.0",
        "MOVE TO p\nhere = current_target(grip : grip, table)\nheight = here.z - 60.0",
        "MOVE TO p FRAME grip TOOL grip",
        "MOVE TO p TOOL pose {x: 0.0, y: 0.0, z: 80.0, a: 0.0, b: 0.0, c: 0.0}",
        "MOVE TO p TOOL table : grip",
    ],
)
def test_moves_and_places_are_the_same(lines: str) -> None:
    before = program(f"{lines}\n{CHECK}")
    given = context(before, RECORDS)
    same(before, [tool_data], given, robot=ROBOT)


def test_the_pose_becomes_a_component_of_the_record() -> None:
    before = program("MOVE TO p TOOL grip FRAME table\ngrip.z = 10.0")
    after = passed(before, [tool_data], context(before, RECORDS))
    found = variables(after)
    assert found["grip"].type == ir.ToolType()
    assert found["table"].type == ir.WorkObjectType()
    move, change = after.modules[0].routines[0].body
    assert isinstance(move, ir.Move)
    assert (move.tool, move.frame) == (ir.Name("grip"), ir.Name("table"))
    assert isinstance(change, ir.Assign)
    assert change.target == ir.Field(ir.Field(ir.Name("grip"), "frame"), "z")


def test_no_offset_is_the_target_s_own_data() -> None:
    before = program("here = current_target($null_frame, $null_frame)")
    after = passed(before, [tool_data], context(before, RECORDS))
    (asked,) = after.modules[0].routines[0].body
    assert isinstance(asked, ir.Assign)
    assert asked.value == ir.Builtin("current_target", (ir.Name("no_tool"), ir.Name("no_frame")))


def test_a_pose_of_a_routine_is_set_in_front_of_the_move() -> None:
    more = "PROCEDURE go(t: POSE)\nMOVE TO p TOOL t\nEND PROCEDURE\n"
    before = program("go(grip)\ngo(table)", more)
    after = same(before, [tool_data], context(before, RECORDS), robot=ROBOT)
    first, move = after.modules[0].routines[1].body
    assert isinstance(first, ir.Assign)
    assert isinstance(move, ir.Move)
    assert first.target == ir.Field(move.tool or ir.Name(""), "frame")
    assert variables(after)["grip"].type == ir.PoseType()


def test_a_pose_in_the_cell_file_is_the_record_s() -> None:
    before = program("MOVE TO p TOOL grip FRAME table")
    after = passed(before, [tool_data], context(before, RECORDS))
    cell = parse_cell("[variables]\ngrip = { x = 7.0, z = 33.0 }\ntable = { a = 25.0 }\n")
    one, other = (run_program(it, ROBOT, cell) for it in (before, after))
    assert shown(one) == shown(other)
    assert shown(one) != shown(run_program(before, ROBOT))


def test_where_the_robot_is_is_seen_with_the_tool_that_is_set_now() -> None:
    """A controller whose moves name the tool sees with that of the last move otherwise."""
    lines = f"MOVE TO p\n$tool = grip\nhere = current_target()\nheight = here.z - 420.0\n{CHECK}"
    before = program(lines)
    given = context(before, RECORDS)
    after = same(before, [modal_to_explicit, tool_data], given, robot=ROBOT)
    asked = next(s for s in after.modules[0].routines[0].body if isinstance(s, ir.Assign))
    assert asked.value == ir.Builtin("current_target", (ir.Name("grip"), ir.Name("no_frame")))
