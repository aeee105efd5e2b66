"""Whole KRL projects: files that belong together, scopes, declarations, damaged text, nothing lost."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from krl_helpers import read, sources, without_comments

from rpl import ir, registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.simulation import run_program

CELL_SRC = """&ACCESS RVP
&REL 3
DEF CELL()
DECL INT N
;FOLD INI;%{PE}
N=LIMIT
;ENDFOLD
LOCAL1(N,TEXT[])
END

DEF LOCAL1(A:IN,B[]:OUT)
INT A
DECL CHAR B[]
END

GLOBAL DEFFCT REAL TWICE(X)
REAL X
RETURN 2*X
ENDFCT
"""
CELL_DAT = """&ACCESS RVP
DEFDAT  CELL PUBLIC
EXT  BAS (BAS_COMMAND  :IN,REAL  :IN )
DECL INT LIMIT=5,OTHER
DECL GLOBAL CONST REAL PI_=3.14
DECL CHAR TEXT[24]
DECL CHAR NAMES[4,16]
STRUC S_T INT A,B,REAL C[3],CHAR D[8]
ENUM E_T RED,GREEN
SIGNAL GRIP $OUT[3]
SIGNAL BYTE1 $OUT[9] TO $OUT[16]
DECL S_T REC={A 1,D[] "x;y"}
DECL E6POS XP1={X 1.5,Y -2.0,S 'B010',T 35}
NAMES[1,]="one"
ENDDAT
"""
CONFIG = """DEFDAT $CONFIG
DECL FRAME BASE_DATA[16]
BASE_DATA[1]={X 1.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
ENDDAT
"""
PROJECT = {
    "cell.src": CELL_SRC,
    "CELL.DAT": CELL_DAT,
    "$config.dat": CONFIG,
    "sps.sub": "DEF SPS()\nLOOP\n$FLAG[1]=$IN[1]\nENDLOOP\nEND\n",
    "points.dat": "DEFDAT POINTS PUBLIC\nDECL GLOBAL POS P1={X 1}\nENDDAT\n",
}


@pytest.fixture
def project() -> ir.Program:
    program, diagnostics = read(PROJECT)
    assert not [item.as_text() for item in diagnostics if item.severity == Severity.ERROR]
    return program


def test_files_of_one_name_are_one_module(project: ir.Program) -> None:
    assert [module.name for module in project.modules] == ["CELL", "SPS", "$CONFIG", "POINTS"]
    cell = project.modules[0]
    assert cell.public
    assert cell.attributes == (("ACCESS", "RVP"), ("REL", "3"), ("dat ACCESS", "RVP"))
    assert [(routine.name, routine.scope) for routine in cell.routines] == [
        ("CELL", "global"),
        ("LOCAL1", "module"),
        ("TWICE", "global"),
    ]


def test_the_submit_program_is_a_background_task(project: ir.Program) -> None:
    (task,) = project.tasks
    assert (task.entry, task.kind, task.modules) == ("SPS", "background", ("SPS",))


@pytest.mark.parametrize("entry", [None, "JOB"])
def test_the_submit_program_runs_beside_the_chosen_one(entry: str | None) -> None:
    """The submit interpreter is started with the controller, whatever program is selected (KSS operating manuals)."""
    files = {
        "job.src": "DEF JOB()\nWAIT SEC 1.0\n$OUT[1]=(BEAT>5)\nEND\n",
        "job.dat": "DEFDAT JOB PUBLIC\nDECL GLOBAL INT BEAT=0\nENDDAT\n",
        "sps.sub": "DEF SPS()\nLOOP\nBEAT=BEAT+1\nWAIT SEC 0.1\nENDLOOP\nEND\n",
    }
    program, _ = read(files)
    result = run_program(program, entry=entry)
    assert (result.status, result.outputs) == ("finished", ((1.0, "$OUT[1]", True),))


def test_parameters_take_the_types_declared_behind_the_header(project: ir.Program) -> None:
    local = project.modules[0].routines[1]
    assert [(p.name, type(p.type), p.mode) for p in local.parameters] == [
        ("A", ir.IntType, "value"),
        ("B", ir.StringType, "reference"),
    ]
    assert project.modules[0].routines[2].parameters[0].mode == "reference"


def test_data_lists(project: ir.Program) -> None:
    cell = project.modules[0]
    variables = {d.name: d for d in cell.declarations if isinstance(d, ir.Variable)}
    assert variables["LIMIT"].storage == "persistent" and variables["OTHER"].initial is None
    assert (variables["PI_"].storage, variables["PI_"].scope) == ("constant", "global")
    assert variables["TEXT"].type == ir.StringType(ir.IntLiteral(24))
    assert variables["NAMES"].type == ir.ArrayType(ir.StringType(ir.IntLiteral(16)), (ir.IntLiteral(4),))
    assert variables["XP1"].type == ir.TargetType("krl")
    kinds = [type(d).__name__ for d in cell.declarations]
    assert kinds.count("SignalDeclaration") == 2 and kinds.count("Initialise") == 1
    record = next(d for d in cell.declarations if isinstance(d, ir.RecordDeclaration))
    assert [name for name, _ in record.fields] == ["A", "B", "C", "D"]
    config = project.modules[2]
    assert [d.scope for d in config.declarations if isinstance(d, ir.Variable)] == ["global"]


DAMAGE = ["LIN {X 1", "IF A= THEN B", "X=(1+", "DECL", "A B C D", '"', "PTP", "FOR I=1 TO", "]", "X=1 2"]


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_line_costs_itself_alone(damage: str) -> None:
    head, tail = "DEF P()\nDECL INT A\nA=1\nIF A==1 THEN\n", "A=2\nENDIF\nPTP XP1 C_PTP\nEND\n"
    whole, _ = read(head + tail, normal=False)
    broken, diagnostics = read(head + damage + "\n" + tail, normal=False)
    (report,) = list(diagnostics)
    assert report.origin.line == 5
    routine = broken.modules[0].routines[0]
    choice = routine.body[1]
    assert isinstance(choice, ir.If)
    kept = tuple(s for s in choice.branches[0][1] if not isinstance(s, ir.Opaque))
    mended = (routine.body[0], ir.If(((choice.branches[0][0], kept),)), *routine.body[2:])
    assert without_comments(mended) == without_comments(whole.modules[0].routines[0].body)


def test_an_imported_datum_is_seen_under_its_name() -> None:
    program, diagnostics = read(
        {
            "a.src": "DEF A()\nIMPORT INT SHARED IS /R1/OTHER..SHARED\nIMPORT REAL X IS /R1/OTHER..Y\nSHARED=1\nEND\n",
            "other.dat": "DEFDAT OTHER PUBLIC\nDECL INT SHARED=0\nDECL REAL Y=0.0\nENDDAT\n",
        }
    )
    shared, private = program.modules[1].declarations
    assert isinstance(shared, ir.Variable) and shared.scope == "global"
    assert isinstance(private, ir.Variable) and private.scope == "module"
    assert [item.code.name for item in diagnostics] == ["krl-import"]


def test_missing_and_stray_ends() -> None:
    program, diagnostics = read("DEF P()\nIF TRUE THEN\nX=1\nEND\nDEF Q()\nENDLOOP\nEND\n", normal=False)
    assert [routine.name for routine in program.modules[0].routines] == ["P", "Q"]
    assert [item.code.name for item in diagnostics] == ["missing-block-end", "stray-block-end"]


def test_a_routine_without_an_end_keeps_the_next_one() -> None:
    program, _ = read("DEF P()\nX=1\nDEF Q()\nX=2\nEND\n", normal=False)
    assert sorted(routine.name for routine in program.modules[0].routines) == ["P", "Q"]


def test_instructions_without_a_frame_are_a_routine() -> None:
    program, diagnostics = read({"snippet.src": "PTP HOME\nWAIT SEC 1\n"}, normal=False)
    assert program.modules[0].routines[0].name == "snippet"
    assert [item.code.name for item in diagnostics] == ["krl-outside-routine"]


ODD = [
    "X=" + "9" * 6000,
    "X=1E999",
    "X='B2'",
    "X='HFFFFFFFFFF'",
    "X=" + "NOT " * 3000 + "A",
    "X=A" + "[1]" * 3000,
    "X=" + "(" * 1000 + "A" + ")" * 1000,
    "X=\x01",
]


@pytest.mark.parametrize("line", ODD, ids=range(len(ODD)))
def test_odd_statements_are_reported_with_their_place(line: str) -> None:
    _, diagnostics = read(f"DEF P()\n{line}\nEND\n")
    assert [(item.code.name, item.origin.line) for item in diagnostics] == [("unreadable-statement", 2)]


def test_a_statement_that_ends_too_early_says_so() -> None:
    _, diagnostics = read("DEF P()\nIF A\nEND\n", normal=False)
    assert "ends too early" in next(iter(diagnostics)).message


@pytest.mark.parametrize(
    "text", ["\ufeffDEF P()\nEND\x1a", "DEF P()\rX=1\rEND\r", "DEF P()\r\nEND\r\n\x1a", "DEF P()\nEND"]
)
def test_marks_and_line_ends_of_old_editors(text: str) -> None:
    program, diagnostics = read(text, normal=False)
    assert [routine.name for routine in program.modules[0].routines] == ["P"]
    assert not [item.as_text() for item in diagnostics]


LINES = st.lists(
    st.sampled_from(
        [
            "&ACCESS RVP", "DEF A()", "END", "X=1 ;remark", "; only a remark", ";FOLD X;%{PE}", ";ENDFOLD", "", "   ",
            "IF A THEN", "ENDIF", "PTP {X 1", "\tS[]=\"a;b\"", "DECL INT N", "ENDDAT", "DEFDAT D", "\ufeff", "x ü ;ä",
        ]
    )
)  # fmt: skip


@given(LINES, st.sampled_from(["\n", "\r\n"]))
def test_every_piece_of_text_is_accounted_for(lines: list[str], end: str) -> None:
    from rpl.dialects.krl.split import split

    from rpl.reading.ledger import LOWERED, Ledger

    (source,) = sources({"p.src": end.join(lines)})
    ledger = Ledger(source)
    for piece in split(source):
        ledger.claim(piece.start, piece.end, LOWERED)
    assert ledger.rebuilt() == source.text
    assert not [gap for gap in ledger.gaps() if source.text[gap[0] : gap[1]].strip("\ufeff \t\r\n")]
    result = registry.dialect("krl").read([source], Diagnostics())
    assert result.files[0].path == "p.src"


RECOGNISED = [
    ("a.src", "DEF A()\nPTP HOME\nEND\n", True),
    ("a.dat", "DEFDAT A PUBLIC\nENDDAT\n", True),
    ("a.src", "#include <stdio.h>\nint main(void) { return 0; }\n", False),
    ("a.dat", "1.0 2.0 3.0\n4.0 5.0 6.0\n", False),
    ("form.kfd", "DEFTP GRIP={SOT FALSE}\nDECL PARAM one={VALUE {NUMBER:MIN 1,MAX 4}}\nENDTP\nDEF A()\n", False),
    ("a.mod", "MODULE M\nPROC main()\nMoveJ p1,v100,z10,tool0;\nENDPROC\nENDMODULE\n", False),
    ("log.dat", "EVENT :START\nLOGIN :\nTASK :1\n\n" * 20 + "WAIT SEC 1\n", False),
    ("log.src", "2024-01-01 12:00:00 robot started\n2024-01-01 12:00:01 robot stopped\n", False),
]


@pytest.mark.parametrize(("path", "text", "wanted"), RECOGNISED)
def test_recognition_by_content(path: str, text: str, wanted: bool) -> None:
    assert (registry.dialect("krl").recognise(path, text) >= 30) == wanted


@pytest.mark.parametrize(
    "call", ["BAS(#INITMOV,0)", "BAS(#PTP_DAT)", "BAS(#FRAMES)", "BAS(#PTP_PARAMS,30)", "BAS(#CP_DAT)"]
)
def test_commands_of_the_basis_package_use_a_value_only_where_it_is_given(call: str) -> None:
    prelude = registry.dialect("krl").prelude()
    assert prelude is not None
    switch = next(r for r in prelude.routines if r.name == "BAS").body[-1]
    assert isinstance(switch, ir.Switch)
    command = call.split("#")[1].split(",")[0].rstrip(")")
    (case,) = [case for case in switch.cases if ir.EnumLiteral(command) in case.values]
    values = [a.value for s in case.body if isinstance(s, ir.CallRoutine) for a in s.arguments]
    assert (ir.Name("VALUE") in values) == ("PARAMS" in command)


def test_the_prelude_is_clean() -> None:
    from rpl.passes.typing import normalise

    prelude = registry.dialect("krl").prelude()
    assert prelude is not None
    diagnostics = Diagnostics()
    normalise(ir.Program((prelude,)), diagnostics)
    assert not [item.as_text() for item in diagnostics]
    assert {"BAS", "STOOL2", "SVEL_CP"} <= {routine.name for routine in prelude.routines}
