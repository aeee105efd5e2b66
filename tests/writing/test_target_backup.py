"""A translation for a robot that has programs already: nothing of it is used by accident, what is the same is taken."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl.diagnostics import Diagnostics
from rpl.errors import UsageError
from rpl.ir.standing import NOTHING
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.standing import read_standing
from rpl.translation import Translation, translate_program
from rpl.writing.namemap import NameMap
from rpl.writing.names import NO_MAP

LISTING = """/PROG  STATION
/MN
   1:  UFRAME_NUM=1 ;
   2:  R[2:box count]=R[2:box count]+1 ;
   3:  R[4]=R[R[9]] ;
   4:  DO[5:grip]=ON ;
   5:  PR[1:above]=LPOS ;
/POS
/END
"""
NUMREG = "[*NUMREG*]$NUMREG Storage: CMOS  Access: RW  : ARRAY[200] OF Numeric Reg\n     [3] = 0  'total'\n"
JOB = """/JOB
//NAME STATION
//POS
///NPOS 0,0,0,0,0,0
//INST
///DATE 2020/01/01 00:00
///ATTR SC,RW
NOP
SET B000 1
SET I001 B[B003]
DOUT OT#(5) ON
END
"""
TOOL = "//TOOL 2\n///NAME GRIPPER\n0.000,0.000,120.000,0.0000,0.0000,0.0000\n"
MODULE = "MODULE station\nPERS num boxes:=0;\nPROC other()\nENDPROC\nENDMODULE\n"
EIO = """EIO:CFG_1.0:6:0::
#
EIO_SIGNAL:

      -Name "doGrip" -SignalType "DO" -Device "board" -DeviceMap "5"
