"""The panels of the live view: buttons and fields, and texts about program, joints and signals. All texts of programs
go in escaped."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import PurePath
from typing import TYPE_CHECKING

from rpl.report.signals import SignalRow, signal_rows
from rpl.view.camera import VIEWS
from rpl.view.tracks import sources_of

if TYPE_CHECKING:
    import viser

    from rpl.view.screen import Screen

LINES_AROUND = 6
_TEXT = "font: 12px/1.45 ui-monospace, monospace; white-space: pre; overflow-x: auto; padding: 4px 12px"


class Panels:
    """What stands beside the scene. Made once; `show` brings it up to date."""

    def __init__(self, gui: viser.GuiApi, screen: Screen, speeds: Sequence[str]) -> None:
        self.screen = screen
        self.told = ""
        self.texts: dict[int, str] = {}
        run = screen.scene.run
        with gui.add_folder("Run"):
            self.play = gui.add_button("Play")
            self.time = gui.add_slider("time, s", 0.0, max(round(run.time_s, 3), 0.001), 0.001, 0.0)
            self.speed = gui.add_dropdown("speed", tuple(speeds), initial_value="1")
            self.before = gui.add_button("◂ line")
            self.after = gui.add_button("line ▸")
        names = [one.place.name for one in run.robots]
        self.robot = gui.add_dropdown("robot", tuple(names), initial_value=names[0]) if len(names) > 1 else None
        with gui.add_folder("Programs"):
            self.programs = gui.add_html("")
            self.line = gui.add_number("line", 1, min=1, step=1)
            self.run_line = gui.add_button("Run this line")
        with gui.add_folder("Arm"):
            self.arm = gui.add_html("")
        with gui.add_folder("Teach"):
            self.name = gui.add_text("name", "")
            self.teach = gui.add_button("Teach the point", hint="keeps where the arm is under this name")
            self.save = gui.add_button("Save it in the program", hint="one line of the program changes")
            self.onto = gui.add_button("Tool onto the frame", hint="a click on a surface makes a frame of this name")
            self.typed = gui.add_text("RPL", "MOVE LINEAR BY {z: -50} IN TOOL")
            self.enter = gui.add_button("Run the statement")
            self.said = gui.add_html("")
        with gui.add_folder("Inputs and outputs", expand_by_default=False):
            self.signals = gui.add_html("")
        with gui.add_folder("Camera", expand_by_default=False):
            self.views = {view: gui.add_button(view) for view in VIEWS}

    def notice(self, text: str) -> None:
        """A word about the arm that the person holds."""
        self.told = text

    def show(self) -> None:
        """Bring fields and texts up to date; only what has changed is sent."""
        screen = self.screen
        self.play.label = "Pause" if screen.playing else "Play"
        self.time.value = round(screen.time_s, 3)
        self._set(self.programs, programs_html(screen))
        self._set(self.arm, arm_html(screen, self.told))
        self._set(self.signals, signals_html(screen))
        self._set(self.said, f'<div style="padding: 4px 12px">{"<br>".join(map(escape, screen.said))}</div>')

    def _set(self, handle: viser.GuiHtmlHandle, text: str) -> None:
        if self.texts.get(id(handle)) != text:
            self.texts[id(handle)] = text
            handle.content = text


def programs_html(screen: Screen) -> str:
    """Of each robot the lines around the one that it is at."""
    sources = sources_of(screen.scene.run)
    parts = []
    for run, track in zip(screen.scene.run.robots, screen.scene.tracks, strict=True):
        here = track.line_at(screen.time_s)
        if here is None:
            continue
        lines = sources[here.file].text.splitlines()
        begin = max(here.line - 1 - LINES_AROUND, 0)
        rows = []
        for number, text in enumerate(lines[begin : here.line + LINES_AROUND], start=begin + 1):
            mark = "background: #fff1b8; color: #1d2733" if number == here.line else ""
            rows.append(f'<div style="{mark}"><span style="color: #98a4b0">{number:5d}  </span>{escape(text)}</div>')
        title = escape(f"{run.place.name} {PurePath(here.file).name}:{here.line}".strip())
        parts.append(f'<div style="padding: 2px 12px"><b>{title}</b></div><div style="{_TEXT}">{"".join(rows)}</div>')
    return "".join(parts)


def arm_html(screen: Screen, told: str) -> str:
    """Joints with their limits, the tool, and what is to be said of the posture."""
    if screen.run.model is None:
        return '<div style="padding: 4px 12px">The run had no robot.</div>'
    model, joints = screen.model, screen.here()
    rows = []
    for axis, value in enumerate(joints):
        unit = "deg" if model.revolute[axis] else "mm"
        low, high = model.limits[axis]
        rows.append(f"J{axis + 1}  {value:9.3f} {unit}   ({low:.4g} to {high:.4g})")
    x, y, z = screen.tool_pose()[:3, 3]
    rows.append(f"tool {x:.2f}, {y:.2f}, {z:.2f} mm")
    touches = [f"{one.a} touches {one.b} at {one.t:.2f} s" for one in screen.scene.collisions_at(screen.time_s)]
    words = [word for word in (told, *touches, *screen.margins()) if word]
    warning = f'<div style="padding: 0 12px; color: #c0392b">{"<br>".join(map(escape, dict.fromkeys(words)))}</div>'
    return f'<div style="{_TEXT}">{escape(chr(10).join(rows))}</div>{warning if words else ""}'


def signals_html(screen: Screen) -> str:
    """Values of all signals at the time."""
    several = len(screen.scene.run.robots) > 1
    rows = []
    for run in screen.scene.run.robots:
        for row in signal_rows(run.result)[0]:
            name = f"{run.place.name} {row.name}" if several else row.name
            rows.append(f"{value_at(row, screen.time_s):>8}  {row.kind:<6}  {name}")
    return f'<div style="{_TEXT}">{escape(chr(10).join(rows)) or "No signal changes."}</div>'


def value_at(row: SignalRow, t: float) -> str:
    """What a signal is at a time; "-" before its first change."""
    known = [text for since, _, text, _ in row.changes if since <= t + 1e-6]
    return known[-1] if known else "-"
