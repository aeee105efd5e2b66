"""VAR.DAT, TOOL.CND and UFRAME.CND: what the controller keeps beside its jobs. Layouts as in public backups
(lukelalondePZ/Komatsu-Press-Demo, SinaiAranda/motoman_sda20d_sys)."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources, recognise
from rpl.simulation import run_program
from rpl.source import source_from_text

VARIABLES = """//VAR
///PFNUM 6,0,0,0
///SHARE 20,20,10,10,3,4,0,0
///B
7,0,0,0,0,0,0,0,0,0
0,3,0,0,0,0,0,0,0,0
///I
0,0,0,0,0,0,0,0,0,0
0,-20,0,0,0,0,0,0,0,0
///D
100000,0,0,0,0,0,0,0,0,0
///R
0,2.5,0,0,0,0,0,0,0,0
///S

ready

///P
"UNUSED"
"PULSE"0,0,1,000000000000000000000000,0,0,1000,-2000,3000,0,0,0,0,0
"RECTAN"0,0,1,001010000000000000000000,0,16,-850.000,924.100,955.814,-90.0000,0.0000,90.0000,0.0000,0.0000
"RECTAN"0,0,0,000000000000000000000000,2,19,10.000,20.000,30.000,0.0000,0.0000,45.0000,0.0000,0.0000
///BP
///EX
"""
TOOLS = """//TOOL 0
///NAME STANDARD TOOL
0.000,0.000,0.000,0.0000,0.0000,0.0000
0.000,0.000,0.000
0.000
0.000,0.000,0.000
0.000,0,3
//TOOL 1
///NAME GRIPPER
10.000,0.000,120.000,0.0000,90.0000,0.0000
-16.507,-21.039,-136.477
104.011
0.000,0.000,0.000
0.000,0,3
"""
FRAMES = """//UFRAME 1
///NAME TABLE
///TOOL 0
///GROUP 1,0,0,0
///PULSE
////RORG C000=0,0,0,0,0,0
////RXX C001=0,0,0,0,0,0
////RXY C002=0,0,0,0,0,0
////BUSER 500.000,-20.000,300.000,0.0000,0.0000,90.0000
"""


def job(*lines: str) -> tuple[str, str]:
    head = "/JOB\n//NAME MAIN\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\n///DATE 2020/01/01 10:00\n///ATTR SC,RW\n"
    return "MAIN.JBI", head + "\n".join(("NOP", *lines, "END")) + "\n"


def read(*files: tuple[str, str]) -> tuple[ReadProgram, Diagnostics]:
    found = Diagnostics()
    return read_sources([source_from_text(*file) for file in files], "inform", found), found


@pytest.mark.parametrize("line_end", ["\n", "\r\n"])  # controllers write the second
@pytest.mark.parametrize("text", [VARIABLES, TOOLS, FRAMES])
def test_they_are_known_by_their_content(text: str, line_end: str) -> None:
    assert recognise(source_from_text("file.txt", text.replace("\n", line_end)))[0] == "inform"


def test_variables_begin_with_what_the_controller_has() -> None:
    held = 'B000=7 ANDEXP B011=3 ANDEXP I011=-20 ANDEXP D000=100000 ANDEXP R001=2.5 ANDEXP S001="ready"'
    lines = [f"IFTHENEXP {held}", "DOUT OT#(1) ON", "ENDIF"]
    program, found = read(job(*lines), ("VAR.DAT", VARIABLES))
    assert not found.has_errors, [item.as_text() for item in found]
    assert [value for *_, value in run_program(program.program).outputs] == [True]


def test_positions_tools_and_frames() -> None:
    lines = ["MOVJ P001 VJ=10.0", "MOVL P002 V=100.0", "CNVRT P010 P002 UF#(1)"]
    program, found = read(job(*lines), ("VAR.DAT", VARIABLES), ("TOOL.CND", TOOLS), ("UFRAME.CND", FRAMES))
    assert not found.has_errors, [item.as_text() for item in found]
    assert "inform-not-given" not in [item.code.name for item in found]
    from rpl.postprocessors.rpl import TARGET  # the text of the representation shows the values

    from rpl.writing.target import WriteContext

    (file,) = TARGET.write(program.program, WriteContext(Diagnostics(), None, {}, {}, False))
    text = file.data.decode()
    for part in (
        "P001: JOINTS = joints_from_pulses(1000, (-2000), 3000, 0, 0, 0)",
        "{x: (-850.0), y: 924.1, z: 955.814, c: (-90.0), b: 0.0, a: 90.0, noflip: 0, lower: 0, rear: 1, r180: 0,",
        "TL1: POSE = pose {x: 10.0, y: 0.0, z: 120.0, a: 0.0, b: 90.0, c: 0.0}",
        "UF1: POSE = pose {x: 500.0, y: (-20.0), z: 300.0, a: 90.0, b: 0.0, c: 0.0}",
    ):
        assert part in text, text


@pytest.mark.parametrize(
    ("good", "bad"),
    [
        ("7,0,0,0,0,0,0,0,0,0", "7,0,x,0,0,0,0,0,0,0"),
        ("100000,0,0,0,0,0,0,0,0,0", "1.5,0,0,0,0,0,0,0,0,0"),
        ('"UNUSED"', '"UNUSD"'),
        ('"PULSE"0,0,1,', '"PULSE"0,1,'),
        ("0,16,-850.000", "0,99,-850.000"),
    ],
)
def test_a_wrong_line_is_named(good: str, bad: str) -> None:
    assert good in VARIABLES
    text = VARIABLES.replace(good, bad)
    _, found = read(("VAR.DAT", text))
    (error,) = found.of(Severity.ERROR)
    assert error.code.name == "inform-bad-value"
    assert error.origin.line == 1 + text[: text.index(bad)].count("\n")
