"""Long runs of moves by stretches: what is written and told is what comes of the moves one by one."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rpl.dialects.krl.configuration import KrlNotation

from rpl import ir, translation
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.ir.walk import walk
from rpl.passes import stretches
from rpl.passes.expanded import expanded
from rpl.project import read_program
from rpl.reading import runs
from rpl.source import Source, source_from_text

TARGETS = ("rapid", "tp", "krl", "urscript", "inform", "vplus", "val3", "rpl")
Rows = list[list[str]]


def krl(parts: list[Rows], between: str) -> Source:
    def move(row: list[str]) -> str:
        return f"LIN {{{','.join(map(' '.join, zip('XYZABC', row, strict=True)))}}} C_DIS"

    bodies = ["\n".join(map(move, rows)) for rows in parts]
    text = ["DEF long()", "DECL INT i", "$VEL.CP=0.25", "$APO.CDIS=5", f"\n{between}\n".join(bodies), "END", ""]
    return source_from_text("long.src", "\n".join(text))


def krl_axes(parts: list[Rows], between: str) -> Source:
    names = [f"A{number}" for number in range(1, 7)]
    bodies = ["\n".join(f"PTP {{{','.join(map(' '.join, zip(names, row, strict=True)))}}}" for row in p) for p in parts]
    return source_from_text(
        "axes.src", "\n".join(["DEF axes()", "DECL INT i", "BAS(#INITMOV,0)", f"\n{between}\n".join(bodies), "END", ""])
    )


def krl_flags(parts: list[Rows], between: str) -> Source:
    """Places with S and T, reached by any of the arm's postures."""
    arm, middle, width = load_robot(ROBOT), np.array([0, -90, 90, 0, 0, 0]), np.array([60, 30, 40, 60, 80, 150])

    def move(row: list[str], word: str) -> str:
        joints = middle + width * np.sin([float(one) for one in row])
        flags = NOTATION.encode(arm, joints)
        numbers = map("{} {:.3f}".format, "XYZABC", NOTATION.values_of(arm.forward(joints)[None])[0])
        return f"{word} {{{','.join(numbers)},S {flags['s']},T {flags['t']},E1 0.0}}"

    bodies = ["\n".join(move(row, word) for row in rows) for rows, word in zip(parts, ("PTP", "LIN"), strict=False)]
    text = ["DEF long()", "DECL INT i", "BAS(#INITMOV,0)", f"\n{between}\n".join(bodies), "END", ""]
    return source_from_text("flags.src", "\n".join(text))


def rapid(parts: list[Rows], between: str) -> Source:
    def move(row: list[str]) -> str:
        x, y, z, a, b, c = row
        flags = f"[{int(float(a)) % 3 - 1},0,{int(float(b)) % 2},0]"
        return f"  MoveL [[{x},{y},{z}],[0.{abs(int(float(c))):03},0.5,0.5,0.5],{flags},{_NONE}],v200,z1,tool0;"

    bodies = ["\n".join(map(move, rows)) for rows in parts]
    text = ["MODULE long", "VAR num i;", "PROC main()", f"\n{between}\n".join(bodies), "ENDPROC", "ENDMODULE", ""]
    return source_from_text("long.mod", "\n".join(text))


_NONE = "[9E9,9E9,9E9,9E9,9E9,9E9]"
ROBOT = "kuka_kr6r900sixx"
NOTATION = KrlNotation()
BETWEEN = {
    krl: ("i=1", "; a remark", "$VEL.CP=0.1", "$APO.CDIS=20", "WAIT SEC 1", "$OUT[3]=TRUE", "HALT", "LIN_REL {X 5}"),
    krl_axes: ("i=1", "; a remark", "$VEL_AXIS[1]=20", "$OUT[3]=TRUE"),
    krl_flags: ("i=1", "$BASE={X 5,Y 0,Z 0,A 0,B 0,C 0}", "PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}"),
    rapid: ("i:=1;", "! a remark", "VelSet 50,200;", "WaitTime 1;", "SetDO do1,1;", "Stop;"),
}
DISTURBING = ("0", "-0", "0.0", "-0.0", "5", "-5", ".5", "7.", "180.0", "-180.0", "-179.9999", "90.0", "0.10000")
Write = Callable[[list[Rows], str], Source]


@dataclass(frozen=True)
class Asked:
    """A list of points: how many, around which numbers, which are disturbed and which are those of the point before."""

    seed: int
    count: int
    width: float
    disturbed: tuple[tuple[int, int, str], ...]
    repeated: tuple[tuple[int, int], ...] = ()

    def rows(self) -> Rows:
        chance = random.Random(self.seed)
        middles = [chance.uniform(-500, 500) for _ in range(3)] + [chance.uniform(-90, 90) for _ in range(3)]
        rows = [[f"{middle + chance.uniform(-1, 1) * self.width:.3f}" for middle in middles] for _ in range(self.count)]
        for at, column, spelling in self.disturbed:
            rows[at % self.count][column] = spelling
        for at, columns in self.repeated:
            for column in range(columns):
                rows[at % self.count][column] = rows[(at - 1) % self.count][column]
        return rows


SPELLINGS = st.one_of(st.sampled_from(DISTURBING), st.sampled_from(("99999.0", "1999999999.0", "123456789")))
LISTS = st.builds(
    Asked,
    st.integers(0, 10**6),
    st.integers(1, 60),
    st.sampled_from((0.0, 0.0004, 1.0, 30.0, 400.0)),
    st.lists(st.tuples(st.integers(0, 10**3), st.integers(0, 5), SPELLINGS), max_size=4).map(tuple),
    st.lists(st.tuples(st.integers(0, 10**3), st.integers(1, 6)), max_size=3).map(tuple),
)
Written = tuple[list[tuple[str, bytes]], list[tuple[str, int, int, str]], object, object]


