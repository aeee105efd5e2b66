"""Meshes from files: the same part in every format, and what is said of files that are no body."""

import struct
import sys
from pathlib import Path

import numpy as np
import pytest

from rpl.cell.meshes import load_mesh, mesh_of
from rpl.cell.shapes import Box, Facets, Mesh
from rpl.errors import UsageError

PART = Box((20.0, 30.0, 40.0)).facets


def stl(solid: Facets, scale: float = 1.0) -> bytes:
    rows = [struct.pack("<12fH", 0, 0, 0, *(scale * solid.vertices[face]).ravel(), 0) for face in solid.faces]
    return bytes(80) + struct.pack("<I", len(rows)) + b"".join(rows)


def obj(solid: Facets) -> bytes:
    corners = [f"v {x} {y} {z}" for x, y, z in solid.vertices]
    return "\n".join([*corners, *(f"f {a} {b} {c}" for a, b, c in solid.faces + 1), ""]).encode()


def ply(solid: Facets) -> bytes:
    head = f"ply\nformat ascii 1.0\nelement vertex {len(solid.vertices)}\nproperty float x\nproperty float y\n"
    head += f"property float z\nelement face {len(solid.faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    corners = [f"{x} {y} {z}\n" for x, y, z in solid.vertices]
    return (head + "".join([*corners, *(f"3 {a} {b} {c}\n" for a, b, c in solid.faces)])).encode()


def glb(solid: Facets) -> bytes:
    """In metres, by trimesh's own writer."""
    import trimesh

    return bytes(trimesh.Trimesh(solid.vertices / 1000.0, solid.faces).export(file_type="glb"))


def step(solid: Facets) -> bytes:
    """A faceted body in mm, written by hand after ISO 10303-42 (FACETED_BREP)."""
    rows = [
        "#1=APPLICATION_CONTEXT('mechanical design');",
        "#2=PRODUCT_CONTEXT('',#1,'mechanical');",
        "#3=PRODUCT('part','part','',(#2));",
        "#4=PRODUCT_DEFINITION_FORMATION('','',#3);",
        "#5=PRODUCT_DEFINITION_CONTEXT('part definition',#1,'design');",
        "#6=PRODUCT_DEFINITION('design','',#4,#5);",
        "#7=PRODUCT_DEFINITION_SHAPE('','',#6);",
        "#8=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));",
        "#9=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));",
        "#10=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());",
        "#11=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-6),#8,'distance_accuracy_value','');",
        "#12=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#11))"
        "GLOBAL_UNIT_ASSIGNED_CONTEXT((#8,#9,#10))REPRESENTATION_CONTEXT('',''));",
        "#13=SHAPE_DEFINITION_REPRESENTATION(#7,#14);",
        "#14=FACETED_BREP_SHAPE_REPRESENTATION('',(#15),#12);",
        "#15=FACETED_BREP('',#16);",
    ]
    number, faces = 100, []

    def row(text: str) -> str:
        nonlocal number
        number += 1
        rows.append(f"#{number}={text};")
        return f"#{number}"

    def vector(kind: str, values: np.ndarray) -> str:
        return row(f"{kind}('',({','.join(f'{value:.9E}' for value in values)}))")

    for face, normal in zip(solid.faces, solid.normals, strict=True):
        corners = solid.vertices[face]
        places = [vector("CARTESIAN_POINT", corner) for corner in corners]
        along = corners[1] - corners[0]
        directions = [vector("DIRECTION", normal), vector("DIRECTION", along / np.linalg.norm(along))]
        axes = row(f"AXIS2_PLACEMENT_3D('',{places[0]},{','.join(directions)})")
        plane = row(f"PLANE('',{axes})")
        loop = row(f"POLY_LOOP('',({','.join(places)}))")
        bound = row(f"FACE_OUTER_BOUND('',{loop},.T.)")
        faces.append(row(f"FACE_SURFACE('',({bound}),{plane},.T.)"))
    rows.append(f"#16=CLOSED_SHELL('',({','.join(faces)}));")
    head = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
    head += "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
    return (head + "\n".join(rows) + "\nENDSEC;\nEND-ISO-10303-21;\n").encode()


WRITERS = {".stl": stl, ".obj": obj, ".ply": ply, ".glb": glb, ".step": step}


def written(folder: Path, name: str, data: bytes) -> Path:
    path = folder / name
    path.write_bytes(data)
    return path


def without(solid: Facets, *faces: int) -> Facets:
    return Facets(solid.vertices, np.delete(solid.faces, faces, axis=0))


def turned(solid: Facets, *faces: int) -> Facets:
    other = solid.faces.copy()
    other[list(faces)] = other[list(faces)][:, ::-1]
    return Facets(solid.vertices, other)


