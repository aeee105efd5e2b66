"""Projects of listings and dumps: registers, arguments, kinds of positions, German listings, damaged files."""

import pytest
from rpl.dialects.tp.header import read_header
from tp_reading_helpers import HOME, ROBOT, as_rpl, body, cartesian, listing, outputs, read, reports, run

from rpl import ir, registry
from rpl.diagnostics import Severity

NUMREG = """[*NUMREG*]$NUMREG  Storage: SHADOW  Access: RW  : ARRAY[200] OF Numeric Reg
  [1] = 12  'count'
  [2] = -2.700000  'X STEP'
  [3] = .500000  ''
[*NUMREG*]$MAXREGNUM  Storage: CMOS  Access: RW  : INTEGER = 200
"""
STRREG = """[*STRREG*]$STRREG  Storage: CMOS  Access: RW  : ARRAY[25] OF String Reg
  [1] = 'PICK_A'  'name of the job'
  [2] = Uninitialized
"""
POSREG = """[*POSREG*]$POSREG  Storage: SHADOW  Access: RW  : ARRAY[2,100] OF Position Reg
    [1,1] =   'home'   Group: 1
  J1 =     9.998 deg   J2 =   -45.000 deg   J3 =    30.000 deg
  J4 =    24.998 deg   J5 =   -90.000 deg   J6 =   -90.000 deg
  EXT1:    40.492 mm

    [1,2] =   'gone' Uninitialized
    [1,3] =   'pick'
  Group: 1   Config: F U T, 0, -1, 1
  X:   400.000   Y:  -109.113   Z:    12.291
  W:  -179.786   P:     -.649   R:   -58.819
  EXT1:  ******** mm
    [2,3] =   'pick'   Group: 2
  J1 =    45.000 deg
"""
SYSFRAME = """[*SYSTEM*]$MNUFRAME  Storage: SHADOW  Access: RW  : ARRAY[2,9] OF POSITION
     [1,1] =
  Group: 1   Config: N D B, 0, 0, 0
  X:  1000.500   Y:    20.000   Z:     3.000
  W:    10.000   P:    20.000   R:    30.000
     [2,1] =
  Group: 2   Config: N D B, 0, 0, 0
  X:     7.000   Y:     7.000   Z:     7.000
  W:     0.000   P:     0.000   R:     0.000

[*SYSTEM*]$MNUFRAMENUM  Storage: CMOS  Access: RW  : ARRAY[2] OF BYTE
     [1] = 1
     [2] = 0
[*SYSTEM*]$MNUTOOL  Storage: SHADOW  Access: RW  : ARRAY[2,10] OF POSITION
     [1,3] =
  Group: 1   Config: N D B, 0, 0, 0
  X:     0.000   Y:     0.000   Z:   120.000
  W:     0.000   P:     0.000   R:     0.000
"""


def variables(*texts: str) -> dict[str, ir.Variable]:
    program, diagnostics = read(*texts)
    assert not diagnostics.has_errors
    return {d.name: d for d in program.modules[0].declarations if isinstance(d, ir.Variable)}


def test_registers_start_with_the_values_of_the_dumps() -> None:
    found = as_rpl(
        read(listing("R[1]=R[2]+R[3]+R[4]\nSR[1]=SR[3]\nPR[3]=PR[3]\nJ PR[1] 50% FINE"), NUMREG, STRREG, POSREG)[0]
    )
    for line in (
        "R1: REAL = 12",
        "R2: REAL = -2.7",
        "R3: REAL = 0.5",
        'R4: REAL = VENDOR(tp, "R[4]", REAL)',
        'SR1: STRING = "PICK_A"',
        'SR3: STRING = VENDOR(tp, "SR[3]", STRING)',
        "PR1: JOINTS = joints {j1: 9.998, j2: (-45.0), j3: 30.0, j4: 24.998, j5: (-90.0), j6: (-90.0), e1: 40.492}",
    ):
        assert line in found.replace("= (-2.7)", "= -2.7"), line
    assert "flip: 1, down: 0, back: 0, t1: 0, t4: (-1), t6: 1" in found


def test_labels_of_the_dump_are_kept() -> None:
    assert variables(listing("R[1]=R[2]"), NUMREG)["R1"].label == "count"


def test_frames_of_the_dump() -> None:
    text = as_rpl(read(listing("UFRAME_NUM=1\nUTOOL_NUM=3"), SYSFRAME)[0])
    assert "{x: 1000.5, y: 20.0, z: 3.0, c: 10.0, b: 20.0, a: 30.0}" in text
    assert "z: 120.0" in text
    assert "UFRAME_NUM: INT = 1" in text and "UTOOL_NUM: INT = 1" in text
    assert "x: 7.0" not in text


