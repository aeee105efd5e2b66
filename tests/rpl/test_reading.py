"""What people write: what it means, how it is printed, and what is reported."""

from __future__ import annotations

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.reading.ledger import FileReport
from rpl.source import source_from_text
from rpl.writing.target import WriteContext


def read(text: str) -> tuple[ir.Program, list[str], FileReport]:
    diagnostics = Diagnostics()
    result = registry.dialect("rpl").read([source_from_text("cell.rpl", text)], diagnostics)
    return result.program, [item.code.name for item in diagnostics], result.files[0]


def printed(program: ir.Program) -> str:
    return registry.target("rpl").write(program, WriteContext(Diagnostics()))[0].data.decode()


def main_lines(text: str) -> list[str]:
    """The statements of a script, as RPL prints them."""
    program, codes, _ = read(text)
    assert codes == []
    lines = printed(program).splitlines()
    start = next(i for i, line in enumerate(lines) if "PROCEDURE main()" in line)
    end = next(i for i, line in enumerate(lines) if i > start and "END PROCEDURE" in line)
    return [line[8:] for line in lines[start + 1 : end]]


@pytest.mark.parametrize(
    ("written", "canonical"),
    [
        ("x=1", "x = 1"),
        ("X = 1.0", "X = 1.0"),
        ("x = 0x1F", "x = 0x1F"),
        ("x = 1e3", "x = 1e3"),
        ("x = a + b * c", "x = a + b * c"),
        ("x = (a + b) * c", "x = (a + b) * c"),
        ("x = ((a))", "x = a"),
        ("x = a - (b - c)", "x = a - (b - c)"),
        ("x = - a ** 2", "x = -a ** 2"),
        ("x = 2 ** -3", "x = 2 ** (-(3))"),
        ("x = a = b", "x = (a = b)"),
        ("x = not a = b", "x = NOT a = b"),
        ("x = a and b or c", "x = (a AND b) OR c"),
        ("x = a and  then b", "x = a AND THEN b"),
        ("x = 10 div 3 mod 2", "x = 10 DIV 3 MOD 2"),
        ("x = 500mm/s", "x = 500 mm/s"),
        ("x = (v * 2) mm", "x = (v * 2) mm"),
        ("x = d as inch", "x = d AS inch"),
        ("x = 5 %", "x = 5 %"),
        ("x = table : part", "x = table : part"),
        ("x = {x: 1, `odd key`: 2}", "x = {x: 1, `odd key`: 2}"),
        ("x = Target.krl {X 1}", None),
        ("x = target.krl {x: 1, s: 2}", "x = target.krl {x: 1, s: 2}"),
        ("x = $TOOL", "x = $tool"),
        ("x = $Timer[3]", "x = $timer[3]"),
        ("x = $nonsense", None),
        ("x = SQRT(2.0)", "x = sqrt(2.0)"),
        ("x = `sqrt`(2.0)", "x = `sqrt`(2.0)"),
        ("x = to_int(2.5)", "x = to_int(2.5)"),
        ("x = to_int(1, 2)", None),
        ("x = di[3]", "x = di[3]"),
        ("x = GI[1 TO 8]", "x = gi[1 TO 8]"),
        ("x = do(grip)", "x = do(grip)"),
        ("x = a[1 TO 2]", None),
        ("do[1] = true", "SET do[1] TO ON"),
        ("set do[1] to off", "SET do[1] TO OFF"),
        ("SET do[1] TO ON AFTER 0.5 s", "SET do[1] TO ON AFTER 0.5 s"),
        ("f()", "f()"),
        ("f(1, ?, c := 3, switch fast)", "f(1, ?, c := 3, SWITCH fast)"),
        ("increment(x)", "increment(x)"),
        ("`increment`(x)", "`increment`(x)"),
        ("open hand", "open_hand()"),
        ("move to p", "MOVE TO p"),
        ("MOVE JOINT TO p", "MOVE TO p"),
        ("move linear to p blend 10 mm speed 200 mm/s", "MOVE LINEAR TO p SPEED 200 mm/s BLEND 10 mm"),
        ("MOVE CIRCULAR VIA a TO b ANGLE 120 deg", "MOVE CIRCULAR VIA a TO b ANGLE 120 deg"),
        ("MOVE BY {z: 5} IN BASE", "MOVE BY {z: 5}"),
        ("MOVE TO p SPEED 5 mm/s SPEED 6 mm/s", None),
        ("MOVE TO p FINE ZONE z10", None),
        ("MOVE TO p RADIUS 5 mm", None),
        ("wait 0.2 s", "WAIT 0.2 s"),
        ("WAIT UNTIL di[1] FLAG late TIMEOUT 5 s", "WAIT UNTIL di[1] TIMEOUT 5 s FLAG late"),
        ("IF a THEN x = 1", ["IF a THEN", "    x = 1", "END IF"]),
        ("LOOP; EXIT; ENDLOOP", ["LOOP", "    EXIT", "END LOOP"]),
        ("x = {1,\n  2, -- two\n  3}", "x = {1, 2, 3} -- two"),
        ("3 = x", None),
        ("x = (1", None),
        ("MOVE sideways TO p", None),
        ("END", None),
    ],
)
def test_statements(written: str, canonical: str | list[str] | None) -> None:
    if canonical is None:
        program, codes, report = read(f"a = 1\n{written}\nb = 2\n")
        assert codes == ["unreadable-statement"]
        body = program.modules[0].routines[0].body
        before, after = ir.Assign(ir.Name("a"), ir.IntLiteral(1)), ir.Assign(ir.Name("b"), ir.IntLiteral(2))
        assert body == (before, ir.Opaque(written), after)
        assert report.unread == (written,)
        return
    assert main_lines(written) == ([canonical] if isinstance(canonical, str) else canonical)


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("IF a THEN\n x = 1\n", ["missing-block-end"]),
        ("END IF\n", ["stray-block-end"]),
        ("ELSE\n", ["stray-section"]),
        ("IF a THEN\nELSE\nELSE\nEND IF\n", ["misplaced-part"]),
        ("SWITCH x\n y = 1\nCASE 1\nEND SWITCH\n", ["misplaced-part"]),
        ("IF a THEN\n VAR x: INT\nEND IF\n", ["misplaced-part"]),
        ("PROCEDURE a()\n x = 1\n VAR y: INT\nEND PROCEDURE\n", ["misplaced-part"]),
        ("MODULE m\n x = 1\nEND MODULE\n", ["misplaced-part"]),
        ("SPLINE\n WAIT 1 s\nEND SPLINE\n", ["misplaced-part"]),
        ("PROCEDURE increment(REFERENCE x: INT)\nEND PROCEDURE\n", ["unreadable-statement", "stray-block-end"]),
        ("PROCEDURE a()\nPROCEDURE b()\nEND PROCEDURE\n", ["missing-block-end"]),
    ],
)
def test_faults_are_reported(text: str, codes: list[str]) -> None:
    assert read(text)[1] == codes


