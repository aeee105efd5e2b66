"""What V+ names are: types from use, sizes of arrays, truths, files that belong together, data sections."""

from __future__ import annotations

import re

import pytest
from vplus_helpers import as_rpl, program_of, read, reported, steps, variable

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

REAL, POSE, TEXT, BOOL = ir.RealType(), ir.PoseType(), ir.StringType(), ir.BoolType()

TYPES = [
    ("x = 1", "x", REAL),
    ("MOVE x", "x", POSE),
    ("SET y = x:z", "x", POSE),
    ("SET y = x", "y", POSE),
    ("n = DX(x)", "x", POSE),
    ("TOOL x", "x", POSE),
    ('$x = "a"', "$x", TEXT),
    ("x = 3 < 4", "x", BOOL),
    ("x = SIG(1)\nIF NOT x THEN\nEND", "x", BOOL),
    ("x = TRUE\nn = x+1", "x", REAL),
    ("x = TRUE\nx = 2", "x", REAL),
    ("x = FALSE\nTYPE x", "x", REAL),
    ("x = FALSE\nIF x == FALSE THEN\nEND", "x", BOOL),
    ("x = FALSE\nREAD (5) x", "x", REAL),
    ("IF x THEN\nEND", "x", REAL),
    ("CALL go(x)", "x", POSE),
    ("CALL tell(x)", "x", BOOL),
    ("x[3] = 1", "x", ir.ArrayType(REAL, (ir.IntLiteral(3),), 0)),
    ("FOR n = 0 TO 9\nx[n+1, 2] = 1\nEND", "x", ir.ArrayType(REAL, (ir.IntLiteral(10), ir.IntLiteral(2)), 0)),
    ('FOR n = 7 TO 1 STEP -1\n$x[n] = ""\nEND', "$x", ir.ArrayType(TEXT, (ir.IntLiteral(7),), 0)),
    ("last = 20\nFOR n = 1 TO last\nMOVE x[n]\nEND", "x", ir.ArrayType(POSE, (ir.IntLiteral(20),), 0)),
    ("PROMPT n\nx[n] = 1", "x", ir.ArrayType(REAL, (ir.IntLiteral(255),), 0)),
    ("PROMPT n\nx[n,n,2] = 1", "x", ir.ArrayType(REAL, (ir.IntLiteral(63), ir.IntLiteral(63), ir.IntLiteral(2)), 0)),
    ("x[n MOD 8] = 1", "x", ir.ArrayType(REAL, (ir.IntLiteral(7),), 0)),
    ("x[2] = 0\nCALL fill(x[])", "x", ir.ArrayType(REAL, (ir.IntLiteral(12),), 0)),
]
MORE = """.PROGRAM go(where)
MOVES where
.END
.PROGRAM tell(answer)
answer = SIG(1001)
.END
.PROGRAM fill(list[])
list[12] = 1
.END"""


@pytest.mark.parametrize(("text", "name", "type"), TYPES)
def test_the_type_of_a_name_comes_from_its_use(text: str, name: str, type: ir.Type) -> None:
    program, diagnostics = read(program_of(text, MORE))
    assert not diagnostics.has_errors
    assert variable(program, name).type == type


def test_a_name_cannot_be_a_number_and_a_location() -> None:
    assert reported("x = 1\nMOVE x") == ["vplus-two-kinds"]


def test_names_of_different_signs_are_different_variables() -> None:
    program, _ = read(program_of('a = 1\n$a = "b"\nHERE #a'))
    assert [variable(program, name).name for name in ("a", "$a", "#a")] == ["a", "$a", "#a"]


def test_own_names_hide_global_ones() -> None:
    program, _ = read(program_of("x = 1", ".PROGRAM other\nAUTO x\nMOVE x\n.END"))
    assert variable(program, "x").type == REAL
    (own,) = program.modules[0].routines[1].declarations
    assert isinstance(own, ir.Variable) and own.type == POSE and own.storage == "variable"