@pytest.mark.parametrize("kind", WRITERS)
def test_every_format_gives_the_same_part(kind: str, tmp_path: Path) -> None:
    mesh = load_mesh(written(tmp_path, "part" + kind, WRITERS[kind](PART)))
    assert isinstance(mesh, Mesh)
    assert mesh.vertices.dtype == np.float64
    assert mesh.faces.dtype == np.int64
    assert mesh.vertices.shape == (8, 3)
    assert mesh.faces.shape == (12, 3)
    assert mesh.facets.bounds == pytest.approx(PART.bounds, abs=1e-4)
    assert mesh.facets.volume == pytest.approx(24000.0, rel=1e-5)


def test_scale_multiplies_and_is_believed(tmp_path: Path) -> None:
    path = written(tmp_path, "inches.stl", stl(PART, 1.0 / 25.4))
    assert load_mesh(path, scale=25.4).facets.volume == pytest.approx(24000.0, rel=1e-5)
    assert load_mesh(written(tmp_path, "m.stl", stl(PART, 1e-3)), scale=1.0).facets.bounds[1][2] == pytest.approx(0.02)


def test_a_mesh_that_is_inside_out_is_turned(tmp_path: Path) -> None:
    mesh = load_mesh(written(tmp_path, "part.stl", stl(turned(PART, *range(12)))))
    assert mesh.facets.volume == pytest.approx(24000.0)


def test_repair_closes_a_hole_and_turns_a_triangle(tmp_path: Path) -> None:
    path = written(tmp_path, "part.stl", stl(turned(without(PART, 0), 5)))
    assert load_mesh(path, repair=True).facets.volume == pytest.approx(24000.0)


def test_triangles_without_area_go(tmp_path: Path) -> None:
    sliver = Facets(PART.vertices, np.concatenate([PART.faces, [[0, 1, 1], [2, 2, 2]]]))
    assert len(load_mesh(written(tmp_path, "part.obj", obj(sliver))).faces) == 12


FLAT = Facets(np.array([[0.0, 0, 0], [10, 0, 0], [0, 10, 0]]), np.array([[0, 1, 2], [0, 2, 1]]))
LINE = Facets(np.array([[0.0, 0, 0], [10, 0, 0], [20, 0, 0]]), np.array([[0, 1, 2]]))


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("part.dwg", b"", "meshes are read from .stl, .obj"),
        ("part.stl", b"", "there are no triangles in it"),
        ("part.stl", b"hello, world", "there are no triangles in it"),
        ("part.stl", b"solid x\nendsolid x\n", "there are no triangles in it"),
        ("part.stl", stl(PART)[:300], "cannot be read as .stl"),
        ("part.ply", ply(PART)[:200], "cannot be read as .ply"),
        ("part.glb", b"glTF and nothing more", "cannot be read as .glb"),
        ("part.step", b"ISO-10303-21; nonsense", "cannot be read as .step"),
        ("part.obj", obj(PART).replace(b"f 1 ", b"f 99 "), "export it again"),
        ("part.stl", stl(PART, 1000.0), "it is 40 m long when read in mm"),
        ("part.stl", stl(PART, 0.001), "it is 0.04 mm long when read in mm; if it is in metres give a scale of 1000"),
        ("part.stl", stl(without(PART, 3)), "the mesh has holes: 3 edges"),
        ("part.stl", stl(turned(PART, 4)), "face opposite ways"),
        ("part.obj", obj(FLAT), "encloses nothing"),
        ("part.obj", obj(LINE), "degenerate"),
        ("part.obj", b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "there are no triangles in it"),
    ],
)
def test_what_is_no_body_is_said_with_its_file(name: str, data: bytes, words: str, tmp_path: Path) -> None:
    path = written(tmp_path, name, data)
    with pytest.raises(UsageError) as said:
        load_mesh(path)
    assert str(path) in str(said.value)
    assert words in str(said.value)


def test_no_file_and_no_scale_are_said(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no such file"):
        load_mesh(tmp_path / "none.stl")
    with pytest.raises(UsageError, match="not a number above 0"):
        load_mesh(written(tmp_path, "part.stl", stl(PART)), scale=0.0)


def test_meshes_of_a_program_are_checked_too() -> None:
    assert mesh_of(PART.vertices, PART.faces).facets.volume == pytest.approx(24000.0)
    with pytest.raises(UsageError, match="holes"):
        mesh_of(PART.vertices, PART.faces[1:])


@pytest.mark.parametrize(
    ("package", "name", "extra"), [("trimesh", "part.stl", "cell"), ("cascadio", "part.step", "step")]
)
def test_a_missing_library_is_named_with_its_extra(
    package: str, name: str, extra: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.setattr("rpl.cell.meshes.find_spec", lambda name: None)
    with pytest.raises(UsageError, match=rf"{package}.*robot-rpl\[{extra}\]"):
        load_mesh(written(tmp_path, name, WRITERS[Path(name).suffix](PART)))
