"""What changed between two versions of a program, by what it says: a table of edits in every language."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.comparing import Differences, differences
from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_program, read_sources
from rpl.source import Source, source_from_bytes

SAMPLES = Path(__file__).parents[2] / "samples"


@dataclass(frozen=True)
class Edit:
    """An edit of a file of a sample, and what is told: kind, what, name, words."""

    sample: str
    file: str
    old: str
    new: str
    told: tuple[tuple[str, str, str, str], ...]


TENDING = "krl/machine_tending"
EDITS = [
    # points by millimetres, degrees, configuration, axes
    Edit(TENDING, "machine_tending.dat", "XLOAD={X 680.0,Y 0.0", "XLOAD={X 683.0,Y -4.0",
         (("point", "changed", "XLOAD", "moved 5.00 mm (x +3, y -4)"),)),
    Edit(TENDING, "machine_tending.dat", "B 90.0,C 0.0,S 6,T 18", "B 88.5,C 0.0,S 2,T 18",
         (("point", "changed", "XBEFORE", "turned 1.50°, configuration: s 6 → 2"),)),
    Edit(TENDING, "machine_tending.dat", "A2 -90.0", "A2 -92.5", (("point", "changed", "XHOME", "axes j2 -2.5°"),)),
    Edit("rapid/machine_tending", "machine_tending.mod", "pDoor:=[[300,50,300]", "pDoor:=[[300,50,312.5]",
         (("point", "changed", "pDoor", "moved 12.50 mm (z +12.5)"),)),
    Edit("tp/machine_tending", "tending.ls", "X =   420.000  mm", "X =   420.500  mm",
         (("point", "changed", "P3", "moved 0.50 mm (x +0.5)"),)),
    Edit("inform/machine_tending", "TEND.JBI", "C00003=250.000", "C00003=251.000",
         (("point", "changed", "C00003", "moved 1.00 mm (x +1)"),)),
    Edit("urscript/machine_tending", "machine_tending.script", "before = p[-0.1,", "before = p[-0.104,",
         (("point", "changed", "before", "moved 4.00 mm (x -4)"),)),
    Edit("vplus/machine_tending", "machine_tending.v2", "door = TRANS(300,", "door = TRANS(302,",
         (("point", "changed", "door", "moved 2.00 mm (x +2)"),)),
    # the frame that a point is taught in, where the IR has no word for it
    Edit("tp/machine_tending", "tending.ls", "UF : 0, UT : 1,\t\tCONFIG", "UF : 2, UT : 1,\t\tCONFIG",
         (("point", "changed", "P2", "uf : 0.0 → uf : 2.0"),)),
    # tools
    Edit("rapid/machine_tending", "machine_tending.mod", "[1,[0,0,50]", "[2.5,[0,0,50]",
         (("tool", "changed", "tGrip", "load.mass 1 → 2.5"),)),
    # moves: speed, corner, goal, tool
    Edit("rapid/machine_tending", "machine_tending.mod", "MoveL pChuck,v200,fine", "MoveL pChuck,v100,z10",
         (("speed", "changed", "", "speed v200 → v100, zone fine → z10"),)),
    Edit("tp/machine_tending", "tending.ls", "L P[3:load] 300mm/sec FINE", "L P[3:load] 250mm/sec CNT20",
         (("speed", "changed", "", "speed 300 → 250 mm/s, exact stop → corner by percentage 20"),)),
    Edit("rapid/machine_tending", "machine_tending.mod", "MoveL pChuck,v200", "MoveL pDoor,v200",
         (("logic", "changed", "", "goes to pDoor, not pChuck"),)),
    Edit(TENDING, "machine_tending.src", "$VEL.CP=0.4", "$VEL.CP=0.5", (("speed", "changed", "", "400 → 500"),)),
    # signals and logic
    Edit(TENDING, "machine_tending.src", "WAIT FOR $IN[2]", "WAIT FOR $IN[7]", (("io", "changed", "", ""),)),
    Edit(TENDING, "machine_tending.src", "WAIT SEC 0.3", "WAIT SEC 0.4", (("logic", "changed", "", ""),)),
    Edit(TENDING, "machine_tending.src", "GRIP(TRUE)\n", "GRIP(TRUE)\nHALT\n", (("logic", "added", "", ""),)),
    Edit("tp/machine_tending", "tending.ls", "   9:  WAIT DI[2:idle]=ON ;\n", "", (("io", "removed", "", ""),)),
    Edit("inform/machine_tending", "TEND.JBI", "TIMER T=0.20", "TIMER T=0.25", (("logic", "changed", "", ""),)),
    # other data, headers, comments
    Edit("rapid/machine_tending", "machine_tending.mod", "MOST_TRIES:=4", "MOST_TRIES:=5",
         (("data", "changed", "MOST_TRIES", "4 → 5"),)),
    Edit("tp/machine_tending", "tending.ls", "STACK_SIZE\t= 0", "STACK_SIZE\t= 500",
         (("header", "changed", "STACK_SIZE", '"0" → "500"'),)),
    Edit(TENDING, "machine_tending.src", "; door", "; the door", (("comment", "changed", "", ""),)),
    Edit("tp/machine_tending", "tending.ls", "DO[10:alarm]=OFF", "DO[10:horn]=OFF",
         (("comment", "changed", "", "10.0 : alarm → 10.0 : horn"),)),
    # what means nothing
    Edit(TENDING, "machine_tending.src", "&REL 1", "&REL 2", ()),
    Edit(TENDING, "machine_tending.src", "WAIT SEC 0.3", "wait  sec 0.30", ()),
    Edit(TENDING, "machine_tending.src", "INI( )\n", "INI( )\n\n\n", ()),
    Edit("tp/machine_tending", "tending.ls", "MODIFIED\t= DATE 24-03-04", "MODIFIED\t= DATE 26-11-29", ()),
    Edit("tp/machine_tending", "tending.ls", "   9:  WAIT", "  90:  WAIT", ()),
    Edit("inform/machine_tending", "TEND.JBI", "///DATE 2024", "///DATE 2026", ()),
    Edit("rapid/machine_tending", "machine_tending.mod", "MOST_TRIES:=4", "most_tries := 4.0", ()),
]  # fmt: skip


def sources(sample: str) -> list[Source]:
    return list(read_program([SAMPLES / sample]).sources)


def edited(edit: Edit) -> tuple[ReadProgram, ReadProgram]:
    language = edit.sample.partition("/")[0]
    before = sources(edit.sample)
    at = next(at for at, one in enumerate(before) if Path(one.path).name == edit.file)
    text = before[at].text
    assert edit.old in text
    new = source_from_bytes(before[at].path, text.replace(edit.old, edit.new, 1).encode(before[at].encoding))
    after = [*before[:at], new, *before[at + 1 :]]
    return read_sources(before, language, Diagnostics()), read_sources(after, language, Diagnostics())


def told(found: Differences) -> tuple[tuple[str, str, str, str], ...]:
    return tuple((one.kind, one.what, one.name, ", ".join(one.words)) for one in found.changes)


@pytest.mark.parametrize("edit", EDITS, ids=lambda edit: f"{edit.sample.partition('/')[0]}: {edit.new.strip()[:30]}")
def test_an_edit_is_told_by_what_it_means(edit: Edit) -> None:
    found = differences(*edited(edit))
    assert told(found) == edit.told
    assert found.same == all(kind == "comment" for kind, *_ in edit.told)
    assert edit.told or found.meaningless


def test_how_far_a_point_moved_is_a_number() -> None:
    (change,) = differences(*edited(EDITS[0])).changes
    assert change.moved is not None and change.a is not None and change.b is not None
    assert change.moved.mm == pytest.approx(5.0) and change.moved.offset_mm == pytest.approx((3.0, -4.0, 0.0))
    assert (change.a.line, change.b.line) == (6, 6) and change.b.text.startswith("DECL E6POS XLOAD={X 683.0")


def test_the_command_says_it_and_ends_with_whether_it_differs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old, new = tmp_path / "old.src", tmp_path / "new.src"
    text = "DEF demo()\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\n$OUT[1]=TRUE ; on\nEND\n"
    old.write_text(text)
    new.write_text(text.replace("A1 0", "A1 5").replace("; on", "; goes on") + "DEF more()\nHALT\nEND\n")
    assert run(["diff", str(old), str(new)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "routines:",
        "  + more: 1 statement  (new.src:5)",
        "points:",
        "  demo",
        "    ~ PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}",
        "      → PTP {A1 5,A2 -90,A3 90,A4 0,A5 0,A6 0}  (old.src:2 → new.src:2)",
        "        axes j1 +5°",
        "comments:",
        "  demo",
        "    ~ on",
        "      → goes on  (old.src:3 → new.src:3)",
        "differs: 1 routine, 1 point, 1 comment",
    ]
    assert run(["diff", str(old), str(old)]) == 0
    assert capsys.readouterr().out == "the same meaning\n"
    assert run(["diff", str(old), str(new), "--json"]) == 1
    document = json.loads(capsys.readouterr().out)
    assert document["counts"] == {"routine": 1, "point": 1, "comment": 1} and document["same"] is False
    assert run(["diff", str(old), str(tmp_path / "lost.src")]) == 2


def test_a_file_that_one_side_has_is_told_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for side, names in (("a", ("one", "two")), ("b", ("one", "three"))):
        (tmp_path / side).mkdir()
        for name in names:
            (tmp_path / side / f"{name}.src").write_text(f"DEF {name}()\nHALT\nEND\n")
    assert run(["diff", str(tmp_path / "a"), str(tmp_path / "b")]) == 1
    lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
    assert [line.split()[0] for line in lines[1:3]] == ["-", "+"] and lines[-1] == "differs: 2 files"