def test_an_indexed_bank_of_positions_takes_the_values_of_the_dump() -> None:
    found = read(listing("J PR[R[1]] 50% FINE\nR[2]=PR[3,1]"), POSREG)
    assert not found[1].has_errors
    text = as_rpl(found[0])
    assert "PR: ARRAY[100] OF TARGET.tp" in text and 'VENDOR(tp, "PR[2:gone]", TARGET.tp), target.tp {' in text


KINDS = [
    ("PR[1]=JPOS", "JOINTS"),
    ("PR[1]=LPOS", "TARGET"),
    ("PR[1]=P[1]", "JOINTS"),
    ("PR[1]=P[2]", "TARGET"),
    ("J PR[1] 50% FINE", "TARGET"),
    ("PR[2]=JPOS\nPR[1]=PR[2]", "JOINTS"),
    ("PR[1]=PR[2]\nPR[2]=JPOS", "JOINTS"),
    ("PR[1]=JPOS-JPOS", "JOINTS"),
    ("PR[1]=UFRAME[1]", "TARGET"),
    ("UTOOL[1]=PR[1]", "TARGET"),
]


@pytest.mark.parametrize(("lines", "kind"), KINDS, ids=[case[0] for case in KINDS])
def test_what_a_position_register_holds_is_seen_from_its_use(lines: str, kind: str) -> None:
    assert f"PR1: {kind}" in as_rpl(read(listing(lines))[0])


def test_a_register_with_both_kinds_is_reported_with_both_places() -> None:
    program, diagnostics = read(listing("PR[1]=LPOS\nPR[1]=JPOS"))
    (report,) = list(diagnostics)
    assert report.code.name == "tp-mixed-position-register"
    assert report.origin.line == 6 and "file0.ls:5" in report.message
    assert "joints_to_target(current_joints())" in as_rpl(program)


def test_elements_of_a_register_with_both_kinds_are_an_error() -> None:
    _, diagnostics = read(listing("PR[1]=LPOS\nPR[1]=JPOS\nPR[1,3]=5"))
    assert reports(diagnostics, Severity.ERROR) == ["tp-mixed-position-elements"]


def test_frames_that_no_program_selects_are_those_of_the_dump() -> None:
    text = as_rpl(read(listing("L P[2] 100mm/sec FINE\nPR[1]=LPOS"), SYSFRAME)[0])
    assert "TO P2 TOOL" not in text and "FRAME UFRAME[1]" in text
    assert "current_target($tool, UFRAME[1])" in text
    assert "FRAME UFRAME[1]" not in as_rpl(read(listing("UFRAME_NUM=2\nL P[2] 100mm/sec FINE"), SYSFRAME)[0])


def test_arguments_are_numbered_parameters() -> None:
    called = listing("R[1]=AR[1]\nSR[1]=AR[2]", "", "SUB")
    program, diagnostics = read(listing("CALL SUB(R[5],'a',PR[1,1])"), called)
    assert not diagnostics.has_errors
    parameters = program.modules[2].routines[0].parameters
    assert [(p.name, p.type) for p in parameters] == [
        ("AR1", ir.RealType()),
        ("AR2", ir.StringType()),
        ("AR3", ir.RealType()),
    ]


def test_a_missing_program_is_a_warning() -> None:
    assert reports(read(listing("CALL NOWHERE"))[1]) == ["unknown-routine"]


def test_two_programs_of_one_name_are_reported() -> None:
    assert reports(read(listing("R[1]=1"), listing("R[1]=2"))[1]) == ["tp-program-twice"]


def test_system_program_names_become_names() -> None:
    program, diagnostics = read(listing("DO[1]=ON", "", "-BCKED9-"))
    assert not diagnostics.has_errors and program.modules[0].name == "_BCKED9_"


def test_the_header_is_kept() -> None:
    program, _ = read(listing("DO[1]=ON", "", "TOOLS", "Macro"))
    assert program.modules[0].attributes == (("PROG", "TOOLS"), ("PROG_TYPE", "Macro"), ("COMMENT", '"test"'))


# ---- positions


def positions(text: str) -> str:
    program, diagnostics = read(listing("R[1]=0", text))
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return as_rpl(program)


