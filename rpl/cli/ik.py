"""`rpl ik`: a pose to all joint solutions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import click

from rpl.cli.kinematics import (
    chosen_notation,
    dialect_option,
    joint_list,
    joints_of,
    matrix_rows,
    pose_of,
    required_robot,
    tool_option,
)
from rpl.cli.output import json_option, print_json, robot_named, say
from rpl.cli.points import (
    PREVIOUS,
    Outcome,
    Targets,
    chunks,
    joint_cells,
    kept_columns,
    points_option,
    read_table,
    report,
    solved,
    target_cells,
    target_columns,
    targets_of,
)
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation, Selection
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray

_SAME_DEG = 1e-6
_NEAR = (
    "Joints before the move: they decide what the flags leave open. With --points also 'previous': each target is "
    "reached from the one before."
)


@click.command("ik")
@required_robot
@click.option("--pose", metavar="TEXT", help="Pose in the dialect's notation, or x,y,z,a,b,c (mm, deg).")
@points_option
@click.option("--near", metavar="A,B,..", help=_NEAR)
@click.option("--to-dialect", metavar="D", help="Give the selected solution as a target in this language's notation.")
@click.option("--to-robot", metavar="R", help="Another arm that shall come there in the same posture: its joints then.")
@tool_option
@dialect_option
@json_option
def command(
    robot: str, pose: str | None, points: str | None, near: str | None, to_dialect: str | None, to_robot: str | None,
    tool: str | None, dialect: str | None, as_json: bool,
) -> int:  # fmt: skip
    """Inverse kinematics: a pose to all joint solutions; the one that the pose's flags select is marked.

    Each posture of the arm is listed once, with the turns nearest to --near (else to the home position). With
    --to-dialect the selected one is given as a target of that language instead, with --to-robot as one of that arm.
    With --points a file of targets becomes a table of joints (and of targets), as CSV or as `points` in JSON.
    """
    model = robot_named(robot)
    if model is None:
        raise UsageError("--robot is needed")
    if (pose is None) == (points is None):
        raise UsageError("either --pose or --points is needed")
    name, notation = chosen_notation(dialect, model)
    goal = _goal(model, to_dialect, to_robot)
    tip = pose_of(tool, "--tool", notation)[0] if tool else None
    if points is not None:
        return _table(model, name, notation, goal, points, near, tip, as_json)
    return _one(model, name, notation, goal, pose or "", near, tip, as_json)


def _one(
    model: RobotModel, name: str, notation: Notation, goal: _Goal | None, pose: str, near: str | None,
    tip: FloatArray | None, as_json: bool,
) -> int:  # fmt: skip
    """All solutions of one pose, or the selected one as a target."""
    from rpl.emulator.configuration import ExternalAxes
    from rpl.emulator.postures import out_of_reach

    target, flags = pose_of(pose, "--pose", notation)
    if isinstance(notation, ExternalAxes) and (external := notation.external_axes(pose)):
        say(f"rpl: the external axes {', '.join(external)} are left out", err=True)
    flange = target
    if tip is not None:
        import numpy as np

        flange = target @ np.linalg.inv(tip)
    reference = joints_of(near, "--near", model) if near else None
    selection = None
    if reference is not None or goal is not None or any(value is not None for value in flags.values()):
        selection = notation.select(model, flange, flags, reference)
    rows = solutions(model, notation, flange, reference, selection)
    reason = selection.reason if selection is not None else "" if rows else "the pose is out of reach"
    reason = reason and (out_of_reach(model, flange) or reason)
    chosen = selection.joints if selection is not None else None
    if goal is not None and chosen is not None:
        chosen = _joints_for(model, goal, flange[None], chosen[None])[0]
        if chosen is None:
            reason = _not_there(goal)
    converted = None if goal is None else _converted(goal, target, chosen)
    if as_json:
        document: dict[str, object] = {
            "robot": model.name,
            "dialect": name,
            "matrix": matrix_rows(flange),
            "flags": flags,
            "solutions": rows,
            "reason": reason,
        }
        print_json(document if converted is None else {**document, "converted": converted})
    elif converted is None:
        for row in rows:
            print_solution(row)
    elif converted["pose"] is not None:
        say(str(converted["pose"]))
    if reason:
        say(f"rpl: {reason}", err=True)
    return 0 if rows and (converted is None or converted["pose"] is not None) else 1


def _converted(goal: _Goal, target: FloatArray, joints: FloatArray | None) -> dict[str, object]:
    """The selected solution in the notation asked for; nothing of it without one."""
    there = joints is not None
    return {
        "robot": goal.model.name,
        "dialect": goal.name,
        "pose": goal.notation.format_pose(goal.model, target, joints) if there else None,
        "joints_deg": joint_list(joints) if joints is not None else None,
        "configuration": goal.notation.encode(goal.model, joints) if joints is not None else None,
    }


@dataclass(frozen=True, slots=True, eq=False)
class _Goal:
    """In whose notation the answer is, and for which arm."""

    name: str
    notation: Notation
    model: RobotModel


def _goal(model: RobotModel, to_dialect: str | None, to_robot: str | None) -> _Goal | None:
    if to_dialect is None and to_robot is None:
        return None
    from rpl.emulator.postures import UNKNOWN_BUILD, has_flags

    other = robot_named(to_robot) or model
    goal = _Goal(*chosen_notation(to_dialect, other), other)
    if to_dialect is not None and goal.notation.fields and not has_flags(other):
        raise UsageError(f"--to-dialect {goal.name}: {UNKNOWN_BUILD}: {other.name}")
    return goal


def _joints_for(model: RobotModel, goal: _Goal, flanges: FloatArray, joints: FloatArray) -> list[FloatArray | None]:
    """The joints of the arm that shall come there, None where it does not in that posture."""
    if goal.model is model:
        return list(joints)
    import numpy as np

    from rpl.emulator.selection import on_other_arm

    found = on_other_arm(model, joints, goal.model, flanges).joints
    return [None if np.isnan(one).any() else one for one in found]


def _not_there(goal: _Goal) -> str:
    return f"{goal.model.name} does not reach this in the same posture"


def _table(
    model: RobotModel, name: str, notation: Notation, goal: _Goal | None, path: str, near: str | None,
    tool: FloatArray | None, as_json: bool,
) -> int:  # fmt: skip
    """Rows of targets to rows of joints, and of another language's targets."""
    import numpy as np

    table = read_table(path)
    follow = near == PREVIOUS
    here = joints_of(near, "--near", model) if near and not follow else None
    made = target_columns(goal.notation) if goal is not None else ()
    kept = kept_columns(table, (*made, "config", *target_columns(notation)))
    joint_names = tuple(f"j{axis}" for axis in range(1, (goal.model if goal is not None else model).axes + 1))
    outcome = Outcome(("line", *(table.columns[place] for place in kept), *joint_names, *made))
    for part in chunks(table.rows):
        targets = targets_of(table, part, notation, outcome)
        flanges = targets.poses if tool is None else targets.poses @ np.linalg.inv(tool)
        rows, reached, joints, here = solved(
            model, notation, Targets(targets.rows, flanges, targets.flags), here, follow, outcome
        )
        cells: list[tuple[object, ...]] = [()] * len(rows)
        if goal is not None:
            found = _joints_for(model, goal, reached, joints)
            lost = [row.line for row, one in zip(rows, found, strict=True) if one is None]
            outcome.errors.extend((line, "unreachable-point", _not_there(goal)) for line in lost)
            there = [place for place, one in enumerate(found) if one is not None]
            rows, reached = [rows[place] for place in there], reached[there]
            joints = np.array([found[place] for place in there]).reshape(-1, goal.model.axes)
            tips = reached if tool is None else reached @ tool
            cells = target_cells(goal.model, goal.notation, tips, joints)
        for row, one, more in zip(rows, joint_cells(joints), cells, strict=True):
            aside = tuple(row.cells[place] if place < len(row.cells) else "" for place in kept)
            outcome.rows.append((row.line, (*aside, *one, *more)))
    facts: dict[str, object] = {"robot": model.name, "dialect": name}
    if goal is not None:
        facts |= {"to_robot": goal.model.name, "to_dialect": goal.name}
    return report(table, outcome, facts, as_json)


