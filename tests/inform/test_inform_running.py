"""What jobs do on the emulated arm."""

import pytest
from inform_helpers import body_of, job, outputs, read, run

from rpl import ir
from rpl.errors import RunError

POINTS = """
///TOOL 0
///POSTYPE BASE
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=400.000,0.000,400.000,180.0000,0.0000,0.0000
C00001=400.000,100.000,400.000,180.0000,0.0000,0.0000
C00002=450.000,150.000,400.000,180.0000,0.0000,0.0000
C00003=500.000,100.000,400.000,180.0000,0.0000,0.0000
C00004=450.000,50.000,400.000,180.0000,0.0000,0.0000
P00001=0.000,0.000,50.000,0.0000,0.0000,0.0000
"""


def test_a_wait_with_a_limit_goes_on() -> None:
    result = run(job("WAIT IN#(1)=ON T=0.50\nGETS B000 $B014\nDOUT OT#(1) ON IF B000=0\nRET"))
    assert (result.status, round(result.time_s, 6)) == ("finished", 0.5)
    assert outputs(result) == [("OT#(1)", True)]


def test_a_search_stops_and_tells_the_place() -> None:
    body = """
MOVJ C00000 VJ=50.00 PL=0
MOVL C00001 V=50.0 SRCH RIN#(1)=ON T=1.00 DIS=5.0
GETS B000 $B002
GETS PX002 $PX003
GETE D000 P002 (2)
DOUT OT#(1) ON IF B000=1
IFTHENEXP D000>20000 ANDEXP D000<80000
DOUT OT#(2) ON
ENDIF
"""
    cell = '[[input]]\ntime = 1.4\nsignal = "RIN1"\nvalue = true\n'
    assert outputs(run(job(body, POINTS), cell=cell)) == [("OT#(1)", True), ("OT#(2)", True)]
    missed = run(job(body, POINTS))
    assert missed.status == "finished"
    assert ("OT#(1)", True) not in outputs(missed)


def test_a_shift_moves_what_follows_until_it_ends() -> None:
    body = """
SFTON P001
MOVJ C00000 VJ=50.00 PL=0
GETS PX002 $PX001
SFTOF
MOVJ C00000 VJ=50.00 PL=0
GETS PX003 $PX001
GETE D000 P002 (3)
GETE D001 P003 (3)
DOUT OT#(1) ON IF D000=450000
DOUT OT#(2) ON IF D001=400000
"""
    assert outputs(run(job(body, POINTS))) == [("OT#(1)", True), ("OT#(2)", True)]


def test_jobs_get_their_arguments_by_number() -> None:
    called = job(
        "GETARG LI000 IARG#(1)\nGETARG LR000 IARG#(2)\nMUL LR000 LI000\nDOUT OT#(1) ON IF LR000=7.5", name="SUB"
    )
    assert outputs(run(job("CALL JOB:SUB ARGF3 ARGF2.5"), called)) == [("OT#(1)", True)]


def test_tasks_meet_where_they_synchronise() -> None:
    first = job("PSTART JOB:OTHER SUB1\nTIMER T=0.50\nTSYNC 1\nDOUT OT#(1) ON\nPWAIT SUB1\nDOUT OT#(3) ON")
    other = job("TSYNC 1\nTIMER T=0.10\nDOUT OT#(2) ON", name="OTHER")
    result = run(first, other)
    assert [(round(t, 6), name) for t, name, _ in result.outputs] == [
        (0.5, "OT#(1)"),
        (0.6, "OT#(2)"),
        (0.6, "OT#(3)"),
    ]


def test_a_job_that_jumps_to_itself_starts_again() -> None:
    assert run(job("INC B000\nJUMP JOB:TEST IF B000<5\nDOUT OT#(1) ON IF B000=5")).status == "finished"


def test_an_alarm_stops_the_program() -> None:
    result = run(job('SETUALM 8005 "NO PART" 1\nDOUT OT#(1) ON'))
    assert (result.status, outputs(result)) == ("stopped", [])


