"""Data that RAPID tasks share by its name, for targets whose tasks all see the same data."""

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.taskdata import shared_task_data
from rpl.project import read_sources
from rpl.registry import target
from rpl.source import source_from_text

ONE = "MODULE Station\nPERS num nAsked:=0;\nPERS num nOwn:=1;\nPROC main()\nMoveAbsJ j,v500,fine,tool0;\nnAsked:=4;\n"
TWO = "MODULE Back\nPERS num nAsked:=0;\nPROC main()\nWaitUntil nAsked>0;\nSetDO do1,1;\nENDPROC\nENDMODULE\n"


def translated(language: str) -> ir.Program:
    files = [
        source_from_text("RAPID/TASK1/PROGMOD/Station.mod", ONE + "ENDPROC\nVAR jointtarget j;\nENDMODULE\n"),
        source_from_text("RAPID/TASK2/PROGMOD/Back.mod", TWO),
    ]
    diagnostics = Diagnostics()
    program = read_sources(files, "rapid", diagnostics).program
    context = Context("rapid", language, target(language).capabilities(), diagnostics, taken=names_in(program))
    return shared_task_data(program, context)


def test_one_declaration_and_an_entry_of_its_own() -> None:
    program = translated("krl")
    homes = [(one.name, each.name) for one in program.modules for each in one.declarations]
    assert ("Station", "nOwn") in homes and [home for home, name in homes if name == "nAsked"] == ["rpl_tasks"]
    assert [(task.name, task.entry) for task in program.tasks] == [("TASK1", "main"), ("TASK2", "Back")]
    assert [routine.name for one in program.modules for routine in one.routines] == ["main", "Back"]


def test_a_target_with_tasks_like_these_keeps_them() -> None:
    program = translated("rapid")
    assert [task.entry for task in program.tasks] == ["main", "main"]
