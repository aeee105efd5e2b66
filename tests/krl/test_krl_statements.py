"""KRL statements: what each becomes in the IR, in the spellings that real programs use."""

from __future__ import annotations

import pytest
from krl_helpers import body, read, shown, statement

from rpl import ir
from rpl.diagnostics import Severity

_MODAL_DISTANCE = ir.BlendDistance(ir.System("blend_distance"))
_MODAL_JOINT = ir.BlendPercent(ir.System("blend_joint"))

MOVES = [
    ("PTP XP1", {"kind": "joint", "blend": ir.BlendStop(), "motion_class": "classic"}),
    ("LIN P C_DIS", {"kind": "linear", "blend": _MODAL_DISTANCE}),
    ("LIN P C_VEL", {"blend": ir.BlendSpeed(ir.System("blend_speed"))}),
    ("LIN P C_ORI", {"blend": ir.BlendDistance(None, ir.System("blend_rotation"))}),
    ("PTP P C_PTP", {"blend": _MODAL_JOINT}),
    ("PTP P C_PTP C_DIS", {"blend": ir.BlendPercent(ir.System("blend_joint"), _MODAL_DISTANCE)}),
    ("PTP {A3 45}", {"kind": "joint", "relative": None}),
    ("PTP_REL {A3 45}", {"kind": "joint", "relative": "joints"}),
    ("PTP_REL {X 10}", {"relative": "base"}),
    ("Lin_rel {y 900}", {"kind": "linear", "relative": "base"}),
    ("LIN_REL{Z  100} #BASE", {"relative": "base"}),
    ("LIN_REL {Z -5} C_DIS #TOOL", {"relative": "tool", "blend": _MODAL_DISTANCE}),
    ("circ cirp2,cirp3,CA 365", {"kind": "circular", "swept": ir.IntLiteral(365)}),
    ("SLIN P", {"kind": "linear", "motion_class": "spline"}),
    ("SCIRC A,B", {"kind": "circular", "motion_class": "spline"}),
    ("SPTP P C_SPL", {"kind": "joint", "motion_class": "spline", "blend": _MODAL_DISTANCE}),
]


@pytest.mark.parametrize(("text", "wanted"), MOVES)
def test_moves(text: str, wanted: dict[str, object]) -> None:
    move = statement(text)
    assert isinstance(move, ir.Move)
    assert {name: getattr(move, name) for name in wanted} == wanted


def test_settings_of_a_spline_move_with_a_missing_argument() -> None:
    move = statement("SLIN XP2 WITH $VEL = SVEL_CP(0.1, , LCPDAT1), $TOOL = STOOL2(FP2), $APO.CDIS=3 C_SPL")
    assert isinstance(move, ir.Move)
    names = [shown(target) for target, _ in move.settings]
    assert names == ["@path_speed", "@swivel_speed", "@twist_speed", "@tool", "@blend_distance"]
    assert shown(move.settings[0][1]) == "<SVEL_CP(0.1,,LCPDAT1).CP m/s>"


def test_the_first_axis_stands_for_all_in_a_spline_move() -> None:
    move = statement("SPTP P WITH $VEL_AXIS[1]=50")
    assert isinstance(move, ir.Move)
    assert [target.indices[0].value for target, _ in move.settings] == [1, 2, 3, 4, 5, 6]  # type: ignore[union-attr]


TRIGGERS = [
    ("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[19]=FALSE", ("start", None, 0, None)),
    ("TRIGGER WHEN DISTANCE=1 DELAY=-20 DO $OUT[1]=TRUE", ("middle", None, -20, None)),
    ("TRIGGER WHEN PATH = 0 ONSTART DELAY = 0 DO autMotorON() PRIO = 101", ("start", 0, 0, 101)),
    ("TRIGGER WHEN PATH=-15.5 DELAY=10 DO X() PRIO=-1", ("end", -15.5, 10, -1)),
]