def test_the_fourth_point_of_an_arc_lies_on_its_circle() -> None:
    points = POINTS.replace("C00004=450.000,50.000", "C00004=450.000,50.000")
    body = body_of(job("MOVC C00001 V=50.0\nMOVC C00002 V=50.0\nMOVC C00003 V=50.0\nMOVC C00004 V=50.0 PL=0", points))
    moves = [statement for statement in body if isinstance(statement, ir.Move)]
    assert [move.kind for move in moves] == ["linear", "circular", "circular"]
    assert moves[1].via == ir.Name("C00002")
    via = moves[2].via
    assert isinstance(via, ir.Builtin)
    assert via.function == "arc_middle"
    whole = "\n".join(f"MOVC C0000{n} V=50.0 PL=0" for n in (1, 2, 3, 4))
    checked = "\nGETS PX002 $PX001\nGETE D000 P002 (1)\nDOUT OT#(1) ON IF D000=450000"
    assert outputs(run(job("MOVJ C00000 VJ=50.00 PL=0\n" + whole + checked, points))) == [("OT#(1)", True)]


def test_two_points_are_no_arc() -> None:
    _, diagnostics = read(job("MOVC C00001 V=50.0\nMOVC C00002 V=50.0", POINTS))
    assert "inform-short-arc" in {item.code.name for item in diagnostics}


PULSES = "///TOOL 0\n///POSTYPE PULSE\n///PULSE\nC00000=13414,0,0,0,-88221,0"


def test_pulses_need_an_arm_that_has_them() -> None:
    text = job("MOVJ C00000 VJ=50.00 PL=0\nGETS PX001 $PX000\nGETE D000 P001 (1)\nDOUT OT#(1) ON IF D000=13414", PULSES)
    assert outputs(run(text, robot="motoman_ma2010")) == [("OT#(1)", True)]
    with pytest.raises(RunError, match="pulses_per_degree"):
        run(text, robot="motoman_gp7")
    # an arm whose own controller counts none: 10000 per degree
    text = text.replace("D000=13414", "D000=50000")
    assert outputs(run(text.replace("C00000=13414", "C00000=50000"), robot="abb_irb1200_5_90")) == [("OT#(1)", True)]


def test_pulses_and_a_pose_in_one_variable() -> None:
    """CNVRT turns the pulses of a position into a pose in the same variable."""
    text = job(
        "MOVJ C00000 VJ=50.00 PL=0\nGETS LPX000 $PX000\nCNVRT LPX000 LPX000 BF\nGETS LPX001 $PX001\n"
        "GETE LD000 LP000 (1)\nGETE LD001 LP001 (1)\nDOUT OT#(1) ON IF LD000=LD001",
        PULSES,
    )
    assert outputs(run(text, robot="motoman_ma2010")) == [("OT#(1)", True)]


@pytest.mark.parametrize(("given", "kept"), [("7.9", 7), ("-7.9", -7)])
def test_whole_numbers_lose_decimals(given: str, kept: int) -> None:
    """M: SET of a real number to a whole one drops its decimals."""
    assert outputs(run(job(f"SET R000 {given}\nSET I000 R000\nDOUT OT#(1) ON IF I000={kept}"))) == [("OT#(1)", True)]


@pytest.mark.parametrize("also", ["", "\nSET B000 1\nSET D[B000] D001"])
def test_the_last_value_of_a_loop_is_looked_up_once(also: str) -> None:
    """M. The same where the bank is an array because some number of a variable is computed."""
    text = f"SET D003 0\nSET D002 4\nFOR D000=1 TO D002\nSET D002 2\nADD D003 D000\nNEXT D000{also}"
    checked = "\nDOUT OT#(1) ON IF D003=10\nDOUT OT#(2) ON IF D000=5"
    assert outputs(run(job(text + checked))) == [("OT#(1)", True), ("OT#(2)", True)]


@pytest.mark.parametrize(
    ("lines", "good"),
    [
        ("SET B000 255\nADD B000 0", True),
        ("SET B000 250\nADD B000 10", False),
        ("SET B000 0\nDEC B000", False),
        ("SET LB000 200\nADD LB000 LB000", False),
        ("SET D000 3\nSET B[D000] 300", False),
        ("SET I000 32767\nINC I000", False),
        ("SET I000 -32768", True),
        ("SET D000 2147483647\nINC D000", False),
        ("SET D000 65536\nMUL D000 32767", True),
    ],
)
def test_numbers_beyond_their_variable_are_an_alarm(lines: str, good: bool) -> None:
    """Operator's manuals: B has one byte without sign, I two, D four. M: the alarm comes where it is stored."""
    result = run(job(f"{lines}\nDOUT OT#(1) ON"))
    assert (result.status == "finished") is good and bool(result.outputs) is good
