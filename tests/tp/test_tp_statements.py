"""TP statements by what they mean: each line of a listing beside the same in RPL."""

import pytest
from tp_reading_helpers import body, listing, read, reports

from rpl.diagnostics import Severity

CASES = [
    # registers and signals
    ("R[1:count]=R[1:count]+1", "R1 = R1 + 1"),
    ("R[1]=(-5)", "R1 = (-5)"),
    ("R[1]=.5", "R1 = 0.5"),
    ("R[1]=R[2] DIV 3", "R1 = R2 DIV 3"),
    ("R[1]=R[2] MOD 3", "R1 = R2 MOD 3"),
    ("R[1]=((R[2]+R[3])*2)", "R1 = (R2 + R3) * 2"),
    ("R[1]=(R[2]-R[3]*4)", "R1 = R2 - R3 * 4"),
    ("R[1]=DI[2]", "R1 = to_bit(di[2])"),
    ("R[1]=GI[2]", "R1 = gi[2]"),
    ("R[1]=AI[2]", "R1 = ai[2]"),
    ("R[1]=TIMER[2]", "R1 = $timer[2]"),
    ("R[1]=SIN[30]", "R1 = sin(30)"),
    ("R[1]=ATAN2[R[2],R[3]]", "R1 = atan2(R2, R3)"),
    ("R[1]=STRLEN SR[1]", "R1 = text_length(SR1)"),
    ("R[1]=FINDSTR SR[1],SR[2]", "R1 = text_find(text_upper(SR1), 1, text_upper(SR2))"),
    ("SR[1]=SUBSTR SR[2],2,3", "SR1 = text_part(SR2, 2, 3)"),
    ("SR[1]='text'", 'SR1 = "text"'),
    ("SR[1]=SR[2]+SR[3]", "SR1 = SR2 & SR3"),
    ("SR[1]=R[2]", "SR1 = value_text(R2)"),
    ("R[1]=SR[2]", "R1 = text_value(SR2)"),
    ("R[1]=$MCR.$GENOVERRIDE", "R1 = $override"),
    ("R[1]=$SOME.$THING", 'R1 = VENDOR(tp, "$SOME.$THING", REAL)'),
    ("R[1]=$[PROG]COUNT", 'R1 = VENDOR(tp, "$[PROG]COUNT", REAL)'),
    ("R[1]=R[2]DIV5", "R1 = R2 DIV 5"),
    ("R[1]=Constant", 'R1 = VENDOR(tp, "Constant", REAL)'),
    ("DO[1:lamp]=ON", "SET do[1] TO ON"),
    ("DO[1]=(DI[1] AND !DI[2] OR DI[3])", "SET do[1] TO (di[1] AND NOT di[2]) OR di[3]"),
    ("DO[R[1]]=OFF", "SET do[to_int(R1)] TO OFF"),
    ("DO[1]=R[2]", "SET do[1] TO to_bool(R2)"),
    ("DO[1]=PULSE,0.5sec", "PULSE do[1] TO ON FOR 0.5"),
    ("DO[1]=PULSE", "PULSE do[1] TO ON FOR 0.4"),  # M: the default width
    ("RO[1]=ON", "SET do(RO1) TO ON"),
    ("SO[2]=OFF", "SET do(SO2) TO OFF"),
    ("GO[1]=R[1]+1", "SET go[1] TO to_int(R1 + 1)"),
    ("AO[1]=2.5", "SET ao[1] TO 2.5"),
    ("F[1]=(ON)", "SET flag[1] TO ON"),
    ("M[1]=(F[1])", "SET flag(M1) TO flag[1]"),
    # position registers
    ("PR[1]=LPOS", "PR1 = current_target()"),
    ("PR[1]=JPOS", "PR1 = current_joints()"),
    ("PR[1]=P[2]", "PR1 = P2"),
    ("PR[1,1]=5", "PR1.x = 5"),
    ("PR[1,4]=5", "PR1.c = 5"),
    ("PR[1,6]=5", "PR1.a = 5"),
    ("PR[1,7:rail]=5", "PR1.e1 = 5"),
    ("R[1]=PR[1,3]", "R1 = PR1.z"),
    ("PR[1]=PR[2]+PR[3]-PR[4]", "PR1 = element_difference(element_sum(PR2, PR3), PR4)"),
    ("PR[GP1:1]=LPOS", "PR1 = current_target()"),
    # waiting
    ("WAIT    .50(sec)", "WAIT 0.5"),
    ("WAIT R[1]", "WAIT R1"),
    ("WAIT DI[1]=ON", "WAIT UNTIL di[1]"),
    ("WAIT DI[1]=OFF AND R[1]>=3", "WAIT UNTIL NOT di[1] AND R1 >= 3"),
    ("WAIT (DI[1] AND !DI[2])", "WAIT UNTIL di[1] AND NOT di[2]"),
    # settings
    ("OVERRIDE=50%", "$override = 50"),
    ("TIMER[1]=RESET", "$timer[1] = 0"),
    ("TIMER[1]=START", "$timer_stopped[1] = FALSE"),
    ("TIMER[1]=STOP", "$timer_stopped[1] = TRUE"),
    ("TIMER[1]=(-5)", "$timer[1] = (-5)"),
    ("MESSAGE[hello; you]", 'MESSAGE "hello; you"'),
    ("PAYLOAD[1:light]", 'VENDOR tp "PAYLOAD[1:light]" EFFECT tuning'),
    ("LOCK PREG", 'VENDOR tp "LOCK PREG" EFFECT tuning'),
    ("COL DETECT ON", 'VENDOR tp "COL DETECT ON" EFFECT tuning'),
    ("VISION RUN_FIND 'X'", "VENDOR tp \"VISION RUN_FIND 'X'\" EFFECT unknown"),
    ("PAUSE", "HALT"),
    ("ABORT", "HALT EXIT"),
    ("END", "RETURN"),
    ("CALL SR[1]", "CALL BY SR1"),
    ("RUN MAIN", "START TASK MAIN"),
]