def test_a_missing_end_does_not_swallow_the_next_routine() -> None:
    program, _, _ = read("PROCEDURE a()\n x = 1\nPROCEDURE b()\n y = 1\nEND PROCEDURE\n")
    assert [routine.name for routine in program.modules[0].routines] == ["a", "b"]


def test_an_open_bracket_costs_its_statement_alone() -> None:
    program, codes, _ = read("x = f(1,\nWAIT 1 s\ny = 2\n")
    assert codes == ["unreadable-statement"]
    assert program.modules[0].routines[0].body[1:] == (
        ir.Wait(ir.Quantity(ir.IntLiteral(1), "s")),
        ir.Assign(ir.Name("y"), ir.IntLiteral(2)),
    )


def test_comments_travel() -> None:
    text = "-- file\n\n-- about x\nx = 1 -- why\n-- alone\n\nIF x = 1 THEN -- head\n    -- inside\nEND IF\n"
    assert main_lines(text) == [
        "-- about x",
        "x = 1 -- why",
        "-- alone",
        "",
        "IF x = 1 THEN -- head",
        "    -- inside",
        "END IF",
    ]
    program, _, _ = read(text)
    assert printed(program).startswith("-- file\nMODULE cell\n")


def test_gripper_and_frames() -> None:
    program, codes, _ = read(
        "GRIPPER hand = do[4] OPEN ON CLOSE OFF TIME 0.1 s\n"
        "FRAME table = {x: 1}\nFRAME part = {x: 2} ON table\nFRAME hole = {x: 3} ON part\n"
        "MOVE TO hole\npart.x = part.x + 5\nCLOSE hand\n"
        "PROCEDURE other(part: POSE)\nMOVE TO part\nEND PROCEDURE\n"
    )
    assert codes == []
    main, opened, closed, other = program.modules[0].routines
    table, part, hole = ir.Name("table"), ir.Name("part"), ir.Name("hole")
    assert main.body == (
        ir.Move("joint", ir.Binary(":", ir.Binary(":", table, part), hole)),
        ir.Assign(ir.Field(part, "x"), ir.Binary("+", ir.Field(part, "x"), ir.IntLiteral(5))),
        ir.CallRoutine("close_hand"),
    )
    assert opened.body == (
        ir.Assign(ir.Name("hand"), ir.BoolLiteral(True)),
        ir.Wait(ir.Quantity(ir.RealLiteral(0.1), "s")),
    )
    assert closed.name == "close_hand"
    assert other.body == (ir.Move("joint", part),)


