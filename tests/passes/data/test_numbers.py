"""Whole numbers of a language with one number type."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.capabilities import Fault
from rpl.passes.legalise.data.numbers import numbers
from rpl.passes.legalise.io.signals import number_signals
from rpl.passes.typing import normalise

from .helpers import context, lines, read, routine, variable

FRAME = """MODULE t
  RECORD part
    num kind;
    num weight;
  ENDRECORD
  CONST num rows:=4;
  VAR num table{4}:=[1,2,3,4];
  VAR num sizes{2}:=[1,2.5];
  VAR part parts{2};
  PROC unused(num free)
  ENDPROC
  FUNC num twice(num k)
    RETURN k*2;
  ENDFUNC
  FUNC num half(num h)
    RETURN h/2;
  ENDFUNC
  PROC bump(INOUT num byref)
    byref:=byref+1;
  ENDPROC
  PROC t()
    VAR num i;
    VAR num j;
    VAR num r;
    VAR num c;
%s
  ENDPROC
ENDMODULE
"""


def kinds(text: str, *names: str) -> dict[str, str]:
    program = read(FRAME % text, "rapid")
    done = numbers(program, context(program, "rapid"))
    found = Diagnostics()
    normalise(done, found)
    assert not found.has_errors, [item.as_text() for item in found]
    return {name: type(_element(variable(done, name).type)).__name__.removesuffix("Type").lower() for name in names}


def _element(type: ir.Type) -> ir.Type:
    return type.element if isinstance(type, ir.ArrayType) else type


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("i:=1; j:=i+rows*2; r:=i/2;", {"i": "int", "j": "int", "r": "real"}),
        ("i:=r; r:=0.5;", {"i": "real", "r": "real"}),
        ("i:=r; r:=j; j:=i;", {"i": "int", "r": "int", "j": "int"}),
        ("i:=7 DIV 2; j:=i MOD 3; r:=Round(2.5); c:=Trunc(r);", {"i": "int", "j": "int", "r": "int", "c": "int"}),
        (r"r:=Round(2.55\Dec:=1); i:=Dim(table,1);", {"r": "real", "i": "int", "table": "int", "sizes": "real"}),
        ("i:=twice(3); r:=half(3);", {"i": "int", "r": "real"}),
        ("i:=twice(0.5);", {"i": "real"}),
        ("bump i; j:=i;", {"i": "int", "j": "int"}),
        ("bump i; i:=0.5;", {"i": "real"}),
        ("FOR k FROM 1 TO rows DO i:=i+k; ENDFOR", {"i": "int"}),
        ("FOR k FROM 1 TO 2 STEP 0.5 DO i:=i+k; ENDFOR", {"i": "real"}),
        ("table{2}:=0.5;", {"table": "real"}),
        ("parts{1}.kind:=3; i:=parts{1}.kind; parts{1}.weight:=1.5; r:=parts{2}.weight;", {"i": "int", "r": "real"}),
        ('TPReadNum i,"how many"; TPReadFK j,"which","a","b","","","";', {"i": "real", "j": "int"}),
        ("i:=3000000000;", {"i": "real"}),
    ],
)
def test_inference(text: str, expected: dict[str, str]) -> None:
    assert kinds(text, *expected) == expected


def test_parameters_results_and_fields() -> None:
    program = read(FRAME % "i:=twice(2);bump i;parts{1}.kind:=2;parts{1}.weight:=half(1);", "rapid")
    done = numbers(program, context(program, "rapid"))
    types = {name: routine(done, name).parameters[0].type for name in ("unused", "twice", "half", "bump")}
    assert types == {"unused": ir.RealType(), "twice": ir.IntType(), "half": ir.IntType(), "bump": ir.IntType()}
    assert (routine(done, "twice").returns, routine(done, "half").returns) == (ir.IntType(), ir.RealType())
    record = next(one for one in done.modules[0].declarations if isinstance(one, ir.RecordDeclaration))
    assert record.fields == (("kind", ir.IntType()), ("weight", ir.RealType()))


STATEMENTS = {
    "r:=0.5;i:=table{r};": ["r := 0.5", "i := table[rpl_round(r)]"],
    "r:=0.5;i:=Round(r);": ["r := 0.5", "i := round_half_away<r>"],
    "r:=0.5;i:=Round(r)+1;": ["r := 0.5", "i := (rpl_round(r) + 1)"],
    "r:=0.5;i:=Trunc(r);": ["r := 0.5", "i := rpl_trunc(r)"],
    "i:=j MOD 3;": ["i := (j - ((j div 3) * 3))"],
    "r:=0.5;i:=r DIV 2;": ["r := 0.5", "i := rpl_trunc((r / 2))"],
    "i:=twice(j) MOD 3;": ["i := rpl_mod(twice(j), 3)"],
    "i:=Min(j,3);r:=Max(r,0.5);": ["i := rpl_min_whole(j, 3)", "r := rpl_max(r, 0.5)"],
    "r:=Pow(r,2)+ATan(0.5);": ["r := ((r * r) + atan2(0.5, 1.0))"],
    "r:=0.5;FOR k FROM 1 TO r+2 DO i:=table{k}; ENDFOR": [
        *("r := 0.5", "for k = 1 to rpl_bound(1, (r + 2))", "  i := table[k]"),
    ],
    "FOR k FROM 5 TO r/2 STEP -1 DO i:=i+k; ENDFOR": ["for k = 5 to rpl_ceil((r / 2))", "  i := (i + k)"],
    "TEST i CASE 1,2: j:=1; DEFAULT: j:=2; ENDTEST": [
        *("switch i", "case 1, 2", "  j := 1", "default", "  j := 2"),
    ],
}


@pytest.mark.parametrize("text", STATEMENTS)
def test_statements(text: str) -> None:
    program = read(FRAME % text, "rapid")
    surroundings = context(program, "rapid")
    surroundings.capabilities = _without_round(surroundings.capabilities)
    done = numbers(program, surroundings)
    assert lines(done) == STATEMENTS[text]
    found = Diagnostics()
    normalise(done, found)
    assert not found.has_errors, [item.as_text() for item in found]


def _without_round(capabilities: object) -> object:
    from dataclasses import replace

    functions = capabilities.functions - {"round"}  # type: ignore
    return replace(
        capabilities,
        functions=functions,
        errors=replace(capabilities.errors, faults=capabilities.errors.faults - {Fault.INDEX_FRACTION}),
    )  # type: ignore


def test_a_target_without_whole_numbers_has_reals() -> None:
    from dataclasses import replace

    program = read("DEF t()\nDECL INT i\nDECL CHAR c\ni=c\nc=i\nEND\n", "krl")
    surroundings = context(program, "krl")
    assert not {"IntType", "CharType"} & surroundings.capabilities.types
    done = numbers(program, replace(surroundings))
    assert (variable(done, "i").type, variable(done, "c").type) == (ir.RealType(), ir.StringType(ir.IntLiteral(1)))
    assert lines(done) == ["i := character_code(c)", "c := from_code(i)"]


def test_what_an_analog_signal_brings_has_a_fraction_behind_its_number_too() -> None:
    program = read(FRAME % "r := aiTorque;\ni := giVariant;\nj := diPart;", "rapid")
    done = numbers(number_signals(program, context(program, "rapid")), context(program, "rapid"))
    found = {name: type(variable(done, name).type).__name__ for name in ("r", "i", "j")}
    assert found == {"r": "RealType", "i": "IntType", "j": "IntType"}
