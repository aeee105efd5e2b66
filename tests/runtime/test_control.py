"""Control flow, calls, errors, interrupts: what the manuals say, in the languages themselves."""

import copy

import pytest
from helpers import krl, on, rapid, read

from rpl.errors import UsageError
from rpl.simulation import Simulation, run_program

# Each writes its result with one message; expectations from the manuals' own examples (EP, RAPID kernel reference).
KRL_MESSAGES = [
    ("FOR I=1 TO 3\nFOR J=1 TO 2\nN=N*10+I*J\nENDFOR\nENDFOR\n", "122436"),
    ("FOR I=6 TO 1 STEP -1\nENDFOR\nN=I\n", "0"),
    ("LOOP\nN=N+1\nIF N==3 THEN\nGOTO OUT\nENDIF\nENDLOOP\nOUT:\nN=N*10\n", "30"),
    ("WHILE TRUE\nN=N+1\nIF N>4 THEN\nEXIT\nENDIF\nENDWHILE\n", "5"),
    ("N=TWICE(TWICE(3))+TWICE(N)\n", "12"),
    ("N=3\nN=N+BUMP(N)\n", "13"),  # left operand before the call that changes it
    ("BYREF(A[2])\nN=A[2]\n", "7"),
    ("I=2\nMOVEIDX(I,A[I])\nN=A[2]\n", "9"),  # the index is evaluated at the call
    ("N=7 B_AND 'H5'\n", "5"),
    ("N=OPT(1,,3)\n", "13"),
    ("IF (N==1) AND (BUMP(N)==10) THEN\nENDIF\n", "10"),  # AND evaluates both sides
]
KRL_MORE = """
DEFFCT INT TWICE(X:IN)
INT X
RETURN 2*X
ENDFCT
DEFFCT INT BUMP(X:OUT)
INT X
X=10
RETURN 10
ENDFCT
DEF BYREF(X:OUT)
INT X
X=7
END
DEF MOVEIDX(K:OUT,X:OUT)
INT K,X
K=4
X=9
END
DEFFCT INT OPT(X:IN,Y:IN,Z:IN)
INT X,Y,Z
INT R
R=X*10+Z
IF VARSTATE("Y")==#INITIALIZED THEN
R=R+1000
ENDIF
RETURN R
ENDFCT
"""


@pytest.mark.parametrize(("body", "said"), KRL_MESSAGES)
def test_krl_control(body: str, said: str) -> None:
    result = krl(f'N=0\nFOR I=1 TO 5\nA[I]=0\nENDFOR\n{body}MsgNotify("%1","",N)', "DECL INT I,J,N,A[5]", KRL_MORE)
    assert (result.status, result.messages) == ("finished", (said,)), result.fault


RAPID_MESSAGES = [
    ("FOR i FROM 1 TO 3 DO n:=n*10+i; ENDFOR", "123"),
    ("FOR i FROM 3 TO 1 DO n:=n*10+i; ENDFOR", "321"),
    ("FOR i FROM 5 TO 1 STEP 1 DO n:=n*10+i; ENDFOR", "5"),
    ("n:=twice(twice(3))+1;", "13"),
    ("IF FALSE AND bump() n:=100;", "0"),
    ("IF TRUE OR bump() n:=n+1;", "1"),
    ("IF bump() AND bump() n:=n+100;", "102"),
    ("byref n; n:=n+1;", "8"),
    ("named 1 \\b:=2; named 5;", "12"),
    ('%"byref"% n;', "7"),
    ("WHILE NOT done() DO n:=n+10; ENDWHILE", "34"),
    ("TEST n CASE 1: n:=5; CASE 0,2: n:=6; DEFAULT: n:=7; ENDTEST", "6"),
    ("again: n:=n+1; IF n<4 GOTO again;", "4"),
    ("p:=[1,2,3]; q:=p; q.y:=9; n:=p.y*10+q.y;", "29"),
    ("n:=Present2(\\x:=1)*10+Present2();", "10"),
    ("n:=Round(2.5)+Trunc(-3.7);", "0"),
]
RAPID_DATA = "VAR num n:=0;\nVAR pos p;\nVAR pos q;"
RAPID_MORE = """
FUNC num twice(num x) RETURN 2*x; ENDFUNC
FUNC bool bump() n:=n+1; RETURN TRUE; ENDFUNC
FUNC bool done() n:=n+1; RETURN n>30; ENDFUNC
PROC byref(INOUT num x) x:=7; ENDPROC
PROC named(num a\\num b) IF Present(b) THEN n:=a*10+b; ENDIF ENDPROC
FUNC num Present2(\\num x) RETURN inner(\\y?x); ENDFUNC
FUNC num inner(\\num y) IF Present(y) RETURN 1; RETURN 0; ENDFUNC
"""


