"""V+ programs that run: each sets output 1 when what it says holds, or shows the order of what happens."""

from __future__ import annotations

import pytest
from vplus_helpers import outputs, program_of, read, run

from rpl.cell.cellfile import Cell, parse_cell
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.linking.program import link
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text
from rpl.translation import translate_program


def inputs(*changes: tuple[float, int, bool]) -> Cell:
    """A cell that switches inputs at these times."""
    rows = (f'[[input]]\ntime = {t}\nsignal = "{n}"\nvalue = {str(v).lower()}\n' for t, n, v in changes)
    return parse_cell("".join(rows))


HOLDS = [
    ("division is real", "n = 7/2\nIF n == 3.5 THEN\nSIGNAL 1\nEND"),
    ("MOD has the sign of the dividend", "IF (-7 MOD 3 == -1) AND (7 MOD -3 == 1) THEN\nSIGNAL 1\nEND"),
    ("INT cuts toward zero", "IF (INT(-2.7) == -2) AND (FRACT(-2.5) == -0.5) THEN\nSIGNAL 1\nEND"),
    ("SIGN of zero is one", "IF (SIGN(0) == 1) AND (SIGN(-3) == -1) AND (SIGN(2) == 1) THEN\nSIGNAL 1\nEND"),
    ("a comparison is minus one", "n = (3 < 4)+(2 < 1)\nIF n == -1 THEN\nSIGNAL 1\nEND"),
    ("TRUE is minus one", "n = TRUE*2\nIF n == -2 THEN\nSIGNAL 1\nEND"),
    ("any number but zero is true", "n = 0.5\nIF n THEN\nSIGNAL 1\nEND"),
    ("FOR passes its bound", "FOR n = 1 TO 3\nEND\nIF n == 4 THEN\nSIGNAL 1\nEND"),
    (
        "FOR looks at its bounds once",
        "m = 3\nk = 0\nFOR n = 1 TO m\nm = 9\nk = k+1\nEND\nIF k == 3 THEN\nSIGNAL 1\nEND",
    ),
    ("FOR may make no pass", "k = 0\nFOR n = 3 TO 1\nk = 1\nEND\nIF k == 0 THEN\nSIGNAL 1\nEND"),
    ("an element counts", "FOR a[2] = 1 TO 3\nEND\nIF a[2] == 4 THEN\nSIGNAL 1\nEND"),
    ("DO runs at least once", "k = 0\nDO\nk = k+1\nUNTIL TRUE\nIF k == 1 THEN\nSIGNAL 1\nEND"),
    (
        "EXIT 2 leaves both loops",
        "k = 0\nFOR n = 1 TO 3\nFOR m = 1 TO 3\nk = k+1\nIF m == 2 THEN\nEXIT 2\nEND\nEND\nEND\n"
        "IF (k == 2) AND (n == 1) THEN\nSIGNAL 1\nEND",
    ),
    (
        "NEXT 2 goes on with the outer loop",
        "k = 0\nFOR n = 1 TO 3\nWHILE TRUE DO\nk = k+1\nNEXT 2\nEND\nEND\nIF (k == 3) AND (n == 4) THEN\nSIGNAL 1\nEND",
    ),
    (
        "only the first fitting VALUE",
        "CASE 2 OF\nVALUE 1,2:\nn = 5\nVALUE 2:\nn = 6\nEND\nIF n == 5 THEN\nSIGNAL 1\nEND",
    ),
    (
        "CASE of truths",
        "n = 7\nCASE TRUE OF\nVALUE n < 5:\nn = 1\nVALUE n > 5: n = 2\nEND\nIF n == 2 THEN\nSIGNAL 1\nEND",
    ),
    ("a text and its parts", '$a = "abc"\nIF ($MID($a,2,9) == "bc") AND (ASC($a,3) == 99) THEN\nSIGNAL 1\nEND'),
    (
        "DECODE takes words and separators",
        '$a = "12, 34"\n$b = $DECODE($a, ", ", 0)\n$c = $DECODE($a, ", ", 1)\n'
        'IF ($b == "12") AND ($c == ", ") AND ($a == "34") THEN\nSIGNAL 1\nEND',
    ),
    (
        "DECODE inside of an expression takes its words in order",
        '$a = "12,34 56"\n$b = $DECODE($a, ",", 0)+"-"+$DECODE($a, ",", 1)+$DECODE($a, " ", 0)\n'
        'IF ($b == "12-,34") AND ($a == " 56") THEN\nSIGNAL 1\nEND',
    ),
    (
        "DECODE in the condition of WHILE takes a word in each pass",
        '$a = "ab,c,,d"\nk = 0\nWHILE LEN($DECODE($a, ",", 0)) > 0 DO\nk = k+1\n$b = $DECODE($a, ",", 1)\nEND\n'
        "IF k == 3 THEN\nSIGNAL 1\nEND",
    ),
    ("DECODE as an argument", '$a = "7;8"\nIF VAL($DECODE($a, ";")) == 7 THEN\nIF $a == ";8" THEN\nSIGNAL 1\nEND\nEND'),
    ("ENCODE puts a blank for the sign", '$a = "P"+$ENCODE(11000)\nIF $a == "P 11000" THEN\nSIGNAL 1\nEND'),
    ("bits", "IF ((^HFF BAND ^B1010) == 10) AND (BMASK(1,3) == 5) AND (^17 == 15) THEN\nSIGNAL 1\nEND"),
    ("a name counts with 15 characters", "a.very.long.name.one = 3\nIF a.very.long.namX == 3 THEN\nSIGNAL 1\nEND"),
    ("capitals do not matter", "Count = 3\nif COUNT == 3 then\nSignal 1\nend"),
    ("a variable may be called like a word", "value[1] = 3\nany = value[1]\nIF any == 3 THEN\nSIGNAL 1\nEND"),
    (
        "DECOMPOSE of a whole array begins at 0",
        "SET p = TRANS(7,8,9)\nDECOMPOSE a[] = p\nIF a[0] == 7 THEN\nSIGNAL 1\nEND",
    ),
    ("the declared size is the last index", "AUTO a[5]\na[5] = 1\nIF a[5] == 1 THEN\nSIGNAL 1\nEND"),
    ("what is defined", "n = 1\nIF DEFINED(n) AND NOT DEFINED(m) THEN\nSIGNAL 1\nEND"),
    (
        "locations compose and invert",
        "SET a = TRANS(10,20,30,40,50,60)\nSET b = INVERSE(a):a\nIF DISTANCE(b, NULL) < 0.0001 THEN\nSIGNAL 1\nEND",
    ),
    (
        "yaw, pitch, roll come back",
        "AUTO c[6]\nSET a = TRANS(1,2,3,40,50,60)\nDECOMPOSE c[1] = a\n"
        "IF (c[1] == 1) AND (ABS(c[4]-40) < 0.001) AND (ABS(c[5]-50) < 0.001) AND (ABS(c[6]-60) < 0.001) THEN\n"
        "SIGNAL 1\nEND",
    ),
    (
        "tool down has all of its turn in roll",
        "AUTO c[6]\nSET a = TRANS(0,0,0,30,180,0)\nDECOMPOSE c[1] = a\n"
        "IF (c[4] == 0) AND (ABS(c[5]-180) < 0.001) AND (ABS(c[6]+30) < 0.001) THEN\nSIGNAL 1\nEND",
    ),
    (
        "FRAME: x from a to b, origin at d",
        "SET f = FRAME(TRANS(1,0,0), TRANS(1,5,0), TRANS(-3,0,0), TRANS(7,8,9))\nSET p = f:TRANS(2,0,0)\n"
        "IF (ABS(DX(p)-7) < 0.001) AND (ABS(DY(p)-10) < 0.001) AND (DZ(p) == 9) THEN\nSIGNAL 1\nEND",
    ),
    ("RX turns about x", "SET p = RX(90):TRANS(0,1,0)\nIF ABS(DZ(p)-1) < 0.0001 THEN\nSIGNAL 1\nEND"),
    (
        "the sign of a signal number in a variable",
        "n = -1005\nIF SIG(n) THEN\nn = 1005\nIF NOT SIG(n) THEN\nSIGNAL 1\nEND\nEND",
    ),
    (
        "SCALE leaves the orientation",
        "n = 3\nSET p = SCALE(TRANS(10,20,30,0,180,40) BY 0.5)\nSET q = SCALE(p BY n)\n"
        "IF (DX(p) == 5) AND (DZ(q) == 45) AND (DISTANCE(q:TRANS(0,0,1), TRANS(15,30,44)) < 0.001) THEN\nSIGNAL 1\nEND",
    ),
    (  # M: BASE says how the robot was moved; what it stands at is seen from the world
        "BASE compensates for a robot that was moved",
        "MOVE TRANS(300,0,260,0,180)\nBREAK\nBASE 10,20,40,90\nSET b = BASE\n"
        "IF (DISTANCE(HERE, TRANS(10,320,300)) < 0.01) AND (DISTANCE(b, TRANS(10,20,40)) < 0.01) THEN\nSIGNAL 1\nEND",
    ),
    ("SHIFT moves in the world", "SET p = SHIFT(RZ(90) BY 5,0,0)\nIF DX(p) == 5 THEN\nSIGNAL 1\nEND"),
]