@pytest.mark.parametrize(("line", "meaning"), CASES, ids=[case[0] for case in CASES])
def test_a_statement_means(line: str, meaning: str) -> None:
    assert body(line) == [meaning]


SEVERAL = [
    ("UALM[3]", ['MESSAGE "UALM[3]" KIND error', "HALT"]),
    ("UFRAME_NUM=2", ["UFRAME_NUM = 2", "$base = UFRAME[2]"]),
    ("UTOOL_NUM=R[1]", ["UTOOL_NUM = to_int(R1)", "$tool = UTOOL[UTOOL_NUM]"]),
    (
        "UFRAME[1]=PR[1]",
        ["UFRAME[1] = pose_of(PR1)", "IF UFRAME_NUM = 1 THEN", "$base = UFRAME[1]", "END IF"],
    ),
    ("WAIT DI[1]=ON+", ["WAIT UNTIL NOT di[1]", "WAIT UNTIL di[1]"]),
    ("WAIT DI[1]=OFF-", ["WAIT UNTIL di[1]", "WAIT UNTIL NOT di[1]"]),
    (
        "LBL[1]\nWAIT DI[1]=ON TIMEOUT,LBL[1]",
        [
            "LABEL LBL1",
            "WAIT UNTIL di[1] TIMEOUT `$WAITTMOUT` / 100.0 FLAG wait_timed_out",
            "IF wait_timed_out THEN",
            "GOTO LBL1",
            "END IF",
        ],
    ),
    ("LBL[1]\nIF R[1]=1 AND DI[2]=ON,JMP LBL[1]", ["LABEL LBL1", "IF R1 = 1 AND di[2] THEN", "GOTO LBL1", "END IF"]),
    ("IF (!DI[1]),DO[1]=(ON)", ["IF NOT di[1] THEN", "SET do[1] TO ON", "END IF"]),
    ("IF DI[1]=ON,WAIT .5(sec)", ["IF di[1] THEN", "WAIT 0.5", "END IF"]),
    (
        "IF (R[1]=1) THEN\nDO[1]=ON\nELSE\nDO[2]=ON\nENDIF",
        ["IF R1 = 1 THEN", "SET do[1] TO ON", "ELSE", "SET do[2] TO ON", "END IF"],
    ),
    ("FOR R[1]=1 TO 3\nENDFOR", ["FOR R1 = 1 TO 3 KEEPS LAST", "END FOR"]),
    ("FOR R[1]=R[2] DOWNTO 1\nENDFOR", ["FOR R1 = R2 TO 1 STEP (-1) KEEPS LAST", "END FOR"]),
    (
        "LBL[1]\nSELECT R[1]=1,JMP LBL[1]\n=2,CALL MAIN\nELSE,JMP LBL[1]",
        [
            *("LABEL LBL1", "SWITCH R1", "CASE 1", "GOTO LBL1", "CASE 2", "MAIN()"),
            *("DEFAULT", "GOTO LBL1", "END SWITCH"),
        ],
    ),
    (
        "LBL[3]\nLBL[7]\nJMP LBL[R[1]]",
        [
            *("LABEL LBL3", "LABEL LBL7", "SWITCH to_int(R1)", "CASE 3", "GOTO LBL3", "CASE 7", "GOTO LBL7"),
            *("DEFAULT", 'MESSAGE "there is no such place: JMP LBL[R[1]]" KIND error', "HALT", "END SWITCH"),
        ],
    ),
]


@pytest.mark.parametrize(("lines", "meaning"), SEVERAL, ids=[case[0].splitlines()[-1] for case in SEVERAL])
def test_statements_mean(lines: str, meaning: list[str]) -> None:
    found = body(lines)
    assert [line.replace(" KEEPS LAST", "") for line in found] == [line.replace(" KEEPS LAST", "") for line in meaning]


