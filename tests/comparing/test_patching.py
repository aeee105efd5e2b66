"""A program that nobody changed keeps every byte, and one point that changed is one line that differs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from rpl import ir
from rpl.comparing import differences
from rpl.comparing.patching import with_points
from rpl.diagnostics import Diagnostics
from rpl.errors import SourceError, UsageError
from rpl.ir.walk import bodies, statements
from rpl.project import ReadProgram, read_program, read_sources
from rpl.source import Source, source_from_bytes

SAMPLES = Path(__file__).parents[2] / "samples"
FOLDERS = sorted(path for path in SAMPLES.glob("*/*") if path.is_dir())


def text_of(language: str, name: str, text: str) -> ReadProgram:
    return read_sources([source_from_bytes(name, text.encode())], language, Diagnostics())


def changed_lines(before: Source, after: Source) -> list[tuple[str, str]]:
    a, b = before.text.splitlines(keepends=True), after.text.splitlines(keepends=True)
    assert len(a) == len(b)
    return [(one, other) for one, other in zip(a, b, strict=True) if one != other]


def first_point(read: ReadProgram) -> Iterator[tuple[str, str, str]]:
    """The first point that stands in the text as a declaration, if any: its name behind that of its home, its own name,
    and a component that it has."""
    routines = [one for module in read.reduced.modules for one in module.routines]
    by_the_way = {(id(one.origin.source), one.origin.start) for each in routines for one in statements(*bodies(each))}
    for module in read.reduced.modules:
        for home in (module, *module.routines):
            for one in home.declarations:
                if not isinstance(one, ir.Variable) or not isinstance(one.initial, ir.Aggregate):
                    continue
                place = id(one.origin.source), one.origin.start
                if one.origin.source is not None and place not in by_the_way and _is_point(one.type):
                    yield f"{home.name}.{one.name}", one.name, "j2" if isinstance(one.type, ir.JointsType) else "y"
                    return


def _is_point(type: ir.Type) -> bool:
    return isinstance(type, ir.TargetType | ir.JointsType | ir.PoseType)


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda path: "/".join(path.parts[-2:]))
def test_every_byte_of_a_sample_comes_back_and_a_point_is_one_line(folder: Path) -> None:
    read = read_program([folder])
    for source in with_points(read, {}):
        assert source.encoded() == source.data == Path(source.path).read_bytes()
    for name, own, component in first_point(read) if len(read.dialects) == 1 else ():  # a cell may have several
        after = with_points(read, {name: {component: 12.25}})
        pairs = [changed_lines(one, other) for one, other in zip(read.sources, after, strict=True) if one is not other]
        different = [lines for lines in pairs if lines]
        assert len(different) == 1 and len(different[0]) == 1, (name, different)
        told = differences(read, read_sources(list(after), read.dialects[0], Diagnostics()))
        assert {one.name.lower() for one in told.changes} == {own.lower()}


LINES = [
    ("krl", "DEFDAT d\nDECL E6POS XA={X 1.50,Y -2.0,Z 0.0,A 0.0,B 0.0,C 0.0,S 0,T 0}\nENDDAT\n", {"y": 3.25, "a": 90.0},
     "DECL E6POS XA={X 1.50,Y 3.25,Z 0.0,A 90.0,B 0.0,C 0.0,S 0,T 0}\n"),
    ("rapid", "MODULE m\nCONST robtarget XA:=[[1,-2.5,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nENDMODULE\n",
     {"x": 7.0, "z": 0.125}, "CONST robtarget XA:=[[7,-2.5,0.125],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"),
    ("rapid", "MODULE m\nCONST robtarget XA:=[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nENDMODULE\n",
     {"a": 180.0}, "CONST robtarget XA:=[[1,2,3],[0,0,0,1],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"),
    ("urscript", "def m():\n  XA = p[0.100, -0.2, 0.3, 0, 3.14159, 0]\n  movej(XA)\nend\n", {"x": 104.0, "z": 305.5},
     "  XA = p[0.104, -0.2, 0.3055, 0, 3.14159, 0]\n"),
    ("vplus", ".PROGRAM m()\nSET xa = TRANS(100, 0, 20, 0, 180, 0)\nMOVE xa\n.END\n", {"y": -5.5},
     "SET xa = TRANS(100, -5.5, 20, 0, 180, 0)\n"),
]  # fmt: skip


@pytest.mark.parametrize(("language", "text", "components", "line"), LINES, ids=[f"{a}: {c}" for a, _, c, _ in LINES])
def test_the_numbers_keep_the_style_of_their_line(
    language: str, text: str, components: dict[str, float], line: str
) -> None:
    names = {"krl": "d.dat", "rapid": "m.mod", "urscript": "m.script", "vplus": "m.v2"}
    read = text_of(language, names[language], text)
    (source,) = with_points(read, {"xa": components})
    assert [new for _, new in changed_lines(read.sources[0], source)] == [line]


def test_columns_of_a_listing_stay() -> None:
    read = read_program([SAMPLES / "tp" / "machine_tending"])
    before = next(one for one in read.sources if one.path.endswith(".ls"))
    after = next(one for one in with_points(read, {"P3": {"x": -1204.5}}) if one.path == before.path)
    assert changed_lines(before, after) == [
        (
            "\tX =   420.000  mm,\tY =   200.000  mm,\tZ =   120.000  mm,\n",
            "\tX = -1204.500  mm,\tY =   200.000  mm,\tZ =   120.000  mm,\n",
        )
    ]


def test_what_cannot_be_said_in_the_text_is_refused() -> None:
    vplus = text_of("vplus", "m.v2", ".PROGRAM m()\nSET xa = TRANS(100, 0, 20, 0, 170, 0)\nMOVE xa\n.END\n")
    with pytest.raises(SourceError, match="a"):
        with_points(vplus, {"xa": {"a": 12.0}})
    with pytest.raises(UsageError, match="there is no point lost"):
        with_points(vplus, {"lost": {"x": 1.0}})
    twice = text_of("krl", "d.src", "DEF d()\nFRAME f\nf={X 1,Y 2,Z 3,A 0,B 0,C 0}\nf={X 4,Y 2,Z 3,A 0,B 0,C 0}\nEND\n")
    with pytest.raises(UsageError, match="several of the name"):
        with_points(twice, {"f": {"x": 1.0}})