@pytest.mark.parametrize(("body", "said"), RAPID_MESSAGES)
def test_rapid_control(body: str, said: str) -> None:
    result = rapid(f"{body}\nTPWrite NumToStr(n,0);", RAPID_DATA, RAPID_MORE)
    assert (result.status, result.messages) == ("finished", (said,)), result.fault


RAPID_ERRORS = [
    # the failed statement again, behind it, back to the caller
    ("PROC probe() risky; n:=n+100; ERROR IF ERRNO=55 THEN ok:=TRUE; RETRY; ENDIF ENDPROC", "101"),
    ("PROC probe() risky; n:=n+100; ERROR TRYNEXT; ENDPROC", "100"),
    ("PROC probe() risky; n:=n+100; ERROR RETURN; ENDPROC", "0"),
    ("PROC probe() risky; n:=n+100; ERROR ENDPROC", "0"),
    ("PROC probe() deeper; ERROR n:=ERRNO; ENDPROC PROC deeper() risky; ERROR RAISE; ENDPROC", "55"),
    ("PROC probe() deeper; ERROR n:=ERRNO; ENDPROC PROC deeper() risky; ERROR RAISE 66; ENDPROC", "66"),
    ("PROC probe() deeper; ERROR n:=n+ERRNO; ENDPROC PROC deeper() risky; UNDO n:=1000; ENDPROC", "1055"),
    ("PROC probe() n:=1/zero; ERROR IF ERRNO=ERR_DIVZERO n:=7; ENDPROC", "7"),
    ("PROC probe() n:=list{9}; ERROR IF ERRNO=ERR_OUTOFBND n:=8; ENDPROC", "8"),
    ('PROC probe() %"nowhere"%; ERROR IF ERRNO=ERR_REFUNKPRC n:=9; TRYNEXT; ENDPROC', "9"),
    ("PROC probe() WaitDI di1,1\\MaxTime:=2; ERROR IF ERRNO=ERR_WAIT_MAXTIME n:=3; ENDPROC", "3"),
    ("PROC probe() n:=1+value(); ERROR ok:=TRUE; RETRY; ENDPROC FUNC num value() risky; RETURN 4; ENDFUNC", "5"),
]


@pytest.mark.parametrize(("routines", "said"), RAPID_ERRORS)
def test_rapid_error_handlers(routines: str, said: str) -> None:
    more = f"{routines} PROC risky() IF NOT ok RAISE 55; n:=n+1; ENDPROC"
    data = "VAR num n:=0;\nVAR bool ok:=FALSE;\nVAR num zero:=0;\nVAR num list{2}:=[1,2];"
    result = rapid("probe;\nTPWrite NumToStr(n,0);", data, more)
    assert (result.status, result.messages) == ("finished", (said,)), result.fault


def test_an_error_that_nobody_handles_is_a_fault_with_its_line() -> None:
    result = rapid("n:=1;\nn:=1/zero;", "VAR num n:=0;\nVAR num zero:=0;")
    assert result.status == "fault" and result.fault is not None
    assert (result.fault.code, result.fault.origin.line) == ("division-by-zero", 6)
    assert result.as_json()["fault"]["line"] == 6