def test_storage_of_declared_names() -> None:
    program, diagnostics = read(
        program_of("AUTO a, b[4]\nLOCAL REAL c\nAUTO DOUBLE d\nAUTO LOC e, #f\nGLOBAL $g\na = 1")
    )
    assert [item.code.name for item in diagnostics] == ["vplus-double-as-single"]
    found = {d.name: d for d in program.modules[0].routines[0].declarations if isinstance(d, ir.Variable)}
    assert {name: d.storage for name, d in found.items()} == {
        "a": "variable", "b": "variable", "c": "persistent", "d": "variable", "e": "variable", "#f": "variable",
    }  # fmt: skip
    assert found["e"].type == POSE and found["b"].type == ir.ArrayType(REAL, (ir.IntLiteral(4),), 0)
    assert variable(program, "$g").storage == "persistent"


MODES = [
    ("CALL p(n)", "x = a", "value"),
    ("CALL p(n)", "a = 1", "reference"),
    ("CALL p(n)", "FOR a = 1 TO 2\nEND", "reference"),
    ("CALL p(n)", "IF DEFINED(a) THEN\nEND", "reference"),
    ("CALL p(n)", "CALL q(a)\n.END\n.PROGRAM q(b)\nb = 1", "reference"),
    ("CALL p(n)", "n = 2\nx = a", "reference"),
    ("CALL p(n)", "CALL q\nx = a\n.END\n.PROGRAM q\nn = 1", "reference"),
    ("AUTO n\nCALL p(n)", "n = 2\nx = a", "value"),
    ("CALL p(n)\nEXECUTE 1 q()", "x = a\n.END\n.PROGRAM q\nn = 1", "reference"),
    ("CALL p(n)", "READ (5) a", "reference"),
]


@pytest.mark.parametrize(("text", "inside", "mode"), MODES)
def test_a_parameter_is_a_value_where_nobody_can_tell(text: str, inside: str, mode: str) -> None:
    program, _ = read(program_of(text, f".PROGRAM p(a)\n{inside}\n.END"))
    assert program.modules[0].routines[1].parameters[0].mode == mode


def test_files_of_a_project_share_globals_and_programs() -> None:
    program, diagnostics = read(
        {
            "a.v2": ".PROGRAM one\nMOVE place\nCALL two\n.END",
            "b.v2": ".PROGRAM two\nn = DZ(place)\n.END",
            "c.lc": ".LOCATIONS\nplace 1 2 3 0 180 -45.5\n#rest 10.5 -20 30 0 0 0\nrow[2] 0 0 0 0 0 0\n.END",
            "d.re": '.REALS\nlimit -1.5\n.END\n.STRINGS\n$greeting "hi; there"\n.END',
        }
    )
    assert not list(diagnostics)
    assert variable(program, "place").initial is not None
    assert variable(program, "#rest").type == ir.JointsType(external=False)
    assert variable(program, "limit").initial == ir.Unary("-", ir.RealLiteral(1.5))
    assert variable(program, "$greeting").initial == ir.TextLiteral("hi; there")
    assert variable(program, "row").type == ir.ArrayType(POSE, (ir.IntLiteral(2),), 0)
    assert [module.name for module in program.modules] == ["a", "b", "c", "d"]


def test_programs_of_one_name_are_reported() -> None:
    assert "vplus-program-twice" in reported("n = 1", ".PROGRAM Test\n.END")


def test_long_names_that_are_one_are_reported() -> None:
    assert reported("a.very.long.name.one = 1\na.very.long.name.two = 2") == ["vplus-long-names"]