def _number(expression: ir.Expression | None) -> float | None:
    match expression:
        case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
            return value
        case ir.Unary(op="-", operand=operand):
            inner = _number(operand)
            return None if inner is None else -inner
        case ir.Quantity(value=value, unit="ms"):
            return _number(value)
    return None


@pytest.mark.parametrize(("text", "wanted"), TRIGGERS)
def test_triggers(text: str, wanted: tuple[object, ...]) -> None:
    trigger = statement(text)
    assert isinstance(trigger, ir.Trigger)
    found = (trigger.reference, _number(trigger.distance), _number(trigger.delay), _number(trigger.priority))
    assert found == wanted


def test_a_technology_call_on_the_path_keeps_its_name_and_arguments() -> None:
    trigger = statement("TRIGGER WHEN DISTANCE=1 DELAY=20 DO H50(CHK,1,2) PRIO=-1")
    assert isinstance(trigger, ir.Trigger)
    called = trigger.action
    assert isinstance(called, ir.CallRoutine)
    assert (called.name, [shown(given.value) for given in called.arguments if given.value]) == (
        "H50",
        ["CHK", "1", "2"],
    )


STATEMENTS = [
    ("GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )", ir.DeclareInterrupt),
    ("INTERRUPT DECL 3 WHEN $IN[2]==FALSE DO BRAKE", ir.DeclareInterrupt),
    ("INTERRUPT DECL 3 WHEN $IN[2] DO $OUT[1]=TRUE", ir.DeclareInterrupt),
    ("INTERRUPT DECL 6 WHEN $CYCFLAG[3]==FALSE DO A20(TECH_STOP2)", ir.DeclareInterrupt),
    ("INTERRUPT DECL 15 WHEN $ZERO_MOVE DO H70 (7,CD0 )", ir.DeclareInterrupt),
    ("TRIGGER WHEN DISTANCE=0 DELAY=0 DO H50(CHK_APO_UP,1,1,GCONT) PRIO=-1", ir.Trigger),
    ("Wait for StrClear($LOOP_MSG[])", ir.WaitUntil),
    ("INTERRUPT ON 3", ir.ControlInterrupt),
    ("INTERRUPT OFF", ir.ControlInterrupt),
    ("BRAKE", ir.StopMotion),
    ("BRAKE F", ir.StopMotion),
    ("RESUME", ir.ResumeLevel),
    ("CONTINUE", ir.LookAhead),
    ("WAIT SEC 0.2", ir.Wait),
    ("WAIT FoR $IN[1]", ir.WaitUntil),
    ("WAIT FOR permission OR ($MODE_OP == #T1);", ir.WaitUntil),
    ("HALT", ir.Halt),
    ("PULSE($OUT[3],TRUE,0.5)", ir.Pulse),
    ("FINAL:", ir.Label),
    ("GOTO FINAL", ir.Goto),
    ('SWRITE(S[],STATE,OFFSET,"%d",N)', ir.Do),
    ("STRCLEAR(S[])", ir.Do),
    ('MsgNotify("hello %1","me",N)', ir.Message),
    ('MsgQuit("..","myMod",,,12345)', ir.Message),
    ('MsgDialog(A,"really?","me",,,,"yes","no")', ir.Dialog),
    ("ON_ERROR_PROCEED", ir.Vendor),
    ("ANOUT ON X = 3.5 * $VEL.CP DELAY = 0.1 MAXIMUM=1.0", ir.Vendor),
    ("PTP !", ir.Vendor),
    ("STOP WHEN PATH = 50 IF $IN[10]==FALSE", ir.Vendor),
    ("TIME_BLOCK PART = 12.5", ir.PathRule),
    ("CONST_VEL START = 50 ONSTART", ir.PathRule),
    ("ASYPTP {E1 10}", ir.Vendor),
    ("STOP = 3", ir.Assign),
    ("UNKNOWN_ROUTINE(1,2)", ir.CallRoutine),
    ("$OUT_C[4]=TRUE", ir.Trigger),
]