def test_a_loop_keeps_its_last_value() -> None:
    from rpl import ir

    program, _ = read(listing("FOR R[1]=1 TO 3\nENDFOR"))
    loop = program.modules[1].routines[0].body[0]
    assert isinstance(loop, ir.For) and loop.keeps_last


def test_indexed_registers_are_an_array() -> None:
    assert body("R[R[2]]=R[1]+1") == ["R[to_int(R[2])] = R[1] + 1"]


LIVE = [
    ("FOR R[1]=1 TO R[2]\nR[R[1]]=0\nENDFOR", "R[1]", "R[2]", "R[to_int(R[1])] = 0"),
    ("FOR R[1]=1 TO R[2]\nR[2]=R[2]-1\nENDFOR", "R1", "R2", "R2 = R2 - 1"),
]


@pytest.mark.parametrize(("lines", "counter", "bound", "inside"), LIVE, ids=["indexed bank", "bound changes"])
def test_a_loop_that_reads_its_bound_again_is_counted_by_hand(
    lines: str, counter: str, bound: str, inside: str
) -> None:
    assert body(lines) == [
        *(f"{counter} = 1", f"WHILE {counter} <= {bound}", inside, f"IF {counter} >= {bound} THEN", "EXIT", "END IF"),
        *(f"{counter} = {counter} + 1", "END WHILE"),
    ]


def test_a_select_may_hold_remarks_behind_it() -> None:
    assert body("SELECT R[1]=1,CALL MAIN\n=2,CALL MAIN\n!done")[-2:] == ["END SWITCH", "-- done"]


def test_remarks_and_disabled_lines_are_comments() -> None:
    assert body("!one; two\n//DO[1]=ON\n--eg:long\nR[1]=1") == [
        *("-- one; two", "-- //DO[1]=ON", "-- eg:long", "R1 = 1"),
    ]


def test_comments_in_brackets_may_hold_brackets() -> None:
    assert body("R[42:X-PR[2] ]=PR[2,1:x]") == ["R42 = PR2.x"]


def test_comments_become_labels_of_the_registers() -> None:
    program, _ = read(listing("R[1:count]=0\nPR[2:pick]=LPOS"))
    labels = {variable.name: variable.label for variable in program.modules[0].declarations}  # type: ignore[union-attr]
    assert labels == {"R1": "count", "PR2": "pick"}


WRONG = [
    ("R[1]=", "ends too early"),
    ("R[1]=2 2", "did not expect"),
    ("R[1]=PR[2]", "a position stands where a number is needed"),
    ("PR[1,12]=5", "no element 12"),
    ("L P[2] 50% FINE", "only J takes a speed in percent"),
    ("J P[1] 100mm/sec FINE", "J takes a speed in percent or a time"),
    ("L P[2] FINE", "no speed"),
    ("C P[2] 100mm/sec FINE", "C needs two positions"),
    ("DO[1]=PULSE,0.5mm", "the unit here is sec"),
    ("OVERRIDE=50mm", "the unit here is %"),
    ("IF (PR[1]),JMP LBL[1]", "a condition is needed"),
]


@pytest.mark.parametrize(("line", "reason"), WRONG, ids=[case[0] for case in WRONG])
def test_damage_costs_one_statement(line: str, reason: str) -> None:
    program, diagnostics = read(listing(f"DO[1]=ON\n{line}\nDO[2]=ON"))
    (report,) = diagnostics.of(Severity.ERROR)
    assert reason in report.message
    assert report.origin.line == 6
    assert len(program.modules[-1].routines[0].body) == 3


def test_a_missing_label_is_reported() -> None:
    _, diagnostics = read(listing("JMP LBL[7]"))
    assert reports(diagnostics) == ["tp-missing-label"]


def test_a_missing_block_end_is_reported() -> None:
    _, diagnostics = read(listing("IF (R[1]=1) THEN\nDO[1]=ON"))
    assert reports(diagnostics, Severity.ERROR) == ["missing-block-end"]


def test_an_unknown_instruction_is_vendor_and_noted() -> None:
    _, diagnostics = read(listing("Arc Start[1]"))
    assert reports(diagnostics, Severity.INFO) == ["tp-instruction"]


def test_a_macro_instruction_calls_its_program() -> None:
    macro = listing("DO[1]=ON", "", "TOPEN", "Macro").replace('"test"', '"Open tool"')
    assert body("Open tool", macro) == ["TOPEN()"]
    waits = macro.replace("TOPEN", "WAITNEXT").replace("Open tool", "WAIT NEXT PART")
    assert body("WAIT NEXT PART", waits) == ["WAITNEXT()"]
    assert body("Open hand 1", listing("DO[1]=ON", "", "HOPN1", "Macro")) == ["HOPN1()"]  # M: the standard macros
