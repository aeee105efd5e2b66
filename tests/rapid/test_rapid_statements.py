"""What single statements mean. Facts: RAPID reference manuals, instructions; kernel reference, statements."""

import pytest
from rapid_helpers import body, module, read, statement

from rpl import ir

N = ir.Name("n")
DO1, DI1 = ir.Signal("digital_out", name="do1"), ir.Signal("digital_in", name="di1")
ON, OFF = ir.BoolLiteral(True), ir.BoolLiteral(False)
ONE, TWO = ir.IntLiteral(1), ir.IntLiteral(2)
TIMEOUT = "ERR_WAIT_MAXTIME"
I1 = ir.Name("i1")


def real(value: float) -> ir.RealLiteral:
    return ir.RealLiteral(value)


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("n:=n+1;", ir.Assign(N, ir.Binary("+", N, ONE))),
        ("Set do1;", ir.Assign(DO1, ON)),
        ("Reset do1;", ir.Assign(DO1, OFF)),
        ("SetDO do1,high;", ir.Assign(DO1, ON)),
        ("SetDO do1, n;", ir.Assign(DO1, ir.Convert("truth", N))),
        ("SetDO do1,di1;", ir.Assign(DO1, DI1)),
        ("SetDO \\SDelay:=0.2,do1,0;", ir.SetAfter(DO1, OFF, real(0.2))),
        ("SetGO go1,5;", ir.Assign(ir.Signal("group_out", name="go1"), ir.IntLiteral(5))),
        ("SetAO ao1,2.5;", ir.Assign(ir.Signal("analog_out", name="ao1"), real(2.5))),
        ("InvertDO do1;", ir.Assign(DO1, ir.Unary("not", DO1))),
        ("PulseDO do1;", ir.Pulse(DO1, ir.Unary("not", DO1), real(0.2))),
        ("PulseDO \\High \\PLength:=1,do1;", ir.Pulse(DO1, ON, ONE)),
        ("WaitDI di1,1;", ir.WaitUntil(DI1)),
        ("WaitDI di1,0\\MaxTime:=2;", ir.WaitUntil(ir.Unary("not", DI1), TWO, None, TIMEOUT)),
        ("WaitDI di1,1\\MaxTime:=2\\TimeFlag:=b;", ir.WaitUntil(DI1, TWO, ir.Name("b"))),
        ("WaitUntil \\InPos,n>1;", ir.WaitUntil(ir.Binary(">", N, ONE), in_position=True)),
        ("WaitAI ai1,\\LT,2;", ir.WaitUntil(ir.Binary("<", ir.Signal("analog_in", name="ai1"), TWO))),
        ("WaitGI gi1,2;", ir.WaitUntil(ir.Binary("=", ir.Signal("group_in", name="gi1"), TWO))),
        ("WaitTime 0.5;", ir.Wait(real(0.5))),
        ("WaitTime\\InPos,0;", ir.Wait(ir.IntLiteral(0), True)),
        ("WaitRob\\InPos;", ir.WaitForMotion()),
        ("CONNECT i1 WITH t1;", ir.ConnectInterrupt(I1, "t1")),
        ("ISignalDI di1,1,i1;", ir.OrderInterrupt(I1, "edge", DI1)),
        ("ISignalDI\\Single,di1,0,i1;", ir.OrderInterrupt(I1, "edge", ir.Unary("not", DI1), once=True)),
        ("ISignalDI di1,edge,i1;", ir.OrderInterrupt(I1, "change", DI1)),
        ("ITimer\\Single,2,i1;", ir.OrderInterrupt(I1, "timer", time=TWO, once=True)),
        ("IPers n,i1;", ir.OrderInterrupt(I1, "change", N)),
        ("ISleep i1;", ir.ControlInterrupt("off", I1)),
        ("IWatch i1;", ir.ControlInterrupt("on", I1)),
        ("IDelete i1;", ir.ControlInterrupt("delete", I1)),
        ("IDisable;", ir.ControlInterrupt("disable")),
        ("StopMove\\Quick;", ir.StopMotion(True)),
        ("RestoPath;", ir.StoreMotion(restore=True)),
        ("Stop;", ir.Halt("stop")),
        ("Stop \\NoRegain;", ir.Halt("stop")),
        ("EXIT;", ir.Halt("exit")),
        ("ExitCycle;", ir.Halt("cycle")),
        ("RETURN;", ir.Return()),
        ("RAISE 5;", ir.Raise(ir.IntLiteral(5))),
        ("GOTO x;", ir.Goto("x")),
        ("x:", ir.Label("x")),
        ("Incr n;", ir.Do("increment", (N,))),
        ("Add n,2;", ir.Do("increment", (N, TWO))),
        ("ClkStart c;", ir.Clock("start", ir.Name("c"))),
        ('TPWrite "a";', ir.Message("write", ir.TextLiteral("a"))),
        ('TPWrite "a"\\Num:=n;', ir.Message(
            "write", ir.Binary("+", ir.TextLiteral("a"), ir.Builtin("value_text", (N,))))),
        ("TPErase;", ir.Message("clear", ir.TextLiteral(""))),
        ('TPReadFK n,"?","Yes","No",stEmpty,"",stEmpty;', ir.Dialog(
            N, ir.TextLiteral("?"), (ir.TextLiteral("Yes"), ir.TextLiteral("No"), None, None, None))),
        ('UIMsgBox \\Header:="h","m";', ir.Message("quit", ir.TextLiteral("m"), sender=ir.TextLiteral("h"))),
        ("own n\\Safe?Safe;", ir.CallRoutine("own", (
            ir.Argument(N), ir.Argument(ir.Name("Safe"), "Safe", "Safe")))),
        ("own\\FlyBy?FlyBy;", ir.CallRoutine("own", (ir.Argument(ir.Name("FlyBy"), "FlyBy", "FlyBy"),))),
        ('%"tune"% 1;', ir.CallRoutine("", (ir.Argument(ONE),), ir.TextLiteral("tune"))),
        ("%RoutineName%;", ir.CallRoutine("", (), ir.Name("RoutineName"))),
        ("ConfJ\\Off;", ir.Assign(ir.System("joint_configuration_check"), OFF)),
        ("ConfL \\On;", ir.Assign(ir.System("path_configuration_check"), ON)),
        ("SingArea\\Wrist;", ir.Assign(ir.System("singularity_mode"), ir.EnumLiteral("wrist"))),
        ("SocketSend s\\Str:=\"a;b\";", ir.Vendor("rapid", 'SocketSend s\\Str:="a;b";', "message")),
        ("SocketClose s; ! bye", ir.Vendor("rapid", "SocketClose s;", "unknown")),
        ("MotionSup\\Off;", ir.Vendor("rapid", "MotionSup\\Off;", "none")),
        ("IF n=1 SocketClose s;", ir.If(((ir.Binary("=", N, ONE), (
            ir.Vendor("rapid", "SocketClose s;", "unknown"),)),))),
    ],
)  # fmt: skip
def test_instructions(text: str, meaning: ir.Statement) -> None:
    assert statement(text, "VAR num n;VAR bool b;VAR clock c;VAR intnum i1;") == meaning