def written(
    source: Source, target: str, whole: bool, robot: str | None = None, to_robot: str | None = None
) -> tuple[Written, int]:
    """What comes of it, by moves or by stretches, and how many moves were written in stretches."""
    diagnostics = Diagnostics()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runs, "SHORTEST", 3)
        patch.setattr(stretches, "SHORTEST", 2)
        if whole:
            patch.setattr(translation, "with_stretches", lambda program, one_by_one: (expanded(program), ()))
        read = read_program([source])
        done = translation.translate_program(read, target, robot, to_robot, diagnostics=diagnostics)
    told = [(item.code.name, item.origin.start, item.origin.end, item.message) for item in diagnostics]
    files = [(file.path, file.data) for file in done.files]
    count = sum(len(node) for node in walk(*done.written.modules) if isinstance(node, ir.Rows))
    return (files, told, done.registers, done.program), count


@given(st.sampled_from((krl, krl_axes, krl_flags, rapid)), st.lists(LISTS, min_size=1, max_size=2), st.data())
@settings(max_examples=60, deadline=None)
def test_stretches_are_what_comes_of_each_move(write: Write, lists: list[Asked], data: st.DataObject) -> None:
    source = write([one.rows() for one in lists], data.draw(st.sampled_from(BETWEEN[write])))
    target = data.draw(st.sampled_from(TARGETS))
    robot = data.draw(st.sampled_from((None, ROBOT)))
    assert written(source, target, False, robot)[0] == written(source, target, True, robot)[0]


@pytest.mark.parametrize("robot", [None, ROBOT])
@pytest.mark.parametrize("target", ["rapid", "tp"])
@pytest.mark.parametrize(("write", "width"), [(krl, 5.0), (krl_axes, 5.0), (krl_flags, 5.0)])
def test_long_lists_are_written_by_stretches(write: Write, width: float, target: str, robot: str | None) -> None:
    rows, others = Asked(3, 200, width, ()).rows(), Asked(4, 200, width, ()).rows()
    source = write([rows, rows if target == "rapid" else others], BETWEEN[write][0])
    found, count = written(source, target, False, robot)
    assert count > 300 or write is krl_flags  # there each joint move is told of
    assert found == written(source, target, True, robot)[0]


@pytest.mark.parametrize("robot", [None, ROBOT])
def test_moves_share_points_with_moves_of_rows(robot: str | None) -> None:
    """A way that is gone again, from its middle and turned round: its points have one number each."""
    rows = Asked(3, 60, 30.0, ()).rows()
    source = krl([rows, rows[30:] + Asked(5, 40, 30.0, ()).rows() + rows[9::-1]], "$OUT[3]=TRUE")
    found, count = written(source, "tp", False, robot)
    assert count > 60
    assert found == written(source, "tp", True, robot)[0]


def test_zones_of_some_moves_have_names_of_their_own() -> None:
    """Where the tool turns far on a short way a zone needs a larger angle; the others keep the usual one."""
    rows = [[f"{400 + 20.0 * at:.3f}", "5.0", "300.0", "0.0", f"{40 + at % 7 // 6 * 30}.0", "0.0"] for at in range(90)]
    found, count = written(krl([rows], ""), "rapid", whole=False)
    assert count > 60
    assert {b"z5", b"z5Turning"} <= {line.split(b",")[-2] for line in found[0][0][1].splitlines() if b"MoveL" in line}
    assert found == written(krl([rows], ""), "rapid", whole=True)[0]


@pytest.mark.parametrize("robot", [None, ROBOT])
def test_a_few_odd_moves_leave_the_others_in_rows(robot: str | None) -> None:
    """Two short ways on which the tool turns far (the controller reduces their zones), and one other posture."""
    rows = Asked(3, 300, 0.0, ()).rows()
    for at, row in enumerate(rows):
        row[:3] = f"{420 + at % 40 * 3.5:.3f}", f"{-100 + at // 40 * 7.5:.3f}", f"{400 + at % 7 * 0.5:.3f}"
        row[3:] = "6.0", "0.0", "501.0"
    for at in (80, 200):
        rows[at][:3], rows[at][5] = [f"{float(one) + 0.3:.3f}" for one in rows[at - 1][:3]], "900.0"
    rows[140][3] = "7.0"
    found, count = written(rapid([rows], ""), "tp", False, robot)
    assert 240 < count < 300
    assert found == written(rapid([rows], ""), "tp", True, robot)[0]


@pytest.mark.parametrize(
    ("write", "target", "to_robot"), [(krl, "tp", "fanuc_m20ia"), (krl_flags, "rapid", "abb_irb120_3_58")]
)
def test_rows_go_to_another_arm(write: Write, target: str, to_robot: str) -> None:
    """Also where a few moves are not reached, or in another posture only."""
    rows = Asked(7, 120, 20.0, ()).rows()
    for at, row in enumerate(rows if write is krl else []):
        row[:3] = f"{450 + at % 9 * 12.5:.3f}", f"{-80 + at // 9 * 11.5:.3f}", f"{400 + at % 5 * 9.5:.3f}"
        row[3:] = f"{at * 0.75:.3f}", f"{80 + at % 7 * 1.5:.3f}", f"{-at * 0.5:.3f}"
    rows[50][0] = "2500.5" if write is krl else rows[50][0]
    source = write([rows[:60], rows[60:]], "")
    found, count = written(source, target, False, ROBOT, to_robot)
    assert count > 40 or write is krl_flags
    assert found == written(source, target, True, ROBOT, to_robot)[0]