def test_several_groups_and_extended_axes_are_external_axes() -> None:
    text = positions(
        "P[1:\"at the table\"]{\n   GP1:\n\tUF : 1, UT : 1,\t\tCONFIG : 'F D B, 1, -1, 0',\n"
        "\tX =  1.5  mm,\tY =  -.384  mm,\tZ = 3 mm,\n\tW = 4 deg,\tP = 5 deg,\tR = 6 deg,\n\tE1= 451.688  mm\n"
        "   GP2:\n\tUF : 1, UT : 1,\t\n\tJ1= 45.0 deg,\tJ2= -10.0 deg\n};\n"
    )
    assert (
        "{x: 1.5, y: (-0.384), z: 3.0, c: 4.0, b: 5.0, a: 6.0, flip: 1, down: 1, back: 1, t1: 1, t4: (-1), t6: 0, "
        "e1: 451.688, e2: 45.0, e3: (-10.0)}"
    ) in text


def test_positions_without_spaces_and_of_remote_tools() -> None:
    text = positions(
        "P[1]{ GP1: UF:0,UT:1,CONFIG:'N U T, 0, 0, 0',RX=1 mm,RY=2 mm,RZ=3 mm,RW=4 deg,RP=5 deg,RR=6 deg };\n"
    )
    assert "{x: 1.0, y: 2.0, z: 3.0, c: 4.0, b: 5.0, a: 6.0" in text


def test_a_damaged_position_costs_itself_alone() -> None:
    broken = "P[7]{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0',\n\tX = 1 mm\n};\n"
    program, diagnostics = read(listing("J P[1] 50% FINE", broken + HOME))
    assert reports(diagnostics, Severity.ERROR) == ["unreadable-statement"]
    assert "CONST P1: JOINTS" in as_rpl(program)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("lost line\n/PROG  A\n/MN\n   1:  R[1]=1 ;\n/POS\n/END\n", "unreadable-statement"),
        ("/PROG  A\n/MN\n   1:  R[1]=1 ;\n/END\n   2:  R[1]=2 ;\n/POS\n", "tp-instruction"),
        ("/ATTR\n/MN\n   1:  R[1]=1 ;\n/PROG  A\n   2:  R[1]=2 ;\n/POS\n/END\n", "tp-instruction"),
    ],
)
def test_a_section_out_of_its_place_is_reported(text: str, expected: str) -> None:
    _, diagnostics = read(text)
    found = [item.code.name for item in diagnostics]
    assert expected in found
    assert "unclaimed-text" not in found


def test_a_written_position_is_no_constant() -> None:
    program, _ = read(listing("P[2]=LPOS\nL P[2] 100mm/sec FINE", cartesian(2, 1, 2, 3)))
    assert "PERSISTENT P2" in as_rpl(program)


# ---- German listings

GERMAN = [
    ("A[15:Licht]=AN", "SET do[15] TO ON"),
    ("A[15]=(AUS)", "SET do[15] TO OFF"),
    ("i[1]=i[1]+1", "R1 = R1 + 1"),
    ("gA[2]=gE[3]", "SET go[2] TO gi[3]"),
    ("WARTE (E[9] [&] !F[2] [+] (TIMER[10]>=0))", "WAIT UNTIL (di[9] AND NOT flag[2]) OR $timer[10] >= 0"),
    ("WARTE    .10(sec)", "WAIT 0.1"),
    ("WARTE    .10(Sek)", "WAIT 0.1"),
    ("TIMER[3]=STOPP", "$timer_stopped[3] = TRUE"),
    ("AUFRUF MAIN", "MAIN()"),
    ("TRAGLST[1]", 'VENDOR tp "PAYLOAD[1]" EFFECT tuning'),
    ("ENDE", "RETURN"),
    ("L P[2] 10mm/sek CNT0 ACC250", "MOVE LINEAR TO P2 SPEED 10 ACCELERATION 250 BLEND PERCENT 0"),
    ("L P[2] max_Geschw. FINE", "MOVE LINEAR TO P2 SPEED 2000.0 FINE"),
    (
        "J P[1] 100% CNT0 ZEIT VOR    .10sek,A[1]=AN",
        "MOVE TO P1 JOINT SPEED 100 BLEND PERCENT 0 TRIGGER AT end DELAY (-0.1) DO SET do[1] TO ON",
    ),
    ("FB-PSPS (M[2] [&] M[30])", 'VENDOR tp "FB-PSPS (M[2] [&] M[30])" EFFECT unknown'),
]


