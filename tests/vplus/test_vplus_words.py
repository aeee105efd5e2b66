"""Words of V+ one by one: each row sets `ok` when what the manual says of the word holds."""

from __future__ import annotations

import pytest
from vplus_helpers import outputs, program_of, read, reported, run

SIDE = ".PROGRAM side()\n{}\n.END\n"
ROUND = SIDE.format("n = n+1\nWAIT.EVENT , 0.05")
EVENTS = SIDE.format("CLEAR.EVENT\nn = 1\nWAIT.EVENT 1\nn = 2")
ROWS: list[tuple[str, str]] = [
    ('$s = "ABCDEF"\nok = ($MID($s,4) == "DEF") AND ($MID($s,,2) == "AB")', ""),  # M: no count gives the rest
    ('$s = "ab"+$CHR(0)+"cd"\nok = ($TRUNCATE($s) == "ab") AND ($TRUNCATE("xyz") == "xyz")', ""),
    ('$s = "abcdef"\nPACK $s, 2, 3 = "XYZ"\nok = $s == "aXYZef"', ""),
    ('$s = "abcdef"\nn = 2\nPACK $s, n, n = "QRS"\nok = $s == "aQRdef"', ""),
    ('$a[1] = "abcdef"\nPACK $a[1], 3, 2 = "--"\nok = ($a[1] == "ab--ef") AND ($UNPACK($a[1],2,3) == "b--")', ""),
    ('$s = "abc"\nok = (STRDIF($s,"abd") == -1) AND (STRDIF("abd",$s) == 1) AND (STRDIF($s,$s) == 0)', ""),
    ('$s = "b"\nIF STRDIF($s,"apple") > 0 THEN\nok = TRUE\nEND', ""),
    ('$s = "ab,cd"\n$w = $DECODE($s,",",-1)\n$d = $DECODE($s,",",2)\nok = ($w+$d+$s == "ab,cd")', ""),
    ('$s = "ab,cd"\nFOR m = 0 TO 1\n$w = $DECODE($s,",",m)\n$r = $r+$w\nEND\nok = ($r == "ab,") AND ($s == "cd")', ""),
    ('$s = "ab,cd"\n$s = $DECODE($s,",",0)\nok = $s == "ab"', ""),
    ('$s = $ENCODE("a",/C1)\nok = (LEN($s) == 3) AND (ASC($s,2) == 13)', ""),  # M: both signs of a line end
    ('$s = "abc"\nENABLE UPPER\nok = ($s == "ABC") AND ("Abc" >= $s)', ""),
    ('$s = "abc"\nDISABLE UPPER\nok = NOT ($s == "ABC")', ""),
    ("x = 3\nok = MAX(x) == 3", ""),
    ("v[0] = 1\nv[4] = 2\nok = LAST(v[]) == 4\nFOR i = 0 TO LAST(v[])\nn = i\nEND\nok = ok AND (n == 4)", ""),
    ("lock.flag = FALSE\nt = TAS(lock.flag,TRUE)\nok = (t == 0) AND lock.flag", ""),
    ("lock.flag = FALSE\nWHILE TAS(lock.flag,TRUE) DO\nWAIT\nEND\nok = lock.flag", ""),
    ("lock.flag = FALSE\nWAIT TAS(lock.flag,TRUE) == 0\nok = lock.flag", ""),
    ("ok = (TPS == 62.5) AND (TASK() == 0) AND (PRIORITY == 0) AND (PRIORITY() == 0)", ""),
    ("SELECT ROBOT = 1\nok = (SELECT(ROBOT) == 1) AND SIG.INS(24) AND SIG.INS(1001)", ""),
    ("DISABLE CP\na = SWITCH(CP)\nSWITCH CP = ON\nok = (a == OFF) AND SWITCH(CP) AND SWITCH(POWER)", ""),
    ("PARAMETER HAND.TIME = 0.1\nok = PARAMETER(HAND.TIME) == 0.1", ""),
    ("SPEED 50 ALWAYS\nACCEL 80, 70\nDURATION 2 ALWAYS\nok = (SPEED(2) == 50) AND (SPEED(1) == 100)\n"
     "ok = ok AND (ACCEL(1) == 80) AND (ACCEL(2) == 70) AND (DURATION(1) == 2)", ""),
    ("CLOSEI\nok = HAND == 0\nOPENI\nok = ok AND (HAND == 1)", ""),
    ("SET a = TRANS(1,2,3)\nok = (DZ(SHIFT(a BY ,,10)) == 13) AND (DX(SHIFT(a BY 5)) == 6)", ""),
    ("k = 1\nFOR k = 2 TO 3\nDRIVE k, -2, 100\nEND\nBREAK\nDECOMPOSE j[1] = #PHERE\n"
     "ok = (ABS(j[1]) < 0.01) AND (ABS(j[2]+92) < 0.01) AND (ABS(j[3]-178) < 0.01)", ""),
    ("BITS 2010, 4 = 10\nok = SIG(-2010,2011,-2012,2013) AND (BITS(2010,4) == 10)", ""),
    ("f = 24\nn = 3\nBITS f, n = 6\nok = (BITS(f,n) == 6) AND SIG(25)\nBITS f, n = 0", ""),
    ("n = 0\nEXECUTE 3 side(), 3\nWAIT.EVENT , 0.5\nok = n == 3", ROUND),
    ("n = 0\nEXECUTE 3 side(), -1\nWAIT.EVENT , 0.4\nABORT 3\nok = n > 4\nn = 0\nWAIT.EVENT , 0.2\nok = ok*(n-1) == 1",
     ROUND),
    ("n = 0\nEXECUTE 3 side()\nWAIT.EVENT , 0.1\nk = n\nSET.EVENT 3\nWAIT.EVENT , 0.1\nok = k*10+n == 12", EVENTS),
    ("TIMER 2 = 0\nCLEAR.EVENT\nWAIT.EVENT 1, 0.2\nok = (TIMER(2) > 0.15) AND (TIMER(2) < 0.4)", ""),
    ("CLEAR.EVENT\nok = GET.EVENT(0) == 0\nSET.EVENT 0\nok = ok AND GET.EVENT()", ""),
    ("n = 3\nTIMER n = 0\nWAIT TIMER(n) > 0.1\nok = TIMER(3) > 0.1", ""),
]  # fmt: skip


@pytest.mark.parametrize(("steps", "more"), ROWS)
def test_the_word_does_what_the_manual_says(steps: str, more: str) -> None:
    start = 'SIGNAL -1\nn = 0\n$r = ""\nok = FALSE\n'
    result = run(f"{start}{steps}\nIF ok THEN\nSIGNAL 1\nEND", more)
    assert outputs(result)[-1] == ("1", True)


@pytest.mark.parametrize(
    ("step", "told"),
    [
        ("RUNSIG 31", "vplus-run-signal"),
        ("SOLVE.ANGLES j[1], f, e = HERE, i[1], 0", ""),
        ('DOS "x = 1"', ""),
        ("SWITCH MESSAGES = OFF", ""),
    ],
)
def test_words_of_the_controller_are_read(step: str, told: str) -> None:
    assert reported(f"SET a = HERE\n{step}") == ([told] if told else [])


def test_a_task_that_switches_a_software_signal_stays_one() -> None:
    text = program_of("EXECUTE 3 side()\nWAIT SIG(2011)\nSIGNAL 1", SIDE.format("WAIT.EVENT , 0.1\nSIGNAL 2011"))
    program, _ = read(text)
    assert {routine.name for routine in program.modules[0].routines} == {"test", "side"}