def test_settings_that_one_instruction_makes_together() -> None:
    percent, limit = body("VelSet 50,800;")
    assert (percent, limit) == (
        ir.Assign(ir.System("speed_percent"), ir.IntLiteral(50)),
        ir.Assign(ir.System("speed_limit"), ir.IntLiteral(800)),
    )


def test_compact_and_block_if_on_one_line() -> None:
    first, second = body("IF n=1 GOTO x;\nIF ok THEN EXIT; ENDIF", "VAR num n;VAR bool ok;")
    assert first == ir.If(((ir.Binary("=", N, ONE), (ir.Goto("x"),)),))
    assert second == ir.If(((ir.Name("ok"), (ir.Halt("exit"),)),))


def test_blocks() -> None:
    text = """
    IF n=1 THEN n:=2; ELSEIF n=2 THEN
      FOR i FROM 1 TO n DO Incr n; ENDFOR
    ELSE WHILE TRUE DO ENDWHILE ENDIF
    FOR i FROM 10 TO 1 STEP -2 DO
    ENDFOR
    TEST n
    CASE 1,-2: n:=1;
    CASE "%":
    DEFAULT: Stop;
    ENDTEST"""
    choice, loop, test = body(text, "VAR num n;")
    up = ir.For("i", ONE, N, None, (ir.Do("increment", (N,)),), True, True, True)
    assert choice == ir.If(
        (
            (ir.Binary("=", N, ONE), (ir.Assign(N, TWO),)),
            (ir.Binary("=", N, TWO), (up,)),
        ),
        (ir.While(ON, ()),),
    )
    assert loop == ir.For("i", ir.IntLiteral(10), ONE, ir.Unary("-", TWO), (), False, True, True)
    assert test == ir.Switch(
        N,
        (
            ir.Case((ONE, ir.Unary("-", TWO)), (ir.Assign(N, ONE),)),
            ir.Case((ir.TextLiteral("%"),), ()),
        ),
        (ir.Halt("stop"),),
    )


def test_routines_with_every_kind_of_parameter() -> None:
    one = module(
        "MODULE m\n"
        "PROC p(num a, INOUT pos b\\switch On | switch Off\\num c, VAR signaldo s, num d{*,*},PERS tooldata t)\n"
        "ENDPROC\nLOCAL FUNC bool f()\nRETURN TRUE;\nENDFUNC\nTRAP t\nENDTRAP\nENDMODULE"
    )
    first, second, third = one.routines
    number = ir.RealType()
    assert first.parameters == (
        ir.Parameter("a", number),
        ir.Parameter("b", ir.VectorType(), "reference"),
        ir.Parameter("On", ir.BoolType(), optional=True, switch=True, choice=1),
        ir.Parameter("Off", ir.BoolType(), optional=True, switch=True, choice=1),
        ir.Parameter("c", number, optional=True),
        ir.Parameter("s", ir.SignalType("digital_out"), "reference"),
        ir.Parameter("d", ir.ArrayType(number, (None, None))),
        ir.Parameter("t", ir.ToolType(), "reference"),
    )
    assert (second.kind, second.returns, second.scope) == ("function", ir.BoolType(), "module")
    assert third.kind == "trap"