def solutions(
    model: RobotModel,
    notation: Notation,
    flange: FloatArray,
    reference: FloatArray | None,
    selection: Selection | None,
) -> list[dict[str, object]]:
    """One entry per posture; the selected joints stand in the place of their posture."""
    import numpy as np

    chosen = selection.joints if selection is not None else None
    near = model.home if reference is None else reference
    rows: list[dict[str, object]] = []
    marked = False
    for solution in model.inverse(flange, near):
        joints = model.nearest_turn(solution.joints, near)
        selected = False
        if chosen is not None and not marked:
            apart = model.canonical(chosen) - model.canonical(joints)
            selected = bool(np.abs((apart + 180.0) % 360.0 - 180.0).max() < _SAME_DEG)
            joints, marked = (chosen, True) if selected else (joints, False)
        rows.append(_row(model, notation, joints, selected, solution.singular))
    if chosen is not None and not marked:
        rows.append(_row(model, notation, chosen, True, True))
    return rows


def _row(
    model: RobotModel, notation: Notation, joints: FloatArray, selected: bool, singular: bool
) -> dict[str, object]:
    return {
        "joints_deg": joint_list(joints),
        "configuration": notation.encode(model, joints),
        "selected": selected,
        "within_limits": not model.within_limits(joints),
        "singular": singular,
    }


def print_solution(row: dict[str, object]) -> None:
    """One line: the mark, the joints, the flags."""
    joints, flags = row["joints_deg"], row["configuration"]
    assert isinstance(joints, list) and isinstance(flags, dict)
    mark = "*" if row["selected"] else " "
    angles = " ".join(f"{value:10.4f}" for value in joints)
    beyond = "" if row["within_limits"] else "  beyond limits"
    say(f"{mark} {angles}   {' '.join(f'{key}={value}' for key, value in flags.items())}{beyond}")