@pytest.mark.parametrize(("what", "text"), HOLDS, ids=[what for what, _ in HOLDS])
def test_it_holds(what: str, text: str) -> None:
    assert outputs(run(text)) == [("1", True)], what


@pytest.mark.parametrize("beside", ["", "REACT 1001, other\n", "EXECUTE 1 other()\n"])
def test_a_comparison_as_an_argument_is_minus_one_beside_reactions_and_tasks(beside: str) -> None:
    more = (
        ".PROGRAM show(flag, n)\nIF flag == -1 THEN\nSIGNAL n\nEND\nflag = 5\n.END\n"
        ".PROGRAM other()\nWAIT.EVENT , 0.1\n.END"
    )
    text = f"{beside}a = 7\nx = a > 5\nCALL show(a > 5, 1)\nCALL show(NOT (a > 5), 2)\nCALL show(x, 3)"
    text = f"{text}\nCALL show(SIG(-1001), 4)"
    assert outputs(run(f"{text}\nIF x == 5 THEN\nSIGNAL 5\nEND", more)) == [(n, True) for n in ("1", "3", "4", "5")]


@pytest.mark.parametrize("number", ["n", "1*n", "-1*m"])
def test_the_sign_of_a_signal_number_counts_when_the_program_runs(number: str) -> None:
    body = f"FOR n = -6 TO 7 STEP 13\nm = -n\nk = k+k\nIF SIG({number}) THEN\nk = k+1\nEND\nEND"
    checks = "IF k == 3 THEN\nSIGNAL 1\nEND"
    assert outputs(run(f"SIGNAL 7\nk = 0\n{body}\nSIGNAL -7\n{checks}"))[-1] == ("1", True)


