"""A picture of a moment of a run, as a PNG file: the same bodies, path, colours and camera as on the page."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rpl.cell.shapes import Facets, Shape, Sphere, moved
from rpl.emulator.rotations import FloatArray
from rpl.view.camera import Camera
from rpl.view.raster import NOTHING, Canvas, barycentric, png
from rpl.view.scene import Scene

SIZE = (1200, 800)
FINER = 2  # each pixel is the mean of so many squared
GROUND, RULE, RED, MAGENTA = (241.0, 244.0, 247.0), (205.0, 213.0, 221.0), (217.0, 30.0, 30.0), (230.0, 0.0, 122.0)
AXES = ((214.0, 39.0, 40.0), (44.0, 140.0, 44.0), (31.0, 90.0, 200.0))
# Slow to fast.
SPEEDS = np.array(
    [(44, 47, 160), (31, 127, 208), (23, 182, 164), (122, 209, 81), (253, 231, 37), (249, 142, 9), (215, 48, 31)], float
)
ROUND = np.cos(np.deg2rad(32.0))  # faces that meet at less look round, those that meet at more have an edge
NEARER = 4e-3  # a line on a face is drawn on it, not in it: by this share of its depth


@lru_cache(maxsize=512)
def _shading(shape: Shape) -> tuple[FloatArray, FloatArray]:
    """Normals at the corners (m, 3, 3) of the facets that make round faces look round, and the edges (e, 2, 3)."""
    facets = shape.facets
    _, welded = np.unique(np.round(facets.vertices, 3), axis=0, return_inverse=True)
    corners = welded.reshape(-1)[facets.faces]
    return _normals(facets, corners), _edges(facets, corners)


def _normals(facets: Facets, corners: NDArray[np.int64]) -> FloatArray:
    """At each corner the mean of the faces around it that meet its own at less than 32 deg, by their areas."""
    a, b, c = (facets.vertices[facets.faces[:, place]] for place in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    around: dict[int, list[int]] = {}
    for face, three in enumerate(corners.tolist()):
        for corner in three:
            around.setdefault(corner, []).append(face)
    found = np.zeros((*corners.shape, 3))
    for face, three in enumerate(corners.tolist()):
        for place, corner in enumerate(three):
            near = np.array(around[corner])
            alike = near[facets.normals[near] @ facets.normals[face] > ROUND]
            found[face, place] = areas[alike] @ facets.normals[alike]
    return np.asarray(found / np.maximum(np.linalg.norm(found, axis=2, keepdims=True), 1e-12))


def _edges(facets: Facets, corners: NDArray[np.int64]) -> FloatArray:
    """Sides of faces that meet no other one, or one at 32 deg or more."""
    sides: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for face, three in enumerate(corners.tolist()):
        for place in range(3):
            pair = (three[place], three[(place + 1) % 3])
            sides.setdefault((min(pair), max(pair)), []).append((face, place))
    found = []
    for uses in sides.values():
        face, place = uses[0]
        if len(uses) == 1 or float(facets.normals[face] @ facets.normals[uses[1][0]]) < ROUND:
            row = facets.faces[face]
            found.append((facets.vertices[row[place]], facets.vertices[row[(place + 1) % 3]]))
    return np.array(found).reshape(-1, 2, 3)


def picture(scene: Scene, t: float, view: str = "isometric", size: tuple[int, int] = SIZE) -> bytes:
    """The cell at a time from one of the views (`rpl.view.camera.VIEWS`), as a PNG file."""
    width, height = size[0] * FINER, size[1] * FINER
    bounds = bounds_of(scene)
    drawn = _Picture(scene, t, Camera.around(bounds, view, width / height), bounds, width, height)
    fine = drawn.pixels.reshape(size[1], FINER, size[0], FINER, 3).mean(axis=(1, 3))
    return png(np.rint(np.clip(fine, 0.0, 255.0)).astype(np.uint8))


def bounds_of(scene: Scene) -> FloatArray:
    """A box (2, 3) around everything at the start, and the paths of the tools."""
    points = [
        moved(body.shape.facets.vertices, pose)
        for body, pose in zip(scene.bodies, scene.poses_at(0.0), strict=True)
        if pose is not None
    ]
    points += [track.tool for track in scene.tracks if len(track.tool)]
    if not points:
        return np.array([[-500.0, -500.0, 0.0], [500.0, 500.0, 500.0]])
    every = np.vstack(points)
    return np.stack([every.min(axis=0), every.max(axis=0)])


class _Picture:
    """What is drawn, in the order in which it is: ground, bodies with their edges, paths, frames, sensors."""

    def __init__(self, scene: Scene, t: float, camera: Camera, bounds: FloatArray, width: int, height: int) -> None:
        self.scene, self.camera, self.canvas = scene, camera, Canvas(width, height)
        self.pixels: FloatArray = np.tile(np.array(GROUND), (width * height, 1))
        poses = scene.poses_at(t)
        now = scene.collisions_at(t)
        names = {name for one in now for name in (one.a, one.b)}
        extent = max(float(np.linalg.norm(bounds[1] - bounds[0])) / 2.0, 100.0)
        rows = [
            (body.shape, _behind(pose, body.link, camera), RED if body.name in names else body.colour)
            for body, pose in zip(scene.bodies, poses, strict=True)
            if body.kind != "sensor" and pose is not None
        ]
        for one in now:
            rows.append((Sphere(extent * 0.035), _at(np.array(one.at_mm)), RED))
        self._lines(*_grid(bounds, extent), 1.0, test=False)
        self._bodies(rows)
        self._paths()
        joints = scene.joints_at(t)
        frames = [np.eye(4)]
        for number, q in enumerate(joints):
            if q is not None:
                flange = scene.flange_at(number, q, t)
                tool = flange @ scene.tracks[number].tool_at(t)
                frames += [scene.base_at(number, t), tool]
                stick = np.stack([flange[:3, 3], tool[:3, 3]])[None]
                self._lines(stick, np.array([(70.0, 80.0, 92.0)]), 4.0)
        for frame in frames:
            ends = np.stack([np.tile(frame[:3, 3], (3, 1)), frame[:3, 3] + frame[:3, :3].T * (0.09 * extent)], axis=1)
            self._lines(ends, np.array(AXES), 3.0, test=False)
        for body, pose in zip(scene.bodies, poses, strict=True):
            if body.kind == "sensor" and pose is not None:
                self._through(body.shape, pose, np.array(body.colour, float))

    def _seen(self, points: FloatArray) -> FloatArray:
        return self.camera.seen(points, self.canvas.width, self.canvas.height)

    def _bodies(self, rows: list[tuple[Shape, FloatArray, tuple[float, float, float]]]) -> None:
        corners, normals, colours, edges, darker = [], [], [], [], []
        for shape, pose, colour in rows:
            facets, (normal, edge) = shape.facets, _shading(shape)
            corners.append(moved(facets.vertices, pose)[facets.faces])
            normals.append(normal @ pose[:3, :3].T)
            colours.append(np.tile(np.array(colour, float), (len(facets.faces), 1)))
            edges.append(moved(edge.reshape(-1, 3), pose).reshape(-1, 2, 3))
            darker.append(np.tile(0.42 * np.array(colour, float), (len(edge), 1)))
        if not rows:
            return
        places, tints = np.vstack(corners), np.vstack(colours)
        self.canvas.triangles(self._seen(places))
        seen = np.flatnonzero(self.canvas.owner != NOTHING)
        self.pixels[seen] = self._lit(places, np.vstack(normals), tints, self.canvas, seen)
        self._lines(np.vstack(edges), np.vstack(darker), 1.5)

    def _lit(
        self, places: FloatArray, normals: FloatArray, tints: FloatArray, canvas: Canvas, seen: NDArray[np.int64]
    ) -> FloatArray:
        """Colours (k, 3) of the pixels: light from beside the eye and from above, as in `player/drawing.js`."""
        owner = canvas.owner[seen]
        flat = self._seen(places)[owner][:, :, :2]
        rows, columns = np.divmod(seen, canvas.width)
        share = barycentric(flat, np.add(columns, 0.5, dtype=np.float64), np.add(rows, 0.5, dtype=np.float64))
        n = np.einsum("kc,kcx->kx", share, normals[owner])
        n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-12)
        to_eye = self.camera.eye - np.einsum("kc,kcx->kx", share, places[owner])
        to_eye /= np.linalg.norm(to_eye, axis=1, keepdims=True)
        n = np.where((n * to_eye).sum(axis=1, keepdims=True) < 0.0, -n, n)
        key = to_eye + np.array([0.25, -0.35, 0.9])
        key /= np.linalg.norm(key, axis=1, keepdims=True)
        facing = (n * key).sum(axis=1)
        mirrored = 2.0 * facing[:, None] * n - key
        spark = 0.16 * np.maximum((mirrored * to_eye).sum(axis=1), 0.0) ** 24
        light = 0.40 + 0.14 * n[:, 2] + 0.52 * np.maximum(facing, 0.0)
        return np.asarray(tints[owner] * light[:, None] + 255.0 * spark[:, None])

    def _lines(self, ends: FloatArray, colours: FloatArray, width: float, test: bool = True) -> None:
        """Lines (m, 2, 3) in the cell with a colour each; `test`: behind bodies they are not seen."""
        place, line, depth = self.canvas.lines(self._seen(ends), width * FINER)
        if test:
            before = depth * (1.0 + NEARER) <= self.canvas.depth[place]
            place, line, depth = place[before], line[before], depth[before]
        order = np.argsort(-depth, kind="stable")  # the nearest last
        self.pixels[place[order]] = colours[line[order]]

    def _paths(self) -> None:
        fastest = max((float(track.speeds.max()) for track in self.scene.tracks if len(track.speeds)), default=1.0)
        for track in self.scene.tracks:
            if len(track.tool) > 1:
                share = track.speeds[:-1] / max(fastest, 1.0) * (len(SPEEDS) - 1)
                colours = np.stack([np.interp(share, np.arange(len(SPEEDS)), part) for part in SPEEDS.T], axis=1)
                self._lines(np.stack([track.tool[:-1], track.tool[1:]], axis=1), colours, 2.2)

    def _through(self, shape: Shape, pose: FloatArray, colour: FloatArray) -> None:
        """A body that one sees through."""
        glass = Canvas(self.canvas.width, self.canvas.height)
        glass.triangles(self._seen(moved(shape.facets.vertices, pose)[shape.facets.faces]))
        seen = (glass.owner != NOTHING) & (glass.depth < self.canvas.depth)
        self.pixels[seen] = 0.72 * self.pixels[seen] + 0.28 * colour


def _behind(pose: FloatArray, link: int, camera: Camera) -> FloatArray:
    """Links overlap at their joints; every second one stands a little behind, so that their faces do not mix."""
    if link < 0 or link % 2 == 0:
        return pose
    return _at(-1e-4 * camera.distance * camera.axes[2]) @ pose


def _at(point: FloatArray) -> FloatArray:
    pose = np.eye(4)
    pose[:3, 3] = point
    return pose


def _grid(bounds: FloatArray, extent: float) -> tuple[FloatArray, FloatArray]:
    """Lines on the ground below everything, and their colours."""
    step = next((one for one in (100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0) if extent / one < 14.0), 10000.0)
    floor = min(float(bounds[0, 2]), 0.0) - 1.0
    low = np.floor((bounds[0, :2] - 0.3 * extent) / step) * step
    high = np.ceil((bounds[1, :2] + 0.3 * extent) / step) * step
    rows = [((x, low[1], floor), (x, high[1], floor)) for x in np.arange(low[0], high[0] + 1.0, step)]
    rows += [((low[0], y, floor), (high[0], y, floor)) for y in np.arange(low[1], high[1] + 1.0, step)]
    # In short pieces: one that reaches behind the camera is not seen at all.
    ends = np.array(rows)
    shares = np.linspace(0.0, 1.0, 21)
    points = ends[:, None, 0] + shares[None, :, None] * (ends[:, None, 1] - ends[:, None, 0])
    pieces = np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 3)
    return pieces, np.tile(np.array(RULE), (len(pieces), 1))