@pytest.mark.parametrize(("text", "kind"), STATEMENTS)
def test_statements(text: str, kind: type) -> None:
    found, diagnostics = body(text)
    assert not [item.as_text() for item in diagnostics]
    assert isinstance(found[0], kind)


@pytest.mark.parametrize(
    ("condition", "wanted"),
    [("$IN[1]==TRUE", "digital_in:1"), ("$IN[1]==FALSE", "(not digital_in:1)"), ("A>3", "(A > 3)")],
)
def test_an_interrupt_watches_the_signal_itself(condition: str, wanted: str) -> None:
    found = statement(f"INTERRUPT DECL 5 WHEN {condition} DO X()")
    assert isinstance(found, ir.DeclareInterrupt)
    assert shown(found.condition) == wanted


def test_a_routine_of_the_project_hides_a_built_in() -> None:
    program, _ = read(
        "DEF P()\nPULSE(1)\nX=ABS(2)\nEND\nDEF PULSE(N:IN)\nDECL INT N\nEND\n"
        "DEFFCT INT ABS(N:IN)\nINT N\nRETURN N\nENDFCT\n"
    )
    call, assign = program.modules[0].routines[0].body
    assert isinstance(call, ir.CallRoutine)
    assert isinstance(assign, ir.Assign)
    assert isinstance(assign.value, ir.Call)


BLOCKS = """
IF(A>1) THEN
  B=1
ELSE ;otherwise
  B=2
ENDIF
SWITCH N
  CASE 1,2
    B=1
  DEFAULT
    B=3
ENDSWITCH
FOR I=5 TO 1 STEP -1
  IF I==3 THEN
    EXIT
  ENDIF
ENDFOR
WHILE B<3
  B=B+1
ENDWHILE
REPEAT
  B=B-1
UNTIL B==0
LOOP
  EXIT
ENDLOOP
SPLINE WITH $VEL.CP=0.1
  SPL P1
  STOP WHEN PATH = 50 IF $IN[10]==FALSE
  SLIN P2
ENDSPLINE C_DIS
"""


def test_blocks() -> None:
    found, diagnostics = body(BLOCKS)
    assert not list(diagnostics)
    kinds = [type(item).__name__ for item in found]
    assert kinds == ["If", "Switch", "For", "While", "Repeat", "Loop", "Spline"]
    choice, switch, loop, *_, spline = found
    assert isinstance(choice, ir.If)
    assert [type(item).__name__ for item in choice.branches[0][1]] == ["Assign", "Nothing"]  # the remark at ELSE
    assert [type(item).__name__ for item in choice.otherwise] == ["Assign"]
    assert isinstance(switch, ir.Switch) and len(switch.cases[0].values) == 2 and switch.default
    assert isinstance(loop, ir.For) and loop.counter == "I" and shown(loop.step or ir.Name("")) == "(- 1)"
    assert isinstance(spline, ir.Spline) and len(spline.body) == 3 and spline.blend == _MODAL_DISTANCE


@pytest.mark.parametrize(
    ("lines", "what"),
    [
        ("SPLINE\nSPTP P1\nENDSPLINE", "SPTP"),
        ("PTP_SPLINE\nSLIN P1\nENDSPLINE", "a path motion"),
        ("SPLINE\nLIN P1\nENDSPLINE", "PTP, LIN or CIRC"),
        ("PTP_SPLINE\nCONST_VEL START=0\nSPTP P1\nENDSPLINE", "CONST_VEL"),
        ("SPLINE\nSPL P1\nTIME_BLOCK END\nENDSPLINE", "TIME_BLOCK END needs a value"),
    ],
)
def test_what_a_spline_block_has_none_of_is_told(lines: str, what: str) -> None:
    (report,) = body(lines)[1]
    assert report.severity == Severity.ERROR and what in report.as_text()