@pytest.mark.parametrize("step", ['$b = $a+$DECODE($a, ",")', 'DO\nUNTIL $DECODE($a, ",") == ""'])
def test_decode_is_not_read_where_its_order_cannot_be_kept(step: str) -> None:
    _, diagnostics = read(program_of(f'$a = "1,2"\n{step}'))
    assert "$DECODE" in " ".join(item.as_text() for item in diagnostics)


def test_arguments_are_passed_by_reference_and_in_brackets_by_value() -> None:
    more = ".PROGRAM add(a)\na = a+1\n.END"
    assert outputs(
        run("n = 1\nm = 1\nCALL add(n)\nCALL add((m))\nIF (n == 2) AND (m == 1) THEN\nSIGNAL 1\nEND", more)
    ) == [("1", True)]


def test_a_missing_argument_is_undefined_in_the_program() -> None:
    more = ".PROGRAM look(a, b)\nIF DEFINED(a) AND NOT DEFINED(b) THEN\nSIGNAL 1\nEND\n.END"
    assert outputs(run("n = 1\nCALL look(n)", more)) == [("1", True)]


def test_programs_call_themselves_with_their_own_variables() -> None:
    more = ".PROGRAM fac(n, r)\nAUTO m\nIF n < 2 THEN\nr = 1\nELSE\nCALL fac(n-1, m)\nr = n*m\nEND\n.END"
    assert outputs(run("CALL fac(5, r)\nIF r == 120 THEN\nSIGNAL 1\nEND", more)) == [("1", True)]


def test_local_variables_keep_their_value_between_calls() -> None:
    more = ".PROGRAM tick(first)\nLOCAL n\nIF first THEN\nn = 0\nEND\nn = n+1\ncount = n\n.END"
    assert outputs(run("CALL tick(TRUE)\nCALL tick(FALSE)\nIF count == 2 THEN\nSIGNAL 1\nEND", more)) == [("1", True)]