def test_error_undo_and_backward_sections() -> None:
    text = """MODULE m
    PROC p()
      n:=1;
    ERROR (ERR_WAIT_MAXTIME, 12)
      RETRY;
    ERROR
      IF ERRNO=5 TRYNEXT;
      RAISE;
    UNDO
      Reset do1;
    BACKWARD
      n:=0;
    ENDPROC
    ENDMODULE"""
    (routine,) = module(text).routines
    listed, others = routine.handlers
    assert listed == ir.Handler((ir.Name("ERR_WAIT_MAXTIME"), ir.IntLiteral(12)), (ir.Retry(),))
    assert others.codes == () and others.body[-1] == ir.Raise()
    assert routine.undo == (ir.Assign(DO1, OFF),)
    assert routine.backward == (ir.Assign(N, ir.IntLiteral(0)),)


def test_declarations() -> None:
    one = module(
        "MODULE m\n RECORD box\n num w;\n pos at;\n ENDRECORD\n ALIAS num level;\n"
        " LOCAL VAR box b1:=[1,[2,3,4]];\n PERS num count;\n TASK PERS tooldata tGrip;\n CONST num g{2,3,1};\n"
        " VAR socketdev s;\n VAR errnum ERR_OWN:=-1;\nENDMODULE"
    )
    number = ir.RealType()
    record, alias, local, pers, tool, array, socket, error = one.declarations
    assert record == ir.RecordDeclaration("box", (("w", number), ("at", ir.VectorType())), "task")
    assert alias == ir.AliasDeclaration("level", number, "task")
    assert isinstance(local, ir.Variable) and (local.scope, local.storage) == ("module", "variable")
    assert pers == ir.Variable("count", number, None, "persistent", "global")
    assert tool == ir.Variable("tGrip", ir.ToolType(), None, "persistent", "task")
    assert array == ir.Variable("g", ir.ArrayType(number, (TWO, ir.IntLiteral(3), ONE)), None, "constant", "task")
    assert isinstance(socket, ir.Variable) and socket.type == ir.VendorType("rapid", "socketdev")
    assert isinstance(error, ir.Variable) and error.type == number


def test_a_signal_parameter_is_the_signal_that_was_passed() -> None:
    text = "MODULE m\nPROC p(VAR signaldo s)\nSet s;\nENDPROC\nPROC main()\np doX;\np lamp;\nENDPROC\nENDMODULE"
    first, main = module(text).routines
    assert first.body == (ir.Assign(ir.Signal("digital_out", name="s"), ON),)
    signals = [ir.Signal("digital_out", name=name) for name in ("doX", "lamp")]
    assert main.body == tuple(ir.CallRoutine("p", (ir.Argument(signal),)) for signal in signals)


@pytest.mark.parametrize(
    ("line", "meaning"),
    [
        ("b:=DOutput(s)=1;", ir.Assign(ir.Name("b"), ir.Signal("digital_out", name="s"))),
        ("b:=s=0;", ir.Assign(ir.Name("b"), ir.Unary("not", ir.Signal("digital_out", name="s")))),
        ("n:=s;", ir.Assign(N, ir.Convert("bit", ir.Signal("digital_out", name="s")))),
        ("WaitDO s,1;", ir.WaitUntil(ir.Signal("digital_out", name="s"))),
        ("p s;", ir.CallRoutine("p", (ir.Argument(ir.Signal("digital_out", name="s")),))),
    ],
)
def test_a_signal_parameter_that_is_read(line: str, meaning: ir.Statement) -> None:
    text = f"MODULE m\nVAR num n;\nVAR bool b;\nPROC p(VAR signaldo s)\n{line}\nENDPROC\nENDMODULE"
    assert module(text).routines[0].body == (meaning,)


def test_a_routine_of_the_project_hides_an_installed_one() -> None:
    text = "MODULE m\nPROC TPErase()\nENDPROC\nPROC main()\nTPErase;\nENDPROC\nENDMODULE"
    assert module(text).routines[1].body == (ir.CallRoutine("TPErase"),)


@pytest.mark.parametrize("text", ["<SMT>", "IF TRUE <SMT>"])
def test_a_placeholder_is_flagged(text: str) -> None:
    result, diagnostics = read(f"MODULE m\nPROC main()\n{text}\nn:=1;\nENDPROC\nENDMODULE")
    assert [item.code.name for item in diagnostics] == ["placeholder"]
    assert result.files[0].opaque == 0
    assert result.program.modules[0].routines[0].body[-1] == ir.Assign(N, ONE)
