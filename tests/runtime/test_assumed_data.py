"""Runs that go on where data of the controller has no value: what is assumed, what is not, and that each is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl import read
from rpl.cell import Cell
from rpl.diagnostics import Diagnostics
from rpl.passes.undeclared import MODULE, declared_by_use
from rpl.project import read_program
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program

ASSUMED = Cell(assume_data=True)
ROBOT = "kuka_kr6r900sixx"


def ran(folder: Path, src: str, dat: str = "", cell: Cell = ASSUMED, robot: str | None = None) -> RunResult:
    """A KRL program `main` with its data list."""
    (folder / "main.src").write_text(f"DEF main()\n{src}\nEND\n")
    (folder / "main.dat").write_text(f"DEFDAT main\n{dat}\nENDDAT\n")
    return run_program(read([folder]).program, robot, cell, "main")


def told(result: RunResult) -> list[tuple[str, str, int]]:
    """Name, value in words and line of what was assumed."""
    assert result.assumed is not None
    return [(one.name, one.shown, one.origin.line) for one in result.assumed]


@pytest.mark.parametrize(
    ("declared", "statement", "name", "shown"),
    [
        ("DECL INT count", "$OUT[1]=count==0", "count", "0"),
        ("DECL REAL depth", "$OUT[1]=depth==0", "depth", "0"),
        ("DECL BOOL ready", "$OUT[1]=NOT ready", "ready", "FALSE"),
        ("DECL CHAR text[8]", '$OUT[1]=STRCOMP(text[],"",#CASE_SENS)', "text", "an empty text"),
        ("DECL INT list[3]", "$OUT[1]=list[2]==0", "list[2]", "0"),
        ("DECL FRAME shift", "$OUT[1]=shift.X==0", "shift.x", "0"),
        ("", "IF far THEN\nENDIF\n$OUT[1]=NOT far", "far", "FALSE"),
        ("", "$OUT[1]=far+1==1", "far", "0"),
        ("", "$OUT[1]=far.amount+1==1", "far.amount", "0"),
        ("", "$OUT[1]=far[2]+1==1", "far[2]", "0"),
        ("DECL INT given[2]\ngiven[1]=5", "$OUT[1]=given[far]==5", "far", "1"),  # the first element
        ("", "IF far==#SLOW THEN\n$OUT[1]=TRUE\nENDIF", "far", "#SLOW"),
    ],
)
def test_values_by_type(tmp_path: Path, declared: str, statement: str, name: str, shown: str) -> None:
    result = ran(tmp_path, statement, declared)
    assert result.status == "finished" and result.outputs == ((0.0, "$OUT[1]", True),)
    assert [one[:2] for one in told(result)] == [(name, shown)]
    assert told(result)[0][2] == 2
    asked = ran(tmp_path, statement, declared, Cell())
    assert asked.status == "fault" and asked.assumed is None


def test_each_datum_is_told_once_and_keeps_its_value(tmp_path: Path) -> None:
    result = ran(tmp_path, "$OUT[1]=count==0\ncount=count+3\n$OUT[2]=count==3", "DECL INT count")
    assert [value for _, _, value in result.outputs] == [True, True]
    assert told(result) == [("count", "0", 2)]


def test_what_the_program_sets_in_time_is_not_assumed(tmp_path: Path) -> None:
    result = ran(tmp_path, "count=1\nfar=2\n$OUT[1]=count+far==3", "DECL INT count")
    assert result.status == "finished" and told(result) == []


def test_a_variable_of_a_routine_stays_a_fault(tmp_path: Path) -> None:
    """No controller has a value for it either."""
    result = ran(tmp_path, "DECL INT n\n$OUT[1]=n==0")
    assert result.fault is not None and result.fault.message == "n has no value yet"
    handed = "DECL INT n\nnext(n)\nEND\nDEF next(p :OUT)\nDECL INT p\n$OUT[1]=p==0"
    assert ran(tmp_path, handed).status == "fault"
    assert told(ran(tmp_path, handed.replace("DECL INT n\n", ""), "DECL INT n")) == [("p", "0", 6)]


def test_a_place_of_a_move_is_where_the_arm_stands(tmp_path: Path) -> None:
    result = ran(
        tmp_path, "PTP {A1 10,A2 -90,A3 90,A4 0,A5 45,A6 0}\nPTP lost\nPTP kept", "DECL E6POS kept", ASSUMED, ROBOT
    )
    assert result.status == "finished" and result.moves == 3
    assert [name for name, _, _ in told(result)] == ["lost", "kept"]
    first, second = ({*said.split(", ")} for _, said, _ in told(result))
    assert first == second and any(word.startswith("z ") and word != "z 0" for word in first)
    start = [event.data["joints"] for event in result.trace if event.kind == "move"]
    assert start[1] == pytest.approx(start[2], abs=1e-6) and start[0] != pytest.approx(start[1], abs=1e-3)


_TP = """/PROG  MAIN
/ATTR
/MN
   1:  PR[2]=PR[1]+PR[3] ;
   2:J PR[2] 50% FINE ;
   3:  PR[4,3]=25 ;
   4:L PR[2] 100mm/sec FINE Offset,PR[4] ;
/POS
/END
"""


def test_position_registers_are_places_or_shifts(tmp_path: Path) -> None:
    """The first summand of where a move goes is a place; what is added or stands behind Offset is a shift."""
    (tmp_path / "MAIN.LS").write_text(_TP)
    program = read([tmp_path]).program
    assert run_program(program, "fanuc_lrmate200id").status == "fault"
    result = run_program(program, "fanuc_lrmate200id", ASSUMED)
    said = {name: shown for name, shown, _ in told(result)}
    assert said["PR3"] == "x 0, y 0, z 0, a 0, b 0, c 0"
    assert said["PR1"] != said["PR3"] and said["PR4"] == "x 0, y 0, z 25, a 0, b 0, c 0"
    assert result.status == "finished", result


def test_what_the_cell_file_gives_is_not_assumed(tmp_path: Path) -> None:
    given = Cell(variables={"far": 4, "other.depth": 2.5, "list[2]": 7}, assume_data=True)
    result = ran(
        tmp_path, "$OUT[1]=far==4\n$OUT[2]=other.depth==2.5\n$OUT[3]=list[2]==7\n$OUT[4]=list[1]==0", "", given
    )
    assert [value for _, _, value in result.outputs] == [True] * 4
    assert told(result) == [("list[1]", "0", 5)]
    alone = Cell(variables={"far": 4})
    assert ran(tmp_path, "$OUT[1]=far==4", "", alone).status == "finished"


def test_declarations_by_use(tmp_path: Path) -> None:
    (tmp_path / "main.src").write_text(
        "DEF main()\nDECL INT i\nBOX[i].place.x=1\nBOX[3].full=TRUE\nIF #RED==mode THEN\nENDIF\nPTP there\n"
        "$OUT[number]=on\nWAIT SEC pause\nEND\n"
    )
    program = declared_by_use(read_program([tmp_path], None, Diagnostics()).program)
    (module,) = (one for one in program.modules if one.name == MODULE)
    types = {one.name: one.type.__class__.__name__ for one in module.declarations if hasattr(one, "type")}
    assert types == {
        "BOX": "ArrayType",
        "mode": "NamedType",
        "there": "TargetType",
        "number": "IntType",
        "on": "BoolType",
        "pause": "RealType",
    }
    assert declared_by_use(program) is program  # nothing is left
    assert not any(one.name == MODULE for one in declared_by_use(program, {"other"}).modules[:-1])