def test_reading_what_has_no_value_is_a_fault_in_krl() -> None:
    result = krl("N=M+1", "DECL INT N,M")
    assert result.fault is not None and result.fault.code == "no-value" and "M has no value" in result.fault.message


def test_krl_interrupt_runs_on_the_edge_and_the_wait_goes_on() -> None:
    result = krl(
        'INTERRUPT DECL 10 WHEN $IN[1] DO HIT( )\nINTERRUPT ON 10\nWAIT SEC 2\nMsgNotify("end")',
        more='DEF HIT( )\nMsgNotify("hit")\nWAIT SEC 3\nEND',
        cell="[[input]]\ntime=1\nsignal='$IN[1]'\nvalue=true\n",
    )
    assert result.messages == ("hit", "end")
    assert result.time_s == pytest.approx(4.0)


def test_a_disabled_interrupt_is_remembered_once() -> None:
    body = (
        "INTERRUPT DECL 10 WHEN $IN[1] DO HIT( )\nINTERRUPT ON 10\nINTERRUPT DISABLE 10\nWAIT SEC 3\n"
        'MsgNotify("now")\nINTERRUPT ENABLE 10\nWAIT SEC 1\nMsgNotify("end")'
    )
    inputs = "".join(f"[[input]]\ntime={t}\nsignal='$IN[1]'\nvalue=true\nduration=0.5\n" for t in (1, 2))
    result = krl(body, more='DEF HIT( )\nMsgNotify("hit")\nEND', cell=inputs)
    assert result.messages == ("now", "hit", "end")


def test_a_more_urgent_interrupt_interrupts_a_less_urgent_one() -> None:
    body = (
        "INTERRUPT DECL 20 WHEN $IN[1] DO LOW( )\nINTERRUPT DECL 10 WHEN $IN[2] DO HIGH( )\nINTERRUPT ON\nWAIT SEC 10"
    )
    routines = (
        'DEF LOW( )\nMsgNotify("low")\nWAIT SEC 2\nMsgNotify("low end")\nEND\n'
        'DEF HIGH( )\nMsgNotify("high")\nWAIT SEC 2\nMsgNotify("high end")\nEND'
    )

    def inputs(first: int, second: int) -> str:
        return "".join(f"[[input]]\ntime={t}\nsignal='$IN[{n}]'\nvalue=true\n" for n, t in ((1, first), (2, second)))

    assert krl(body, more=routines, cell=inputs(1, 2)).messages == ("low", "high", "high end", "low end")
    assert krl(body, more=routines, cell=inputs(2, 1)).messages == ("high", "high end", "low", "low end")


def test_rapid_traps_timers_and_single_orders() -> None:
    data = "VAR intnum i;\nVAR num n:=0;"
    trap = "TRAP hit n:=n+1; TPWrite NumToStr(n,0); ENDTRAP"
    inputs = "".join(f"[[input]]\ntime={t}\nsignal='di1'\nvalue=true\nduration=0.1\n" for t in (1, 2, 3))
    every = "CONNECT i WITH hit;\nISignalDI di1,1,i;\nWaitTime 1.5;\nISleep i;\nWaitTime 1;\nIWatch i;\nWaitTime 5;"
    assert rapid(every, data, trap, cell=inputs).messages == ("1", "2")
    once = "CONNECT i WITH hit;\nISignalDI\\Single,di1,1,i;\nWaitTime 5;"
    assert rapid(once, data, trap, cell=inputs).messages == ("1",)
    timer = "CONNECT i WITH hit;\nITimer 0.5,i;\nWaitTime 1.8;\nIDelete i;\nWaitTime 5;"
    assert rapid(timer, data, trap).messages == ("1", "2", "3")


def test_waiting_for_what_never_comes_is_a_deadlock_that_names_it() -> None:
    result = krl("WAIT FOR $IN[4]")
    assert result.status == "deadlock" and result.fault is not None
    assert "$IN[4]" in result.fault.message and result.fault.origin.line == 3


