"""Data that RAPID tasks share by its name, for targets whose tasks all see the same data."""

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.tasks.taskdata import shared_task_data
from rpl.project import read_sources
from rpl.proof.recording import record_of
from rpl.proof.wiring import with_signal_names
from rpl.registry import target
from rpl.simulation import entry_name, run_program
from rpl.source import Source, source_from_bytes, source_from_text
from rpl.translation import translate_program

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


MOVING = """MODULE Cell
RECORD part
num size;
ENDRECORD
PERS num nAsked:=0;
PERS part paNow:=[0];
VAR num n:=5;
VAR jointtarget j;
PROC main()
MoveAbsJ j,v500,fine,tool0;
nAsked:=Twice(2);
WaitUntil paNow.size=7;
IF n=5 SetDO do1,1;
ENDPROC
FUNC num Twice(num n)
RETURN 2*n;
ENDFUNC
ENDMODULE
"""
BESIDE = """MODULE Cell
RECORD part
num size;
ENDRECORD
PERS num nAsked:=0;
PERS part paNow:=[0];
VAR num n:=1;
PROC main()
WaitUntil nAsked=4;
FOR n FROM 1 TO 3 DO
WaitTime 0.1;
ENDFOR
n:=Twice(n);
paNow.size:=n;
WaitTime 9;
ENDPROC
FUNC num Twice(num x)
RETURN x+6;
ENDFUNC
ENDMODULE
"""


def files(folder: str) -> list[Source]:
    """The robot's program in `folder`, or beside all folders of tasks, with another task beside it."""
    return [source_from_text(f"{folder}Cell.mod", MOVING), source_from_text("TASK2/Cell.mod", BESIDE)]


@pytest.mark.parametrize("folder", ["", "TASK1/"])
@pytest.mark.parametrize("language", ["rapid", "krl", "tp", "urscript", "vplus", "inform", "rpl"])
def test_tasks_with_the_same_names_for_their_own_things(folder: str, language: str) -> None:
    """Both have a module, a first routine, a function, a variable and a loop's counter of the same names."""
    diagnostics = Diagnostics()
    read = read_sources(files(folder), "rapid", diagnostics)
    translation = translate_program(read, language, "abb_irb1200_5_90", None, diagnostics)
    again = Diagnostics()
    written = [source_from_bytes(one.path, one.data) for one in translation.files]
    back = read_sources(written, language, again).program
    assert not again.has_errors and not diagnostics.of(Severity.LOSS)
    found = entry_name(read.program, None)
    entry = translation.renamed.get(found, found) if found else None
    result = run_program(with_signal_names(back, translation.program), "abb_irb1200_5_90", None, entry, 60)
    assert result.fault is None
    happenings = [one for task in record_of(result, back).tasks.values() for one in task]
    assert [one.value for one in happenings if one.kind == "output"] == [True]