@pytest.mark.parametrize(("line", "meaning"), GERMAN, ids=[case[0] for case in GERMAN])
def test_a_german_statement_means(line: str, meaning: str) -> None:
    points = HOME + cartesian(2, 400, 100, 200).replace("CONFIG", "KONFIG")
    program, diagnostics = read(listing(line, points, german=True).encode("latin-1"))
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    text = as_rpl(program).partition("PROCEDURE MAIN")[2]
    assert meaning in text


def test_german_jumps() -> None:
    text = listing("WENN (!E[15]),SPRUNG LABEL[1]\nLABEL[1]\nWKZ_NUM=1\nBENUTZER_NUM=0", german=True)
    assert "GOTO LBL1" in as_rpl(read(text)[0])


def test_the_header_of_a_german_listing_is_read_in_english() -> None:
    header = read_header("/PROG  UP20\n/ATTR\nEIGN.\t\t= MNEDITOR;\nERSTELL\t\t= TAG 25-11-03  ZEIT 13:36:58;\n/MN\n")
    assert header.attributes == (("OWNER", "MNEDITOR"), ("CREATE", "DATE 25-11-03  TIME 13:36:58"))


def test_german_words_stay_in_english_listings() -> None:
    assert body("R[1]=0\nMESSAGE[WARTE AUF E]")[-1] == 'MESSAGE "WARTE AUF E"'


# ---- layout of files


@pytest.mark.parametrize(
    ("text", "score"),
    [
        ("/PROG  A\n/ATTR\n/MN\n/POS\n/END\n", True),
        ("/MN\n   1:  DO[1]=ON ;\n/POS\n/END\n", True),
        (NUMREG, True),
        (SYSFRAME, True),
        ("Error log\n  1 SRVO-001 operator panel\n", False),
        ("[*SYSTEM*]$BLAL_OUT  Storage: CMOS  Access: RW  : INTEGER = 0\n", False),
    ],
)
def test_the_content_tells_a_listing_from_a_log(text: str, score: bool) -> None:
    assert (registry.dialect("tp").recognise("a.ls", text) > 50) == score


@pytest.mark.parametrize("line", ["\n", "\r\n", " \n"])
def test_recognition_ends_on_long_empty_texts(line: str) -> None:
    assert registry.dialect("tp").recognise("a.ls", line * 100_000 + "x") == 0


LAYOUTS = [
    "/PROG A\n/MN\n: DO[1]=ON;\n: WAIT R[33]=3;\n/POS\n/END\n",
    "/PROG  A\r\n/ATTR\r\n/MN\r\n   1:  DO[1]=ON ;\r\n   2:   ;\r\n/POS\r\n/END\r\n",
    "/PROG  A\n/MN\n   1:  DO[1]=(DI[1]=ON AND DI[2]=ON AND\n    :  DI[3]=ON) ;\n/POS\n/END\n",
    "/PROG  A\n/MN\n   1:  DO[1]=ON ;\n   2:\n",
    "/PROG  A\n/MN\n   1:  DO[1]=ON ;\n/POS\n",
    "/PROG  A\n/MN\n   1:  DO[1]=ON ;\n",
]


@pytest.mark.parametrize("text", LAYOUTS)
def test_every_character_of_a_file_is_accounted_for(text: str) -> None:
    program, diagnostics = read(text)
    assert {item.code.name for item in diagnostics} <= {"tp-cut-off"}, [item.as_text() for item in diagnostics]
    assert "SET do[1] TO" in as_rpl(program)


# ---- what programs do


def test_a_wait_with_a_time_limit_jumps() -> None:
    lines = "$WAITTMOUT=200\nWAIT DI[1]=ON TIMEOUT,LBL[1]\nDO[1]=ON\nEND\nLBL[1]\nDO[2]=ON"
    late = run(listing(lines))
    assert outputs(late) == [("DO[2]", True)] and late.outputs[0][0] == pytest.approx(2.0)
    met = run(listing(lines), cell='[[input]]\ntime = 1.0\nsignal = "DI[1]"\nvalue = true')
    assert outputs(met) == [("DO[1]", True)]


def test_a_user_alarm_pauses_the_program() -> None:
    result = run(listing("UALM[1]\nDO[1]=ON"))
    assert (result.status, result.messages, outputs(result)) == ("stopped", ("UALM[1]",), [])


def test_a_task_runs_beside_the_caller() -> None:
    other = listing("WAIT   1.00(sec)\nDO[2]=ON", "", "SIDE")
    result = run(listing("RUN SIDE\nWAIT    .50(sec)\nDO[1]=ON\nWAIT   1.00(sec)"), other)
    assert outputs(result) == [("DO[1]", True), ("DO[2]", True)]