WARNED = [
    ("WAIT 0.5", "vplus-constant-wait"),
    ("x = a == 1 AND b", "vplus-comparison-precedence"),
    ("SIGNAL 1005", "vplus-input-written"),
    ("n = 1\nAUTO x", "vplus-late-declaration"),
    ("CASE n OF\nn = 1\nVALUE 1:\nEND", "vplus-before-first-value"),
    ("FOR n = 1 TO 2\nEXIT 2\nEND", "vplus-no-such-loop"),
    ("n = NOSUCH(1)", "vplus-unknown-function"),
    ("ABORT 4", "vplus-unknown-task"),
    ("n = 1\n.END\nn = 2\n.PROGRAM z", "vplus-outside-program"),
    ("IF x THEN\nEND l5", "vplus-text-behind-end"),
    ("GOTO 10", "unknown-label"),
    ("CALL nobody", "unknown-routine"),
]


@pytest.mark.parametrize(("text", "code"), WARNED)
def test_what_is_reported(text: str, code: str) -> None:
    program, diagnostics = read(program_of(text))
    from rpl.ir.verify import verify

    verify(program, diagnostics)
    assert code in [item.code.name for item in diagnostics]


PRECEDENCE = [
    ("a+b*c", "(a + (b * c))"),
    ("(a+b)*c", "((a + b) * c)"),
    ("-a*b", "((- a) * b)"),
    ("a AND b OR c", "((a and b) or c)"),
    ("a OR b AND c", "(a or (b and c))"),
    ("(a == 1) OR (b == 2)", "((a = 1) or (b = 2))"),
    ("NOT a AND b", "((not a) and b)"),
    ("a BOR b BAND c", "(a bor (b band c))"),
    ("a MOD b*c", "((a mod b) * c)"),
    ("a-b-c", "((a - b) - c)"),
    ("a =< b", "(a <= b)"),
    ("COM a", "(bnot a)"),
    ("a+b < c*2", "((a + b) < (c * 2))"),
]


def shown(expression: ir.Expression) -> str:
    """An expression with all its brackets, without conversions."""
    match expression:
        case ir.Binary(op=op, left=left, right=right):
            return f"({shown(left)} {op} {shown(right)})"
        case ir.Unary(op=op, operand=operand):
            return f"({op} {shown(operand)})"
        case ir.Convert(operand=operand):
            return shown(operand)
        case ir.IntLiteral(value=value):
            return str(value)
        case ir.Name(id=name):
            return name
    return repr(expression)


@pytest.mark.parametrize(("text", "wanted"), PRECEDENCE)
def test_order_of_evaluation(text: str, wanted: str) -> None:
    program, _ = read(program_of(f"a = 1\nb = 2\nc = 3\nx = 1\nx = {text}"))
    last = program.modules[0].routines[0].body[-1]
    assert isinstance(last, ir.Assign)
    assert shown(last.value) == wanted


def test_signal_numbers_in_variables_are_of_the_kind_of_their_values() -> None:
    assert steps("grip = 33\nSIGNAL -grip")[1] == "SET do[grip] TO OFF"
    assert steps("part = 1012\nWAIT SIG(part)")[1] == "WAIT UNTIL di[part - 1000]"
    program, _ = read(program_of("CALL lamp(2005)\nCALL lamp(2006)", ".PROGRAM lamp(n)\nSIGNAL n\n.END"))
    assert as_rpl(program, "lamp") == ["SET flag[n - 2000] TO ON"]
    assert steps("PROMPT n\nSIGNAL n")[1].startswith("IF ")
    assert steps("FOR i = 1 TO 8\nSIGNAL 40+i\nEND")[1].strip() == "SET do[40 + i] TO ON"
    assert steps("FOR i = 1 TO n STEP 2\nSIGNAL i\nEND")[1].strip().startswith("IF ")


RECOGNISED = [
    (".PROGRAM a()\nMOVES p\nDEPART 10\n.END", True),
    (".PROGRAM a.ros()\n x = 1\n EXECUTE 1 b()\n.END\n", True),
    (".LOCATIONS\np 1 2 3 4 5 6\n.END", True),
    (".PROGRAM a()\nJMOVE #p\nLMOVE q\nSWAIT 1001\nTWAIT 1\n.END", False),
    (".PROGRAM main()\nSPEED 50\n.END\n.TRANS\np 1 2 3 4 5 6\n.END\n.JOINTS\n.END", False),
    ("DEF a()\nPTP p\nEND", False),
]


