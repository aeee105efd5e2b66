"""Meshes of parts from files (STL, OBJ, PLY, GLB, STEP), in mm, closed and the right way out, or a message that says
what is wrong with the file and what to do.

A cell needs bodies with an inside: a mesh with holes has no volume, no centre of mass and no resting states.
"""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from rpl.cell.shapes import Mesh
from rpl.emulator.rotations import FloatArray
from rpl.errors import UsageError

# mm in a unit of the file. GLB is in metres by its specification (glTF 2.0, 3.4 Coordinate System and Units); STEP says
# its own unit and comes as metres out of the reader. The others say nothing, and parts are drawn in mm.
UNIT_MM = {".stl": 1.0, ".obj": 1.0, ".ply": 1.0, ".glb": 1000.0, ".step": 1000.0, ".stp": 1000.0}
STEP = (".step", ".stp")
SMALLEST_MM, LARGEST_MM = 0.5, 20_000.0  # of the longest side; beyond them the unit is doubted
_FLAT = 1e-12  # area of a degenerate triangle, in squares of the longest side
# What trimesh's readers raise on damaged files, a variable that was not set included.
_UNREADABLE = (ValueError, LookupError, TypeError, AttributeError, NameError, RuntimeError, ImportError, OSError)
# Facets of a STEP file are at most this far from the surface (mm), and turn at most by this angle from one to the next.
_STEP_AWAY_MM, _STEP_ANGLE_RAD = 0.02, 0.2
_STEP_LONGEST_S = 600.0
# In a process of its own: Open CASCADE writes to the terminal, and a damaged file can end it.
_CONVERT = (
    "import sys, cascadio; cascadio.step_to_glb(sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4]))"
)


def load_mesh(path: str | Path, scale: float | None = None, repair: bool = False) -> Mesh:
    """The mesh of a file, in mm: one body, whatever scene the file holds, in the frame of the file.

    scale: factor on all lengths, behind the unit of the format; with it sizes are believed as they are.
    repair: holes of three or four edges are closed and turned triangles turned back.
    Raises UsageError, with the file, where there is no such file, nothing in it, an edge is open, triangles face both
    ways, a library is missing, or the size looks off by 1,000.
    """
    place = Path(path)
    if not place.is_file():
        raise UsageError(f"{path}: there is no such file")
    kind = place.suffix.lower()
    if kind not in UNIT_MM:
        raise UsageError(f"{path}: meshes are read from {', '.join(UNIT_MM)}; convert it to one of these")
    if scale is not None and not (np.isfinite(scale) and scale > 0.0):
        raise UsageError(f"{path}: the scale {scale:g} is not a number above 0")
    read = _read(place, kind)
    if not len(read.faces):
        raise UsageError(f"{path}: there are no triangles in it; is it a {kind} file with a body?")
    vertices = np.asarray(read.vertices, dtype=np.float64)
    if read.faces.min() < 0 or read.faces.max() >= len(vertices) or not np.isfinite(vertices).all():
        raise UsageError(f"{path}: it has triangles without corners, or corners that are no numbers; export it again")
    read.apply_scale(UNIT_MM[kind] * (1.0 if scale is None else scale))
    if scale is None:
        _believable(path, float(read.extents.max()))
    with np.errstate(all="ignore"):
        _closed(read, path, repair)
    if read.volume < 0.0:
        read.invert()
    return Mesh(np.array(read.vertices, dtype=np.float64), np.array(read.faces, dtype=np.int64), str(path))


def mesh_of(vertices: FloatArray, faces: np.ndarray, path: str = "") -> Mesh:
    """Triangles that a program made, under the same checks as those of a file. Raises UsageError as `load_mesh`."""
    read = _trimesh().Trimesh(vertices, faces)
    _closed(read, path or "the mesh", False)
    if read.volume < 0.0:
        read.invert()
    return Mesh(np.array(read.vertices, dtype=np.float64), np.array(read.faces, dtype=np.int64), path)


def _trimesh() -> Any:
    try:
        import trimesh
    except ImportError:
        raise UsageError("meshes need the package trimesh: pip install 'robot-rpl[cell]'") from None
    return trimesh


