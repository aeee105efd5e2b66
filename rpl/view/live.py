"""The live view: the interactive screen (`rpl.view.screen`) in a browser, by viser.

Here stand only the wires: what is clicked and dragged goes to the screen, what the screen says goes to the browser.
viser counts in metres. Its callbacks come on threads of their own: everything that touches the screen holds the lock.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from typing import TYPE_CHECKING

import numpy as np

from rpl.cell.shapes import Capsule, Mesh, Sphere
from rpl.emulator.rotations import FloatArray, matrix_to_quaternion, quaternion_to_matrix
from rpl.errors import RplError, UsageError
from rpl.view import livepanels
from rpl.view.camera import VIEWS, Camera
from rpl.view.picture import SPEEDS, bounds_of
from rpl.view.screen import Screen

if TYPE_CHECKING:
    import viser

MISSING = "the live view needs the package viser: pip install 'robot-rpl[view]' (--save F.html works without it)"
PERIOD_S = 0.04
SPEEDS_OF_PLAY = ("0.1", "0.25", "0.5", "1", "2", "5", "10")
_M = 0.001
MOST_TOUCHES = 200


class Live:
    """A server that shows a screen. `port` 0 takes a free one."""

    def __init__(self, screen: Screen, host: str, port: int, title: str) -> None:
        try:
            import viser
        except ImportError as error:
            raise UsageError(MISSING) from error
        self.screen = screen
        self.lock = threading.RLock()
        self.ended = threading.Event()
        self.shown_s = -1.0
        self.dragging = False
        try:
            with redirect_stdout(StringIO()):  # it greets there
                self.server = viser.ViserServer(host=host, port=port, label=title, verbose=False)
        except OSError as error:
            raise UsageError(f"cannot listen on {host}:{port}: {error.strerror or error}") from None
        self.server.gui.configure_theme(control_width="large", show_logo=False, show_share_button=False)
        self.server.gui.main_panel.dock_right()
        self._scene()
        self._panels()
        self.show()

    @property
    def address(self) -> str:
        """Where a browser finds it."""
        return f"http://{self.server.get_host()}:{self.server.get_port()}"

    def serve(self) -> None:
        """Play until `stop`, which another thread or a signal calls."""
        before = time.monotonic()
        while not self.ended.wait(PERIOD_S):
            now = time.monotonic()
            with self.lock:
                if self.screen.tick(now - before):
                    self.show()
            before = now

    def stop(self) -> None:
        """End serving and free the port."""
        self.ended.set()
        self.server.stop()

    # ---- the scene

    def _scene(self) -> None:
        scene, api = self.screen.scene, self.server.scene
        bounds = bounds_of(scene)
        extent = float(np.linalg.norm(bounds[1] - bounds[0])) * _M
        api.set_up_direction("+z")
        api.add_grid(
            "/ground",
            width=3.0 * extent,
            height=3.0 * extent,
            cell_size=0.1,
            section_size=1.0,
            position=(0.0, 0.0, min(float(bounds[0, 2]), 0.0) * _M - 0.002),
        )
        self.nodes: list[viser.MeshHandle] = []
        for number, body in enumerate(scene.bodies):
            facets = body.shape.facets
            node = api.add_mesh_simple(
                f"/bodies/{number}",
                vertices=(facets.vertices * _M).astype(np.float32),
                faces=facets.faces.astype(np.uint32),
                color=body.colour,
                flat_shading=not isinstance(body.shape, Sphere | Capsule | Mesh),
                opacity=0.25 if body.kind == "sensor" else None,
                side="double",
            )
            if body.kind != "sensor":
                node.on_click(self._clicked(number))
            self.nodes.append(node)
        self._paths()
        self._marks(extent)
        self.gizmo = None
        if any(run.model is not None for run in scene.run.robots):
            self.gizmo = api.add_transform_controls("/tool", scale=0.12 * extent, depth_test=False)
            self.gizmo.on_update(self._dragged)
        self._look("isometric", self.server.initial_camera)

    def _marks(self, extent: float) -> None:
        """The frames of the cell and of its robots, and where something touches, seen around that time only."""
        api, scene = self.server.scene, self.screen.scene
        api.add_frame("/cell", axes_length=0.07 * extent, axes_radius=0.001 * extent)
        for number, run in enumerate(scene.run.robots):
            axes = {"axes_length": 0.05 * extent, "axes_radius": 0.001 * extent}
            api.add_frame(f"/bases/{number}", **axes, **_placed(run.place.base))
        self.touches = [
            api.add_icosphere(
                f"/touches/{number}",
                radius=0.015 * extent,
                color=(217, 30, 30),
                position=tuple(float(value) * _M for value in one.at_mm),
                visible=False,
            )
            for number, one in enumerate(scene.collisions[:MOST_TOUCHES])
        ]

    def _paths(self) -> None:
        """The paths of the tools, coloured by speed."""
        fastest = max((float(track.speeds.max(initial=1.0)) for track in self.screen.scene.tracks), default=1.0)
        for number, track in enumerate(self.screen.scene.tracks):
            if len(track.tool) < 2:
                continue
            share = track.speeds / fastest * (len(SPEEDS) - 1)
            tints = np.stack([np.interp(share, np.arange(len(SPEEDS)), part) for part in SPEEDS.T], axis=1)
            self.server.scene.add_line_segments(
                f"/path/{number}",
                points=(np.stack([track.tool[:-1], track.tool[1:]], axis=1) * _M).astype(np.float32),
                colors=np.stack([tints[:-1], tints[1:]], axis=1).astype(np.uint8),
                thickness=2.5,
                thickness_units="screen",
            )

    def _look(self, view: str, camera: viser.InitialCameraConfig | viser.CameraHandle) -> None:
        seen = Camera.around(bounds_of(self.screen.scene), view)
        camera.position = tuple((seen.eye * _M).tolist())
        camera.look_at = tuple((seen.target * _M).tolist())
        camera.fov = np.deg2rad(30.0)

    def _clicked(self, number: int) -> Callable[[viser.SceneNodePointerEvent[viser.MeshHandle]], None]:
        def clicked(event: viser.SceneNodePointerEvent[viser.MeshHandle]) -> None:
            with self.working():
                start, way = np.array(event.ray_origin) / _M, np.array(event.ray_direction)
                frame = self.screen.frame_on(number, start, way, self.panels.name.value.strip())
                name = next(reversed(self.screen.frames))
                self.server.scene.add_frame(f"/frames/{name}", axes_length=0.06, axes_radius=0.002, **_placed(frame))
                self.server.scene.add_label(f"/frames/{name}/label", name)

        return clicked

    def _dragged(self, event: viser.TransformControlsEvent) -> None:
        if event.client is None:  # set by ourselves
            return
        with self.working():
            self.dragging = event.phase != "end"
            pose = np.eye(4)
            pose[:3, :3] = quaternion_to_matrix(np.array(event.target.wxyz))
            pose[:3, 3] = np.array(event.target.position) / _M
            self.panels.notice("; ".join(self.screen.drag(pose)))

    # ---- what the person does

    def _panels(self) -> None:
        self.panels = livepanels.Panels(self.server.gui, self.screen, SPEEDS_OF_PLAY)
        panels, screen = self.panels, self.screen
        acts: list[tuple[viser.GuiButtonHandle, Callable[[], object]]] = [
            (panels.play, screen.play),
            (panels.before, lambda: screen.step(-1)),
            (panels.after, lambda: screen.step(1)),
            (panels.teach, lambda: screen.teach(panels.name.value.strip())),
            (panels.save, self._save),
            (panels.onto, lambda: panels.notice("; ".join(screen.go_to_frame(panels.name.value.strip())))),
            (panels.enter, lambda: screen.enter(panels.typed.value)),
            (panels.run_line, self._run_line),
        ]
        for button, act in acts:
            button.on_click(self._doing(act))
        panels.time.on_update(self._scrubbed)
        panels.speed.on_update(lambda _: setattr(screen, "speed", float(panels.speed.value)))
        if panels.robot is not None:
            panels.robot.on_update(self._chosen)
        for view in VIEWS:
            panels.views[view].on_click(self._viewing(view))

    def _doing(self, act: Callable[[], object]) -> Callable[[object], None]:
        def done(_: object) -> None:
            with self.working():
                act()

        return done

    def _viewing(self, view: str) -> Callable[[viser.GuiEvent[viser.GuiButtonHandle]], None]:
        def look(event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
            if event.client is not None:
                self._look(view, event.client.camera)

        return look

    def _scrubbed(self, event: viser.GuiEvent[viser.GuiSliderHandle[float]]) -> None:
        if event.client is not None:
            with self.working():
                self.screen.playing = False
                self.screen.go(float(event.target.value))

    def _chosen(self, _: object) -> None:
        with self.working():
            names = [run.place.name for run in self.screen.scene.run.robots]
            assert self.panels.robot is not None
            self.screen.robot = names.index(self.panels.robot.value)

    def _save(self) -> None:
        self.screen.save(self.panels.name.value.strip())
        self._paths()

    def _run_line(self) -> None:
        here = self.screen.scene.tracks[self.screen.robot].line_at(self.screen.time_s)
        if here is not None:
            self.screen.run_line(here.file, int(self.panels.line.value))

    @contextmanager
    def working(self) -> Iterator[None]:
        """Something is done to the screen: mistakes are said on it, then everything is shown anew."""
        with self.lock:
            try:
                yield
            except RplError as error:
                self.screen.say(str(error))
            self.show()

    # ---- what is shown

    def show(self) -> None:
        """Bring the browser up to date."""
        screen = self.screen
        with self.server.atomic():
            for node, pose in zip(self.nodes, screen.poses(), strict=True):
                if (node.visible) != (pose is not None):
                    node.visible = pose is not None
                if pose is not None:
                    _place(node, pose)
            now = {id(one) for one in screen.scene.collisions_at(screen.time_s)}
            for mark, one in zip(self.touches, screen.scene.collisions, strict=False):
                if mark.visible != (id(one) in now):
                    mark.visible = id(one) in now
            if self.gizmo is not None and not self.dragging and screen.run.model is not None:
                _place(self.gizmo, screen.tool_pose())
        self.panels.show()


def _placed(pose: FloatArray) -> dict[str, tuple[float, ...]]:
    turned = matrix_to_quaternion(pose[:3, :3])
    return {"wxyz": tuple(turned.tolist()), "position": tuple((pose[:3, 3] * _M).tolist())}


def _place(node: viser.SceneNodeHandle, pose: FloatArray) -> None:
    placed = _placed(pose)
    node.wxyz, node.position = placed["wxyz"], placed["position"]