def test_a_condition_monitor_calls_its_program() -> None:
    watch = listing("WHEN DI[1]=ON,CALL ALARM", "", "WATCH", "Cond")
    alarm = listing("DO[9]=ON", "", "ALARM")
    lines = "MONITOR WATCH\nWAIT   2.00(sec)\nDO[1]=ON\nMONITOR END WATCH"
    cell = '[[input]]\ntime = 1.0\nsignal = "DI[1]"\nvalue = true'
    result = run(listing(lines), watch, alarm, cell=cell)
    assert outputs(result) == [("DO[9]", True), ("DO[1]", True)]
    assert result.outputs[0][0] == pytest.approx(1.0)
    ended = run(listing("MONITOR WATCH\nMONITOR END WATCH\nWAIT   2.00(sec)\nDO[1]=ON"), watch, alarm, cell=cell)
    assert outputs(ended) == [("DO[1]", True)]


def test_an_edge_that_was_there_before_does_not_come() -> None:
    """Measured on a virtual controller (CrossArm): a level comes at once when it is armed, an edge does not."""
    alarm = listing("DO[9]=ON", "", "ALARM")
    cell = '[[input]]\ntime = 0.5\nsignal = "DI[1]"\nvalue = true'
    lines = listing("WAIT   1.00(sec)\nMONITOR WATCH\nWAIT   1.00(sec)\nDO[1]=ON")
    for condition, seen in (("DI[1]=ON", True), ("DI[1]=ON+", False)):
        watch = listing(f"WHEN {condition},CALL ALARM", "", "WATCH", "Cond")
        assert (("DO[9]", True) in outputs(run(lines, watch, alarm, cell=cell))) == seen


LOOPS = [  # examples of the operator's manual, FOR/ENDFOR
    ("R[2]=3\nFOR R[1]=1 TO R[2]\nR[3]=R[3]+1\nENDFOR", 3, 3),
    ("R[2]=1\nFOR R[1]=1 TO R[2]\nR[3]=R[3]+1\nENDFOR", 1, 1),
    ("R[2]=0\nFOR R[1]=1 TO R[2]\nR[3]=R[3]+1\nENDFOR", 1, 0),
    ("FOR R[1]=6 TO 10\nR[1]=R[1]+1\nR[3]=R[3]+1\nENDFOR", 11, 3),
    ("FOR R[1]=1 TO 10\nIF R[1]=4,R[1]=11\nR[3]=R[3]+1\nENDFOR", 11, 4),
    ("R[2]=10\nFOR R[1]=1 TO R[2]\nR[2]=3\nR[3]=R[3]+1\nENDFOR", 3, 3),
    ("FOR R[1]=3 DOWNTO 1\nR[3]=R[3]+1\nENDFOR", 1, 3),
]


@pytest.mark.parametrize("indexed", [False, True])
@pytest.mark.parametrize(("lines", "counter", "passes"), LOOPS)
def test_loops_count_as_the_manual_says(lines: str, counter: int, passes: int, indexed: bool) -> None:
    head = "R[9]=9\nR[R[9]]=9\n" if indexed else ""
    result = run(listing(f"{head}{lines}\nIF R[1]={counter} AND R[3]={passes},DO[1]=ON"))
    assert outputs(result) == [("DO[1]", True)]


def test_texts_are_equal_whatever_their_case() -> None:
    """Measured on a virtual controller (CrossArm)."""
    lines = "SR[1]='Robot'\nSR[2]='ROBOT'\nR[1]=FINDSTR SR[1],SR[2]\nIF SR[1]=SR[2],DO[1]=ON\nIF R[1]=1,DO[2]=ON"
    assert outputs(run(listing(lines))) == [("DO[1]", True), ("DO[2]", True)]


def test_timers_count_from_their_start() -> None:
    lines = "TIMER[1]=RESET\nTIMER[1]=START\nWAIT   1.50(sec)\nTIMER[1]=STOP\nWAIT   1.00(sec)\nR[1]=TIMER[1]\n"
    result = run(listing(lines + "IF R[1]>1.49 AND R[1]<1.51,DO[1]=ON"))
    assert outputs(result) == [("DO[1]", True)]


def test_registers_by_the_cell_file() -> None:
    result = run(listing("IF R[5]=3 AND SR[1]='x',DO[1]=ON"), cell='[variables]\nR5 = 3\nSR1 = "x"')
    assert outputs(result) == [("DO[1]", True)]


def test_the_robot_of_the_tests_is_a_fanuc() -> None:
    assert ROBOT.startswith("fanuc")
