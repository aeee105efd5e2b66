"""Programs of other languages in RAPID: searches that ask whether they found, events at a move, times, known data."""

from __future__ import annotations

import pytest
from rapid_helpers import normal

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.typing import normalise
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text
from rpl.translation import translate_program
from tests.there_and_back import there_and_back

TARGET = ir.TargetType("tp")
SENSOR = ir.Signal("digital_in", ir.IntLiteral(5))
GUN = ir.Signal("digital_out", ir.IntLiteral(1))
FIFTY = ir.Speed(path=ir.RealLiteral(50.0))


def rapid(*body: ir.Statement, source: str = "tp") -> tuple[str, list[str]]:
    """The body of a program in RAPID, and what was lost."""
    declarations = (
        ir.Variable("p", TARGET, scope="global"),
        ir.Variable("there", TARGET, scope="global"),
        ir.Variable("hit", ir.BoolType(), scope="global"),
    )
    module = ir.Module("m", source, declarations, (ir.Routine("main", body=tuple(body)),))
    diagnostics = Diagnostics()
    program = normalise(ir.Program((module,)), diagnostics)
    read = ReadProgram(program, program, (), (), (source,))
    done = translate_program(read, "rapid", None, None, diagnostics)
    text = "\n".join(file.data.decode("latin-1") for file in done.files)
    return text, [item.as_text() for item in diagnostics.of(Severity.LOSS)]


def test_a_search_that_says_whether_it_found() -> None:
    search = ir.Search(SENSOR, ir.Name("there"), stop="stop", hit=ir.Name("hit"))
    text, lost = rapid(ir.Move("linear", ir.Name("p"), speed=FIFTY, search=search, blend=ir.BlendStop()))
    assert not lost
    lines = [line.strip() for line in text.splitlines()]
    begin = lines.index("IF di5=1 THEN")
    assert lines[begin + 1] == "hit:=TRUE;"
    assert "SearchL\\Stop,di5,there,p" in text
    assert "hit:=NOT missed;" in lines
    handler = lines.index("ERROR (ERR_WHLSEARCH)")
    assert lines[handler + 1 : handler + 3] == ["missed:=TRUE;", "TRYNEXT;"]


@pytest.mark.parametrize(
    ("condition", "edge", "written"),
    [
        (ir.Unary("not", SENSOR), "rising", "di5\\NegFlank,"),
        (ir.Unary("not", SENSOR), "falling", "di5,"),
        (ir.Unary("not", SENSOR), "either", "di5\\Flanks,"),
        (ir.Binary("==", SENSOR, ir.BoolLiteral(False)), "rising", "di5\\NegFlank,"),
        (ir.Binary("<>", SENSOR, ir.BoolLiteral(False)), "rising", "di5,"),
        (ir.Unary("not", ir.Binary("==", SENSOR, ir.BoolLiteral(False))), "rising", "di5,"),
    ],
)
def test_a_search_for_a_signal_that_goes_off(condition: ir.Expression, edge: str, written: str) -> None:
    search = ir.Search(condition, ir.Name("there"), stop="stop", edge=edge)
    text, lost = rapid(ir.Move("linear", ir.Name("p"), speed=FIFTY, search=search, blend=ir.BlendStop()))
    assert not lost
    assert f"SearchL\\Stop,{written}there,p" in text


@pytest.mark.parametrize(
    ("trigger", "stored"),
    [
        (ir.Trigger("end", ir.Assign(GUN, ir.BoolLiteral(True)), ir.RealLiteral(-10.0)), ",10\\DOp:=do1,1;"),
        (
            ir.Trigger("end", ir.Assign(GUN, ir.BoolLiteral(False)), delay=ir.RealLiteral(-0.1)),
            ",0,0.1\\DOp:=do1,0;",
        ),
    ],
)
def test_an_event_at_the_move_is_stored_before_it(trigger: ir.Trigger, stored: str) -> None:
    text, lost = rapid(ir.Move("linear", ir.Name("p"), speed=FIFTY, triggers=(trigger,), blend=ir.BlendStop()))
    assert not lost
    assert stored in text
    assert "TriggL p," in text


def test_a_move_of_a_given_time_has_a_speed_beside_it() -> None:
    text, lost = rapid(ir.Move("linear", ir.Name("p"), speed=ir.Speed(duration=ir.RealLiteral(1.5))))
    assert not lost
    assert "\\T:=1.5" in text


def test_data_that_starts_as_predefined_data() -> None:
    program = normal(
        "MODULE m\nVAR zonedata z:=z50;\nPROC main()\nIF z.pzone_tcp=50 SetDO do1,1;\nENDPROC\nENDMODULE\n"
    )
    result = run_program(program, None, None, "main", None)
    assert [value for _, name, value in result.outputs if name == "do1"] == [True]


@pytest.mark.parametrize(("size", "named"), [("40", True), ("x", False)])
def test_a_corner_that_every_way_sets_the_same_is_a_number_and_no_data(size: str, named: bool) -> None:
    lines = ("DEF m()", "DECL REAL x", "x=20", f"$APO.CDIS={size}", "PTP {A1 0}", "LIN {X 1} C_DIS", "LIN {X 5}", "END")
    read = read_sources([source_from_text("m.src", "\n".join(lines))], "krl", Diagnostics())
    done = translate_program(read, "rapid", "kuka_kr6r900sixx", None, Diagnostics())
    text = "".join(one.data.decode() for one in done.files)
    assert ("z40" in text, "zPath" in text) == (named, not named), text


def test_a_counter_needs_no_declaration_and_its_remark_stays() -> None:
    begun = "IF $IN[1] THEN\nfar=10.50\nENDIF\nIF $IN[2] THEN\nfar=50.0\nENDIF"
    lines = f"DECL INT n ; how often\nDECL REAL far\n{begun}\nFOR n=1 TO 5\n$OUT[n]=far>n\nENDFOR"
    journey = there_and_back({"main.src": f"DEF main()\n; the whole of it\n{lines}\nEND\n"}, "krl", "rapid")
    assert "VAR num n;" not in journey.text
    head = [line.strip() for line in journey.text.splitlines()]
    at = head.index("PROC main()")
    assert head[at + 1 : at + 4] == ["! the whole of it", "! how often", "VAR num far;"]
    assert "far:=50;" in head and "far:=10.50;" in head  # no `.0`, other numbers as they are spelled
