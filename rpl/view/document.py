"""The data behind the page: one plain document of numbers and texts, the same for the same run.

Joints go in, not poses of links: the page moves the arms by their screws (`rpl.report.screws`). Long arrays are packed
(`rpl.view.packing`), forms that are alike go in once.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rpl.cell.shapes import Shape
from rpl.report.screws import Screws, row_of, screws_document
from rpl.report.signals import signal_rows
from rpl.source import Source
from rpl.view.bodies import Drawn, robot_of
from rpl.view.packing import packed
from rpl.view.scene import Scene, first_width
from rpl.view.tracks import Track, short_names, sources_of

if TYPE_CHECKING:
    from rpl.cell.record import Placed
    from rpl.workcell.record import RobotRun

# What the long arrays are rounded to: far below what one sees, and what the size of the page allows.
TIME_S, JOINT, PLACE_MM, TURN, SPEED_MM_S, VERTEX_MM = 1e-4, 1e-4, 0.01, 1e-7, 1.0, 0.01
# Texts of more characters are cut to what the run has come to, with so many lines around.
MOST_TEXT, LINES_AROUND = 400_000, 40
MOST_EVENTS = 4_000

Row = dict[str, object]


def view_document(scene: Scene, title: str) -> Row:
    """The document of a run."""
    run = scene.run
    files = sources_of(run)
    names = list(files)
    shapes: list[Row] = []
    places: dict[Shape, int] = {}
    return {
        "title": title,
        "status": run.status,
        "time_s": round(run.time_s, 6),
        "fault": run.fault,
        "robots": [
            _robot(one, scene.tracks[number], scene.screws[number], names) for number, one in enumerate(run.robots)
        ],
        "bodies": [_body(one, shapes, places) for one in scene.bodies],
        "shapes": shapes,
        "parts": [_part(scene, places) for places in scene.places],
        "grippers": [_gripper(scene, number) for number in range(len(run.layout.grippers))],
        "signals": [row for number, one in enumerate(run.robots) for row in _signals(one, number)],
        "events": _events(scene, names),
        "files": [_file(name, short, files[name], scene.tracks) for name, short in short_names(names).items()],
    }


def _robot(run: RobotRun, track: Track, screws: Screws | None, files: list[str]) -> Row:
    name = run.place.name or (run.model.name if run.model is not None else "program")
    tasks = list(dict.fromkeys(one.task for one in track.lines))
    found: Row = {
        "name": name,
        "base": row_of(run.place.base),
        "tasks": tasks,
        "lines": [[round(one.t, 4), files.index(one.file), one.line, tasks.index(one.task)] for one in track.lines],
    }
    if run.model is None or screws is None:
        return found
    model = run.model
    if track.bases is not None:
        found["places"] = packed(track.bases[:, :3, 3], PLACE_MM)
        found["turns"] = packed(track.bases[:, :3, :3].reshape(-1, 9), TURN)
    return found | {
        "title": model.title,
        "joints": [
            {
                "name": f"J{axis + 1}",
                "unit": "deg" if turning else "mm",
                "low": round(float(model.limits[axis, 0]), 4),
                "high": round(float(model.limits[axis, 1]), 4),
                "speed": round(float(model.speeds[axis]), 4),
            }
            for axis, turning in enumerate(model.revolute.tolist())
        ],
        "screws": screws_document(screws),
        "t": packed(track.times, TIME_S),
        "q": packed(track.joints, JOINT),
        "tool": packed(track.tool, PLACE_MM),
        "speed": packed(track.speeds, SPEED_MM_S),
        "tools": [[round(t, 4), row_of(tool)] for t, tool in track.tools],
    }


def _body(body: Drawn, shapes: list[Row], places: dict[Shape, int]) -> Row:
    """A body, its form among the forms."""
    if body.shape not in places:
        places[body.shape] = len(shapes)
        shapes.append(_shape(body.shape))
    row: Row = {
        "name": body.name,
        "kind": body.kind,
        "shape": places[body.shape],
        "at": row_of(body.at),
        "colour": list(body.colour),
    }
    if body.robot >= 0:
        row |= {"robot": body.robot, "link": body.link}
    if body.part >= 0:
        row["part"] = body.part
    if body.way is not None:
        row |= {"gripper": body.gripper, "way": np.round(body.way, 7).tolist(), "rest": body.rest_mm}
    return row


def _shape(shape: Shape) -> Row:
    facets = shape.facets
    return {"v": packed(facets.vertices, VERTEX_MM), "f": packed(facets.faces.astype(np.float64), 1.0)}


def _part(scene: Scene, places: Sequence[Placed]) -> list[list[object]]:
    """Places of a part by time: s, what it does, the robot that holds it or -1, its pose."""
    holders = {one.name: robot_of(scene.run, one.robot) for one in scene.run.layout.grippers}
    return [
        [round(one.t, 4), one.state, holders[one.on] if one.state == "held" else -1, row_of(one.pose)] for one in places
    ]


def _gripper(scene: Scene, number: int) -> Row:
    gripper = scene.run.layout.grippers[number]
    changes = [[round(one.t, 4), round(one.width_mm, 3)] for one in scene.run.openings if one.gripper == gripper.name]
    return {"name": gripper.name, "widths": [[0.0, first_width(gripper.opening)], *changes]}


def _signals(run: RobotRun, robot: int) -> list[Row]:
    rows, _ = signal_rows(run.result)
    return [
        {
            "robot": robot,
            "name": row.name,
            "kind": row.kind,
            "level": row.level,
            "changes": [[round(t, 4), height, text] for t, height, text, _ in row.changes],
        }
        for row in rows
    ]


def _events(scene: Scene, files: list[str]) -> list[Row]:
    """What is worth a mark on the time bar, by time: messages, warnings, faults, grasps, collisions."""
    found: list[Row] = []
    for number, robot in enumerate(scene.run.robots):
        for event in robot.result.trace:
            if event.kind in ("message", "warning", "fault"):
                text = str(event.data.get("text", event.data.get("message", "")))
                row: Row = {"t": round(event.t, 4), "kind": event.kind, "text": text, "robot": number}
                if event.origin.source is not None:
                    row |= {"file": files.index(event.origin.file), "line": event.origin.line}
                found.append(row)
    for grasp in scene.run.grasps:
        what = f"{grasp.gripper} grasps {grasp.part}" if grasp.ok else f"{grasp.gripper} holds nothing: {grasp.why}"
        found.append({"t": round(grasp.t, 4), "kind": "grasp" if grasp.ok else "misgrip", "text": what})
    for one in scene.collisions:
        row = {
            "t": round(one.t, 4),
            "kind": "collision",
            "text": f"{one.a} touches {one.b}, {one.depth_mm:.1f} mm deep",
            "until": round(one.until_s, 4),
            "names": [one.a, one.b],
            "point": [round(value, 2) for value in one.at_mm],
        }
        if one.origin.file in files:
            row |= {"file": files.index(one.origin.file), "line": one.origin.line}
        found.append(row)
    found.sort(key=lambda row: float(str(row["t"])))
    return found[:MOST_EVENTS]


def _file(path: str, short: str, source: Source, tracks: Sequence[Track]) -> Row:
    """A text in pieces, each with the number of its first line: whole, or what is around the lines of the run."""
    lines = source.text.splitlines()
    wanted = list(range(1, len(lines) + 1))
    if len(source.text) > MOST_TEXT:
        seen = {one.line for track in tracks for one in track.lines if one.file == path}
        near = {line + off for line in seen for off in range(-LINES_AROUND, LINES_AROUND + 1)}
        wanted = [line for line in wanted if line in near]
    pieces: list[tuple[int, list[str]]] = []
    for number in wanted:
        if not pieces or pieces[-1][0] + len(pieces[-1][1]) != number:
            pieces.append((number, []))
        pieces[-1][1].append(lines[number - 1])
    return {"name": short, "pieces": [[number, "\n".join(text)] for number, text in pieces]}