"""
BACKUPS = {
    "tp": {"STATION.LS": LISTING, "NUMREG.VA": NUMREG},
    "inform": {"STATION.JBI": JOB, "TOOL.CND": TOOL},
    "rapid": {"station.mod": MODULE, "EIO.cfg": EIO},
    "krl": {"station.src": "GLOBAL DEF station()\nEND\n"},
}
KRL = """DEF station()
DECL INT parts,boxes
parts=1
boxes=parts+1
$OUT[5]=TRUE
END
"""
RAPID = """MODULE station
PROC main()
VAR num parts:=1;
parts:=parts+1;
SetDO doOther,1;
SetDO grip,1;
WaitTime parts;
ENDPROC
ENDMODULE
"""


def backup(folder: Path, target: str) -> Path:
    for name, text in BACKUPS[target].items():
        (folder / name).write_text(text)
    return folder


def translated(text: str, target: str, there: Path | None, earlier: NameMap = NO_MAP) -> tuple[Translation, list[str]]:
    dialect = "rapid" if text.startswith("MODULE") else "krl"
    diagnostics = Diagnostics()
    read = read_sources(
        [source_from_text({"rapid": "station.mod", "krl": "station.src"}[dialect], text)], dialect, diagnostics
    )
    standing = read_standing(there, target) if there is not None else NOTHING
    done = translate_program(read, target, diagnostics=diagnostics, earlier=earlier, there=standing)
    return done, [item.code.name for item in diagnostics]


@pytest.mark.parametrize(
    ("target", "names", "numbers", "signals", "computed"),
    [
        (
            "tp", {"station"},
            {("R", 2): "box count", ("R", 3): "total", ("R", 4): "", ("R", 9): "", ("PR", 1): "above",
             ("UFRAME", 1): ""},
            {("digital_out", 5): "grip"}, {"R"},
        ),
        (
            "inform", {"station"}, {("B", 0): "", ("B", 3): "", ("I", 1): "", ("TL", 2): ""},
            {("digital_out", 5): ""}, {"B"},
        ),
        ("rapid", {"station", "boxes", "other", "dogrip"}, {}, {("digital_out", 5): "doGrip"}, set()),
        ("krl", {"station"}, {}, {}, set()),
    ],
)  # fmt: skip
def test_what_a_backup_says(
    target: str,
    names: set[str],
    numbers: dict[tuple[str, int], str],
    signals: dict[tuple[str, int], str],
    computed: set[str],
    tmp_path: Path,
) -> None:
    found = read_standing(backup(tmp_path, target), target)
    assert (set(found.names), found.numbers, found.signals) == (names, numbers, signals)
    assert found.computed == computed


def test_a_folder_without_programs_is_no_backup(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="there is nothing of FANUC TP in the backup"):
        read_standing(tmp_path, "tp")


@pytest.mark.parametrize("target", BACKUPS)
@pytest.mark.parametrize("text", [KRL, RAPID])
def test_nothing_that_is_there_is_given_to_something_else(target: str, text: str, tmp_path: Path) -> None:
    if target == ("rapid" if text is RAPID else "krl"):
        return
    there = backup(tmp_path, target)
    found = read_standing(there, target)
    done, told = translated(text, target, there)
    assert not set(done.registers) & set(found.numbers)
    routines = {one.name.lower() for module in done.program.modules for one in module.routines}
    assert not routines & set(found.names)
    alone, _ = translated(text, target, None)
    modules = {Path(file.path).stem.lower() for file in alone.files}
    assert ("name-taken-there" in told) == ("station" in modules.union(alone.names.values()))


@pytest.mark.parametrize(("target", "line"), [("tp", "DO[5]=ON"), ("rapid", "SetDO doGrip,1;")])
def test_a_signal_of_a_number_is_called_as_there(target: str, line: str, tmp_path: Path) -> None:
    done, told = translated(KRL, target, backup(tmp_path, target))
    assert line in b"".join(file.data for file in done.files).decode()
    assert ("signal-name-there" in told) == (target == "rapid")


def test_a_signal_of_a_name_gets_the_number_that_it_has_there(tmp_path: Path) -> None:
    done, _ = translated(RAPID, "tp", backup(tmp_path, "tp"))
    text = b"".join(file.data for file in done.files).decode()
    assert "DO[5:grip]=ON" in text and "DO[1:doOther]=ON" in text


def test_what_the_map_names_is_the_programs_own(tmp_path: Path) -> None:
    """A former translation stands on the robot: it is replaced and keeps its numbers."""
    first, _ = translated(KRL, "tp", None)
    for file in first.files:
        (tmp_path / file.path).write_bytes(file.data)
    again, told = translated(KRL, "tp", tmp_path, first.map)
    assert again.files == first.files
    assert "replaced-there" in told and "name-taken-there" not in told
    (tmp_path / "NUMREG.VA").write_text(NUMREG.replace("[3]", "[2]"))
    _, told = translated(KRL, "tp", tmp_path, first.map)
    assert "number-used-there" in told


SYSFRAME = """[*SYSTEM*]$MNUTOOL  Storage: SHADOW  Access: RW  : ARRAY[1,10] OF POSITION
     [1,1] =
  Group: 1   Config: N U T, 0, 0, 0
  X:     1.000   Y:     0.000   Z:    50.000
  W:     0.000   P:     0.000   R:     0.000
     [1,3] =
  Group: 1   Config: N U T, 0, 0, 0
  X:     0.000   Y:     0.000   Z:   {height}
  W:     0.000   P:     0.000   R:     0.000
"""
TOOLS = "//TOOL 1\n0.0,0.0,50.0,0.0,0.0,0.0\n//TOOL 3\n0.0,0.0,{height},0.0,0.0,0.0\n"
MOVES = """DEF station()
$TOOL={{X 0,Y 0,Z 150,A 0,B 0,C 0}}
$BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}
PTP {{X 500,Y 0,Z 600,A 0,B 90,C 0}}
END
""".format()


@pytest.mark.parametrize(
    ("target", "name", "text", "height", "selected"),
    [
        ("tp", "SYSFRAME.VA", SYSFRAME, "150.004", "UTOOL_NUM=3"),
        ("tp", "SYSFRAME.VA", SYSFRAME, "151.000", "UTOOL_NUM=2"),
        ("inform", "TOOL.CND", TOOLS, "150.004", "///TOOL 3"),
        ("inform", "TOOL.CND", TOOLS, "151.000", "///TOOL 2"),
    ],
)
def test_a_tool_of_the_robot_is_taken_where_it_is_the_same(
    target: str, name: str, text: str, height: str, selected: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_text(text.format(height=height))
    done, _ = translated(MOVES, target, tmp_path)
    assert selected in b"".join(file.data for file in done.files).decode()