def _read(path: Path, kind: str) -> Any:
    trimesh = _trimesh()
    try:
        if kind in STEP:
            with TemporaryDirectory() as folder:
                return trimesh.load_scene(_converted(path, Path(folder) / "part.glb")).to_mesh()
        if kind == ".stl" and _is_cut_off(path):
            raise ValueError("fewer triangles than it says")
        return trimesh.load_scene(path, **({"skip_materials": True} if kind == ".obj" else {})).to_mesh()
    except _UNREADABLE as error:
        raise UsageError(
            f"{path}: it cannot be read as {kind}: it is damaged, or something else; export it again"
        ) from error


def _is_cut_off(path: Path) -> bool:
    """Has a binary STL less than its head says: 80 bytes of text, the number of triangles, 50 bytes for each?"""
    with path.open("rb") as file:
        head = file.read(84)
    if len(head) < 84 or head.lstrip()[:5].lower() == b"solid":  # none, or one of text
        return False
    return path.stat().st_size < 84 + 50 * int.from_bytes(head[80:84], "little")


def _converted(path: Path, into: Path) -> Path:
    """A STEP file as GLB, in metres. Raises OSError where it cannot be."""
    if find_spec("cascadio") is None:
        raise UsageError(
            f"{path}: STEP needs the package cascadio: pip install 'robot-rpl[step]'; or export it as STL in mm"
        )
    words = [sys.executable, "-c", _CONVERT, str(path.absolute()), str(into), str(_STEP_AWAY_MM), str(_STEP_ANGLE_RAD)]
    try:
        done = subprocess.run(words, capture_output=True, timeout=_STEP_LONGEST_S)
    except subprocess.TimeoutExpired:
        raise UsageError(f"{path}: it was not converted in {_STEP_LONGEST_S:g} s; export it as STL in mm") from None
    if done.returncode or not into.is_file():
        raise OSError("no result")
    return into


def _believable(path: str | Path, longest_mm: float) -> None:
    if longest_mm > LARGEST_MM:
        raise UsageError(
            f"{path}: it is {longest_mm / 1000.0:,.4g} m long when read in mm; if its unit is another, give the scale "
            "(0.001 when it should be a thousandth of that), else a scale of 1"
        )
    if longest_mm < SMALLEST_MM:
        raise UsageError(
            f"{path}: it is {longest_mm:.4g} mm long when read in mm; if it is in metres give a scale of 1000, in "
            "inches 25.4, if it is so small a scale of 1"
        )


def _closed(read: Any, path: str | Path, repair: bool) -> None:
    """Corners that lie on each other are one, triangles without area go; then every edge must have two triangles."""
    read.merge_vertices(merge_tex=True, merge_norm=True)
    longest = float(read.extents.max()) if len(read.vertices) else 0.0
    solid = np.asarray(read.area_faces) > _FLAT * longest**2
    dropped = int((~solid).sum())
    if dropped and _open_edges(read.faces[solid]) <= _open_edges(read.faces):
        read.update_faces(solid)
        read.remove_unreferenced_vertices()
    if not len(read.faces) or longest <= 0.0:
        raise UsageError(f"{path}: all its triangles are degenerate: they have no area")
    if repair:
        _repaired(read)
    if still := _open_edges(read.faces):
        flat = f" (and {dropped} triangles without area)" if dropped else ""
        raise UsageError(
            f"{path}: the mesh has holes: {still} edges do not have two triangles{flat}; --repair closes small ones, "
            "else close it where it was drawn (export it as a solid)"
        )
    if not read.is_winding_consistent:
        raise UsageError(f"{path}: triangles beside each other face opposite ways; --repair turns them")
    if abs(float(read.volume)) <= 1e-9 * longest**3:
        raise UsageError(f"{path}: the mesh encloses nothing: it is flat")


def _repaired(read: Any) -> None:
    repair = import_module("trimesh.repair")
    try:
        repair.fill_holes(read)
        repair.fix_normals(read)
    except ImportError:
        raise UsageError("--repair needs the package networkx: pip install 'robot-rpl[cell]'") from None


def _open_edges(faces: Any) -> int:
    """Edges that do not have exactly two triangles."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    return int((counts != 2).sum())