def test_program_with_tasks() -> None:
    text = (
        "ENTRY main\nTASK watch ENTRY guard BACKGROUND CYCLIC MODULES m, n\n\n"
        'MODULE m USING krl TASK watch PUBLIC\n    ATTRIBUTE "access" "RVP"\n    GLOBAL VAR x: INT\n\n'
        "    GLOBAL PROCEDURE guard()\n    END PROCEDURE\nEND MODULE\n"
    )
    program, codes, _ = read(text)
    assert codes == []
    assert program.entry == "main"
    assert program.tasks == (ir.Task("watch", "guard", "background", True, ("m", "n")),)
    assert program.modules[0].dialect == "krl"
    assert program.modules[0].declarations == (ir.Variable("x", ir.IntType(), scope="global"),)
    assert printed(program) == text


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_every_character_is_accounted_for(end: str) -> None:
    lines = ["-- a", "", "x = 1 ; y = 2; -- b", ";", "PROCEDURE p()", "  z = {1,", "   2}", "END PROCEDURE", ""]
    text = end.join(lines)
    diagnostics = Diagnostics()
    registry.dialect("rpl").read([source_from_text("cell.rpl", text)], diagnostics)
    assert list(diagnostics) == []


@pytest.mark.parametrize(
    ("text", "sure"),
    [
        ("MODULE m USING krl\nEND MODULE\n", True),
        ("PROCEDURE main()\nEND PROCEDURE\n", True),
        ("MOVE TO pick_part\nCLOSE gripper\n", True),
        ("DEF main()\nPTP HOME\nEND\n", False),
        ("MODULE m\nPROC main()\nMoveJ p1,v100,fine,tool0;\nENDPROC\nENDMODULE\n", False),
        ("2024-01-01 12:00 robot started\n", False),
    ],
)
def test_recognition(text: str, sure: bool) -> None:
    assert (registry.dialect("rpl").recognise("x", text) >= 30) is sure


def test_deep_and_long_input_is_refused_not_fatal() -> None:
    for text in ("x = " + "(" * 5000 + "1" + ")" * 5000, "x = " + "1 + " * 20000 + "1", "x = " + "-" * 5000 + "1"):
        read(text)


def test_one_file_for_each_module() -> None:
    program, _, _ = read("ENTRY a\nMODULE m\nEND MODULE\nMODULE `n/1`\nEND MODULE\n")
    files = registry.target("rpl").write(program, WriteContext(Diagnostics(), options={"files": "module"}))
    assert [file.path for file in files] == ["m.rpl", "n_1.rpl", "tasks.rpl"]


@pytest.mark.parametrize(
    ("tasks", "codes"),
    [
        ("TASK beat ENTRY pulse", ["rpl-entry-not-begun"]),
        ("TASK beat ENTRY pulse BACKGROUND", []),
        ("TASK beat ENTRY pulse\nTASK first ENTRY main", []),
    ],
)
def test_a_task_that_stands_for_the_entry_is_reported(tasks: str, codes: list[str]) -> None:
    routines = "".join(f"PROCEDURE {name}()\n WAIT 1 s\nEND PROCEDURE\n" for name in ("main", "pulse"))
    text = f"ENTRY main\n{tasks}\n{routines}"
    diagnostics = Diagnostics()
    registry.dialect("rpl").read([source_from_text("p.rpl", text)], diagnostics)
    assert [item.code.name for item in diagnostics] == codes
