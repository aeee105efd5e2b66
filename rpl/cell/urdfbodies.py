"""The bodies of a URDF: its collision meshes and forms, else the visual ones, link by link.

A mesh is found beside the URDF: `package://name/rest` in a folder `name` above it, other names from the URDF's own
folder. What cannot be read is a note, and the capsules of that link stay.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote

import numpy as np

from rpl.cell.shapes import Box, Capsule, Cylinder, Mesh, Shape, Sphere
from rpl.emulator.chains import body_frames
from rpl.emulator.rotations import FloatArray, pose_matrix, rotation_x, rotation_y, rotation_z

if TYPE_CHECKING:
    from rpl.emulator.model import UrdfSource

_MM = 1000.0


def urdf_bodies(source: UrdfSource) -> tuple[list[tuple[int, Shape, FloatArray]], dict[int, str]]:
    """The bodies: number of the link, form, and pose (4, 4) in mm in the base where the arm's own variables are zero;
    and for the numbers of links that lack one, what could not be read."""
    frames = body_frames(source.chain, source.zero)
    bodies: list[tuple[int, Shape, FloatArray]] = []
    lacking: dict[int, str] = {}
    for link in ET.fromstring(source.chain.text).findall("link"):
        name = link.get("name", "")
        if name not in frames:
            continue
        number, frame = frames[name]
        for element in link.findall("collision") or link.findall("visual"):
            try:
                shape = _shape(element.find("geometry"), source.path)
            except ValueError as error:
                lacking[number] = f"{source.path.name}: link '{name}': {error}; a capsule stands for it"
                continue
            if shape is not None:
                bodies.append((number, shape, np.asarray(frame @ _origin(element.find("origin")))))
    return bodies, lacking


def _origin(origin: ET.Element | None) -> FloatArray:
    """A pose (4, 4) in mm of `xyz` and `rpy` (about fixed x, y, z)."""
    if origin is None:
        return np.eye(4)
    x, y, z = _numbers(origin.get("xyz", "0 0 0"), 3)
    roll, pitch, yaw = _numbers(origin.get("rpy", "0 0 0"), 3)
    return pose_matrix(np.array([x, y, z]) * _MM, rotation_z(yaw) @ rotation_y(pitch) @ rotation_x(roll))


def _numbers(text: str, count: int) -> list[float]:
    """Raises ValueError for what are not that many numbers."""
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError as error:
        raise ValueError(f"'{text}' are no numbers") from error
    if len(numbers) != count or not all(math.isfinite(number) for number in numbers):
        raise ValueError(f"'{text}' are not {count} numbers")
    return numbers


def _shape(geometry: ET.Element | None, urdf: Path) -> Shape | None:
    """The form in mm; None where there is none. Raises ValueError for one that cannot be had."""
    if geometry is None or len(geometry) == 0:
        return None
    form = geometry[0]
    if form.tag == "mesh":
        scale = np.array(_numbers(form.get("scale", "1 1 1"), 3)) * _MM
        return read_mesh(_found(form.get("filename", ""), urdf), scale)
    match form.tag:
        case "box":
            x, y, z = _numbers(form.get("size", ""), 3)
            shape: Shape = Box((x * _MM, y * _MM, z * _MM))
            smallest = min(x, y, z)
        case "sphere":
            (radius,) = _numbers(form.get("radius", ""), 1)
            smallest = radius
            shape = Sphere(2.0 * radius * _MM)
        case "cylinder" | "capsule":
            (radius,), (length,) = _numbers(form.get("radius", ""), 1), _numbers(form.get("length", ""), 1)
            smallest = min(radius, length)
            kind = Cylinder if form.tag == "cylinder" else Capsule
            shape = kind(2.0 * radius * _MM, length * _MM)
        case _:
            raise ValueError(f"a form '{form.tag}' is not known")
    if smallest <= 0.0:
        raise ValueError(f"its {form.tag} has no size")
    return shape


def _found(name: str, urdf: Path) -> Path:
    """The file of a mesh; ValueError where there is none."""
    if name.startswith("package://"):
        package, _, rest = unquote(name.removeprefix("package://")).partition("/")
        for folder in urdf.resolve().parents:
            candidates = (folder / rest, folder.parent / rest) if folder.name == package else (folder / package / rest,)
            for candidate in candidates:
                if candidate.is_file():
                    return candidate
        raise ValueError(f"the mesh '{name}' is in no folder '{package}' above it")
    path = Path(unquote(name.removeprefix("file://")))
    if not (found := path if path.is_absolute() else urdf.parent / path).is_file():
        raise ValueError(f"the mesh '{name}' is not there")
    return found


def read_mesh(path: Path, scale: FloatArray) -> Mesh:
    """The triangles of a file in any form that coal reads (STL, OBJ, DAE, ...), times `scale` (3,).

    Raises ValueError for a file that holds none.
    """
    import coal

    try:
        model = coal.MeshLoader().load(str(path), scale)
        vertices = np.array(model.vertices(), dtype=np.float64)
        found = [model.tri_indices(number) for number in range(model.num_tris)]
        faces = np.array([(one[0], one[1], one[2]) for one in found], dtype=np.int64)
    except (ValueError, RuntimeError) as error:
        raise ValueError(f"the mesh '{path.name}' cannot be read: {str(error).strip().splitlines()[0]}") from error
    if not len(faces) or not np.isfinite(vertices).all():
        raise ValueError(f"the mesh '{path.name}' holds no triangles")
    if float(np.prod(scale)) < 0.0:
        faces = faces[:, ::-1].copy()  # mirrored: inside out again
    return Mesh(vertices, faces, str(path))