def test_a_dialog_without_an_answer_names_itself_and_with_one_goes_on() -> None:
    body = 'MsgDialog(N,"Which part?","",,,,"left","right")\nMsgNotify("%1","",N)'
    result = krl(body, "DECL INT N")
    assert result.status == "deadlock" and result.fault is not None and "Which part?" in result.fault.message
    for answer in ("2", '"right"'):
        answered = krl(body, "DECL INT N", cell=f"answers=[{answer}]")
        assert answered.messages[-1] == "2"


def test_a_loop_that_takes_no_time_is_caught() -> None:
    result = krl("WHILE TRUE\nN=N+1\nENDWHILE", "DECL INT N\nN=0")
    assert result.status == "fault" and result.fault is not None and result.fault.code == "no-time"
    assert result.fault.origin.line in (4, 5)


def test_a_loop_that_polls_lets_time_pass() -> None:
    result = krl("WHILE NOT $IN[1]\nENDWHILE\n$OUT[1]=TRUE", cell="[[input]]\ntime=5\nsignal='$IN[1]'\nvalue=true\n")
    assert result.status == "finished" and result.outputs[0][0] == pytest.approx(5.0, abs=0.11)
    timed = krl("$TIMER[1]=-2000\n$TIMER_STOP[1]=FALSE\nREPEAT\nUNTIL $TIMER[1]>0\n$OUT[1]=TRUE")
    assert timed.outputs[0][0] == pytest.approx(2.0, abs=0.05)


def test_polling_a_signal_that_nothing_changes_is_a_deadlock() -> None:
    assert krl("WHILE NOT $IN[1]\nENDWHILE").status == "deadlock"


def test_pulses_and_delayed_outputs_come_at_their_times() -> None:
    result = krl("PULSE($OUT[1],TRUE,0.5)\nWAIT SEC 2\n$OUT[2]=TRUE")
    assert [(round(t, 3), name, value) for t, name, value in result.outputs] == [
        (0.0, "$OUT[1]", True),
        (0.5, "$OUT[1]", False),
        (2.0, "$OUT[2]", True),
    ]


def test_an_alias_its_number_and_a_group_are_one_signal() -> None:
    result = krl(
        "GRIP=TRUE\n$OUT[3]=TRUE\nNUM=5\n$OUT[9]=$OUT[1]", "SIGNAL GRIP $OUT[3]\nSIGNAL NUM $OUT[1] TO $OUT[4]"
    )
    assert [(name, value) for _, name, value in result.outputs] == [
        ("$OUT[3]", True),
        ("$OUT[1]", True),
        ("$OUT[9]", True),
    ]


def test_reactions_of_the_cell() -> None:
    cell = "[[reaction]]\nwhen='$OUT[1]'\nafter=0.3\nsignal='$IN[2]'\nvalue=true\n"
    result = krl("$OUT[1]=TRUE\nWAIT FOR $IN[2]\n$OUT[2]=TRUE", cell=cell)
    assert result.outputs[-1][:2] == (pytest.approx(0.3), "$OUT[2]")


def test_each_bit_of_a_group_has_its_own_reaction() -> None:
    rows = [(n, level) for n in range(1, 5) for level in ("true", "false")]
    cell = "".join(
        f"[[reaction]]\nwhen='$OUT[{n}]'\nbecomes={level}\nafter=0.1\nsignal='$IN[{n}]'\nvalue={level}\n"
        for n, level in rows
    )
    data = "SIGNAL NR $OUT[1] TO $OUT[4]\nSIGNAL ECHO $IN[1] TO $IN[4]\nDECL INT I\n"
    body = "FOR I=0 TO 15\nNR=I\nWAIT SEC 0.2\n$OUT[10+I]=(ECHO==I)\nENDFOR"
    assert {name for name, value in on(krl(body, data=data, cell=cell)).items() if value} >= {
        f"$OUT[{10 + value}]" for value in range(16)
    }