@pytest.mark.parametrize(("text", "wanted"), RECOGNISED)
def test_recognition_by_content(text: str, wanted: bool) -> None:
    assert (registry.dialect("vplus").recognise("x.txt", text) >= 30) is wanted


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform"])
def test_a_lasting_counter_keeps_its_name_in_its_loop(target: str) -> None:
    """LOCAL data that become data of the module take the counters of loops along."""
    text = ".PROGRAM main()\nAUTO i\ni = 5\nCALL beat()\nIF i == 5 THEN\nSIGNAL 1\nEND\n.END\n"
    text += ".PROGRAM beat()\nLOCAL i\nFOR i = 1 TO 3\nSIGNAL 2\nEND\n.END\n"
    source = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    translation = translate_program(source, target, "adept_viper_s650", None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and len(result.outputs) == 2


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript", "vplus"])
def test_a_called_name_that_the_target_does_not_have(target: str) -> None:
    """`job.7` gets another name in most languages, so a text cannot name it there."""
    text = '.PROGRAM main()\n$name = "job."+$MID("78", 1, 1)\nCALLS $name()\n.END\n'
    text += ".PROGRAM job.7()\nSIGNAL 1\n.END\n.PROGRAM job.8()\nSIGNAL 2\n.END\n"
    source = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    translation = translate_program(source, target, "adept_viper_s650", None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and len(result.outputs) == 1


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript", "vplus", "rpl"])
@pytest.mark.parametrize("call", ['CALLS "job."+$CHR(55)', "CALLS $names[2]", 'CALLS "job.7"', "CALLS $names[3](2)"])
def test_a_name_that_is_worked_out_in_the_call(call: str, target: str) -> None:
    text = '.PROGRAM main()\n$names[1] = "job.8"\n$names[2] = "job.7"\n$names[3] = "put.1"\n'
    text += f"{call}\n.END\n.PROGRAM put.1(no)\nSIGNAL no\n.END\n"
    text += ".PROGRAM job.7()\nSIGNAL 2\n.END\n.PROGRAM job.8()\nSIGNAL 3\n.END\n"
    source = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    translation = translate_program(source, target, "adept_viper_s650", None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and len(result.outputs) == 1


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript", "vplus", "rpl"])
def test_stored_data_beside_a_task_of_its_own(target: str) -> None:
    """RAPID calls the first routine of every task `main`: the values are still set by the program's own."""
    text = """.PROGRAM main()
EXECUTE 2 side()
$new[3] = $names[1]+$names[2]
IF ($new[3] == "onetwo") AND (w[1]+w[2] == 3) THEN
SIGNAL 1
END
WAIT SIG(2001)
SIGNAL 2
.END
.PROGRAM side()
n = w[1]
SIGNAL 2001
.END
.STRINGS
$names[1]  "one"
$names[2]  "two"
.END
.REALS
w[1] 1
w[2] 2
.END
"""
    source = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    translation = translate_program(source, target, "adept_viper_s650", None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    named = {
        re.sub(r"\D", "", name) for _, name, value in result.outputs if value and not name.startswith(("F[", "200"))
    }
    assert result.status == "finished" and len(named & {"0", "1", "2"}) == 2, result.outputs


@pytest.mark.parametrize(
    ("steps", "told"),
    [
        ("SPEED 100 MMPS\nMOVES a", False),
        ("SPEED 100 MMPS\nMOVE a", True),
        ("SPEED 100 MMPS ALWAYS\nMOVES a", True),
        ("SPEED 50\nMOVE a", False),
    ],
)
def test_a_tool_speed_of_moves_in_joints_is_told(steps: str, told: bool) -> None:
    assert ("vplus-speed-of-joints" in reported(steps)) == told
