"""Tasks of a program that run from the start, in languages whose controllers have background programs."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """ENTRY main
TASK guard ENTRY beat BACKGROUND{cyclic}
GLOBAL VAR beats: INT = 0

PROCEDURE main()
    WAIT 1 s
    SET do[1] TO beats > {least} AND beats < {most}
END PROCEDURE

PROCEDURE beat()
{body}
END PROCEDURE
"""
ONE_PASS = "    beats = beats + 1\n    WAIT 0.1 s"
LOOP = f"    LOOP\n{ONE_PASS}\n    END LOOP"
CASES = {
    "a loop of its own": PROGRAM.format(cyclic="", least=7, most=12, body=LOOP),
    "again and again": PROGRAM.format(cyclic=" CYCLIC", least=7, most=12, body=ONE_PASS),
    "once": PROGRAM.format(cyclic="", least=0, most=2, body=ONE_PASS),
}


@pytest.mark.parametrize("target", ["krl", "rapid", "rpl"])
@pytest.mark.parametrize("case", CASES)
def test_a_task_that_runs_from_the_start_is_a_background_program(case: str, target: str) -> None:
    read = read_sources([source_from_text("cell.rpl", CASES[case])], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, None, None, diagnostics)
    assert not [item.as_text() for item in diagnostics if item.severity.word in ("loss", "error")]
    back = read_sources([source_from_bytes(one.path, one.data) for one in written.files], target, Diagnostics())
    result = run_program(back.program, None, entry=written.renamed.get("main", "main"))
    assert result.status == "finished"
    assert [bool(value) for _, _, value in result.outputs] == [True]


def test_one_that_moves_the_robot_is_refused_by_name() -> None:
    text = PROGRAM.format(cyclic="", least=0, most=2, body="    MOVE LINEAR BY {z: 5}")
    read = read_sources([source_from_text("cell.rpl", text)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(read, "krl", "kuka_kr6r900sixx", None, diagnostics)
    assert "background-task-lost" in [item.code.name for item in diagnostics]


def test_data_is_set_by_the_program_that_has_the_same_first_routine_as_a_task() -> None:
    """Tasks of RAPID all begin with main: only the one that moves sets the program's data at its start."""
    from rpl import ir
    from rpl.passes.legalise.facts.entries import moving_entries

    main = ir.Routine("main", body=(ir.Return(),))
    beside = ir.Task("T2", "main", "background", modules=("beside",))
    modules = (ir.Module("m", "rapid", routines=(main,)), ir.Module("beside", "rapid", routines=(main,), task="T2"))
    assert moving_entries(ir.Program(modules, entry="main", tasks=(beside,))) == {"main"}