def test_a_group_has_its_own_reaction() -> None:
    cell = "[[reaction]]\nwhen='NR'\nbecomes=11\nafter=0.1\nsignal='ECHO'\nvalue=7\n"
    data = "SIGNAL NR $OUT[1] TO $OUT[4]\nSIGNAL ECHO $IN[1] TO $IN[4]\n"
    for body in ("NR=11", "$OUT[1]=TRUE\n$OUT[2]=TRUE\n$OUT[4]=TRUE", "NR=3\nWAIT SEC 0.5\n$OUT[4]=TRUE"):
        result = krl(f"{body}\nWAIT SEC 0.3\n$OUT[9]=(ECHO==7)", data=data, cell=cell)
        assert on(result)["$OUT[9]"]


def test_two_runs_are_equal_and_a_copy_goes_on_by_itself() -> None:
    text = "DEF P0( )\nDECL INT I\nFOR I=1 TO 5\n$OUT[I]=TRUE\nWAIT SEC 1\nENDFOR\nEND"
    program = read("krl", text)
    first, second = run_program(program), run_program(program)
    assert list(first.trace_lines()) == list(second.trace_lines())
    simulation = Simulation(program)
    simulation.run_until(2.5)
    twin = copy.deepcopy(simulation)
    assert simulation.variable("I") == 3
    simulation.run()
    assert twin.now == 2.5 and twin.variable("I") == 3 and len(twin.outputs) == 3
    twin.run()
    assert list(twin.result().trace_lines()) == list(first.trace_lines())


def test_breakpoints_and_steps() -> None:
    program = read("krl", "DEF P0( )\nDECL INT I\nFOR I=1 TO 3\n$OUT[I]=TRUE\nENDFOR\nWAIT SEC 1\nEND")
    simulation = Simulation(program)
    simulation.breakpoints.add(("p0.src", 4))
    seen = []
    while True:
        simulation.run()
        if simulation.status:
            break
        seen.append((simulation.where()[1], simulation.variable("I")))
    assert seen == [(4, 1), (4, 2), (4, 3)]
    stepper = Simulation(program)
    lines = []
    while stepper.step():
        lines.append(stepper.where()[1])
    assert lines == [3, 4, 4, 4, 6] and stepper.status == "finished"


@pytest.mark.parametrize(
    ("text", "entry", "found"),
    [
        ('MODULE a PROC other() ENDPROC PROC main() TPWrite "main"; ENDPROC ENDMODULE', None, "main"),
        ('MODULE a PROC x() y; ENDPROC PROC y() TPWrite "y"; ENDPROC ENDMODULE', None, "y"),
        ('MODULE a PROC x() TPWrite "x"; ENDPROC PROC y() TPWrite "y"; ENDPROC ENDMODULE', "Y", "y"),
    ],
)
def test_the_entry(text: str, entry: str | None, found: str) -> None:
    assert run_program(read("rapid", text), entry=entry).messages == (found,)


def test_a_file_whose_own_routine_does_nothing_is_a_library() -> None:
    library = 'DEF P0( )\nEND\nGLOBAL DEF HELP( )\nMsgNotify("help")\nEND'
    assert run_program(read("krl", library, "DEF P1( )\nHELP( )\nEND")).messages == ("help",)


def test_an_entry_that_cannot_be_told_lists_the_candidates() -> None:
    program = read("rapid", "MODULE a PROC x() Stop; ENDPROC PROC y() Stop; ENDPROC ENDMODULE")
    with pytest.raises(UsageError, match="x, y"):
        run_program(program)


def test_vendor_statements_stop_a_run_unless_the_cell_explains_them() -> None:
    body = "GRP_OPEN(1)\n$OUT[1]=TRUE"
    result = krl(body)
    assert result.status == "fault" and result.fault is not None and "GRP_OPEN" in result.fault.message
    explained = krl(body, cell="[[vendor]]\nmatch='GRP_OPEN'\neffect='time'\nseconds=0.7\n")
    assert on(explained) == {"$OUT[1]": True} and explained.time_s == pytest.approx(0.7)