def test_a_program_is_called_by_a_text() -> None:
    more = ".PROGRAM part2(n)\nSIGNAL n\n.END"
    assert outputs(run('$p = "part2"\nCALLS $p(7)', more)) == [("7", True)]


def test_a_step_behind_a_move_acts_when_the_move_begins() -> None:
    text = (
        "SPEED 20 ALWAYS\nMOVE #PPOINT(20,-90,180,0,60,0)\nSIGNAL 1\nMOVE #PPOINT(-20,-90,180,0,60,0)\nSIGNAL 2\n"
        "BREAK\nSIGNAL 3"
    )
    result = run(text)
    times = {name: time for time, name, _ in result.outputs}
    assert times["1"] == pytest.approx(0.0)
    assert 0.1 < times["2"] < times["3"] - 0.1


def test_tool_waits_for_the_robot() -> None:
    result = run("SPEED 20 ALWAYS\nMOVE #PPOINT(20,-90,180,0,60,0)\nTOOL TRANS(0,0,50)\nSIGNAL 1")
    assert result.outputs[0][0] > 0.1


def test_approach_is_along_the_tool() -> None:
    text = "SET p = TRANS(400,0,200,0,180,0)\nAPPRO p, 50\nBREAK\nIF (ABS(DZ(HERE)-250) < 0.01) THEN\nSIGNAL 1\nEND"
    assert outputs(run(text)) == [("1", True)]


def test_depart_starts_from_the_destination_of_the_motion() -> None:
    text = (
        "SET p = TRANS(400,0,200,0,180,0)\nMOVE p\nDEPARTS 50\nBREAK\n"
        "IF (ABS(DZ(HERE)-250) < 0.01) AND (DISTANCE(HERE, SHIFT(p BY 0,0,50)) < 0.01) THEN\nSIGNAL 1\nEND"
    )
    assert outputs(run(text)) == [("1", True)]


def test_the_hand_acts_with_the_next_move_or_at_once() -> None:
    text = "READY\nBREAK\nOPEN\nMOVE #PPOINT(20,-90,180,0,60,0)\nCLOSEI\nSIGNAL 1"
    assert outputs(run(text)) == [("3001", True), ("3001", False), ("3002", True), ("1", True)]


def test_speed_without_always_holds_for_one_move() -> None:
    there, back = "MOVE #PPOINT(40,-90,180,0,60,0)\nBREAK", "MOVE #PPOINT(0,-90,180,0,60,0)\nBREAK"
    result = run(f"{back}\nSIGNAL 1\nSPEED 10\n{there}\nSIGNAL 2\n{back}\nSIGNAL 3")
    first, second, third = (time for time, _, _ in result.outputs)
    assert second - first > 3 * (third - second)


def test_continuous_path_is_switched_off_for_one_move() -> None:
    moves = "MOVES TRANS(400,{y},300,0,180,0)"
    text = "SPEED 300 MMPS ALWAYS\nMOVE TRANS(400,-100,300,0,180,0)\nBREAK\n{off}" + "\n".join(
        (moves.format(y=0), "MOVES TRANS(450,0,300,0,180,0)", "BREAK")
    )
    blended, stopped = (run(text.format(off=off)).time_s for off in ("", "CPOFF\n"))
    assert stopped > blended + 0.01


def test_reactions_come_on_the_edge_and_leave_with_ignore() -> None:
    cell = inputs((1.0, 1001, True), (2.0, 1001, False), (3.0, 1001, True))
    more = ".PROGRAM seen()\nn = n+1\n.END"
    text = "n = 0\nREACT 1001, seen\nWAIT.EVENT , 2.5\nIGNORE 1001\nWAIT.EVENT , 2.5\nIF n == 1 THEN\nSIGNAL 1\nEND"
    assert outputs(run(text, more, cell=cell)) == [("1", True)]


def test_lock_holds_reactions_back() -> None:
    cell = inputs((1.0, 1001, True))
    more = ".PROGRAM seen()\nSIGNAL 2\n.END"
    text = "REACT 1001, seen, 10\nLOCK 20\nWAIT.EVENT , 2\nSIGNAL 1\nLOCK 0\nWAIT.EVENT , 1\nSIGNAL 3"
    assert [name for name, _ in outputs(run(text, more, cell=cell))] == ["1", "2", "3"]


def test_reacte_catches_an_error_and_goes_on_behind_it() -> None:
    more = ".PROGRAM trouble()\nSIGNAL 2\nRETURNE\n.END"
    text = "REACTE trouble\nMOVE TRANS(5000,0,0)\nBREAK\nSIGNAL 1"
    assert ("1", True) in outputs(run(text, more)) and ("2", True) in outputs(run(text, more))


def test_two_tasks_share_global_variables() -> None:
    more = ".PROGRAM other()\nWAIT asked\nanswer = 5\n.END"
    text = "answer = 0\nasked = FALSE\nEXECUTE 3 other()\nasked = TRUE\nWAIT answer == 5\nSIGNAL 1"
    assert outputs(run(text, more)) == [("1", True)]


@pytest.mark.parametrize(("word", "joint"), [("LEFTY", -1.0), ("RIGHTY", 1.0)])
def test_handedness_of_a_scara(word: str, joint: float) -> None:
    text = f"{word}\nMOVE TRANS(400,100,200,0,180,0)\nBREAK\nAUTO c[4]\nHERE #h\nDECOMPOSE c[1] = #h\n"
    text += f"IF c[2]*{joint:g} > 1 THEN\nSIGNAL 1\nEND\nMOVE TRANS(400,-100,200,0,180,0)\nBREAK\nHERE #h\n"
    text += f"DECOMPOSE c[1] = #h\nIF c[2]*{joint:g} > 1 THEN\nSIGNAL 2\nEND"
    assert outputs(run(text, robot="adept_cobra_s600")) == [("1", True), ("2", True)]


def test_an_array_is_refused_beyond_its_foreseen_size() -> None:
    result = run("n = 300\na[1] = 1\nFOR m = 1 TO n\na[m] = m\nEND\nSIGNAL 1")
    assert result.status == "finished"
    program, _ = read(program_of("PROMPT n\na[n] = 1"))
    assert link(program) is not None
    beyond = run_program(program, load_robot("adept_viper_s650"), parse_cell("answers = [300]\n"), "test")
    assert beyond.status == "fault"


def test_an_undefined_variable_is_a_fault() -> None:
    assert run("n = m+1").status == "fault"


def test_a_reaction_belongs_to_the_task_and_can_switch_itself_on_again() -> None:
    cell = inputs((1.0, 1001, True), (1.5, 1001, False), (2.0, 1001, True))
    more = ".PROGRAM begin()\nREACT 1001, seen\n.END\n.PROGRAM seen()\nn = n+1\nREACT 1001, seen\n.END"
    text = "n = 0\nCALL begin()\nWAIT.EVENT , 3\nIF n == 2 THEN\nSIGNAL 1\nEND"
    assert outputs(run(text, more, cell=cell)) == [("1", True)]


@pytest.mark.parametrize(
    ("parameter", "seconds"),
    # M: HAND.TIME is what OPENI and CLOSEI wait; 0.05 s stands in where a project does not set it.
    [("", 0.05), ("PARAMETER HAND.TIME = 0.2\n", 0.2), ("PARAMETER HAND.TIME = .5\n", 0.5)],
)
def test_the_hand_takes_its_time(parameter: str, seconds: float) -> None:
    result = run(f"{parameter}CLOSEI\nSIGNAL 1")
    assert result.status == "finished" and result.outputs[-1][0] == pytest.approx(seconds)


def test_a_hand_whose_time_changes_is_not_guessed() -> None:
    result = run("PARAMETER HAND.TIME = 0.2\nCLOSEI\nPARAMETER HAND.TIME = 0.4\nOPENI\nSIGNAL 1")
    assert result.fault is not None and result.fault.code == "vendor"


def test_base_is_written_as_it_was_read() -> None:
    steps = ["BASE 0, 0, 40, 0", "BASE 10, 20, 30, 90", "BASE x, 5, 0, 0", "BASE", "BASE board", "SET board = BASE"]
    source = read_sources([source_from_text("p.v2", program_of("\n".join(steps)))], "vplus", Diagnostics())
    text = translate_program(source, "vplus", "adept_viper_s650", None, Diagnostics()).files[0].data.decode()
    assert [line.strip() for line in text.splitlines()][1:7] == steps
