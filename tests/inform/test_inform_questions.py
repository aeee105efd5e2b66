"""INPUT: the operator types a number, and MSG in front of it is the question."""

from __future__ import annotations

import pytest
from inform_helpers import job, outputs, run

from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

CELL = '[[answer]]\ntext = "other"\nanswer = 9\n\n[[answer]]\ntext = "racks"\nanswer = {answer}\n'


@pytest.mark.parametrize(("place", "answer"), [("B010", "4"), ("D000", "4"), ("R001", "4.5"), ("LI002", "-4")])
def test_what_the_operator_types(place: str, answer: str) -> None:
    """M: the message is the question."""
    body = f'MSG "number of"\nMSG "racks?"\nINPUT {place}\nDOUT OT#(1) ON IF {place}={answer}'
    assert outputs(run(job(body), cell=CELL.format(answer=answer))) == [("OT#(1)", True)]


@pytest.mark.parametrize("question", ['MSG "number of racks?"', 'MSG "number of "\nMSG "racks?"'])
def test_a_question_is_shown_once(question: str) -> None:
    result = run(job(f"'the racks\n{question}\nINPUT B010"), cell=CELL.format(answer=3))
    texts = [event.data["text"] for event in result.trace if event.kind == "message"]
    assert texts == ["number of racks?"]


FORMS = {
    "krl": (
        "t.src",
        'DEF T()\nINT A\nMsgDialog(A,"How many racks?",,,,,"ONE","TWO")\nIF A==2 THEN\n$OUT[1]=TRUE\nENDIF\nEND\n',
    ),
    "rapid": (
        "t.mod",
        "MODULE t\nVAR num a;\nPROC t()\n"
        'TPReadNum a,"How many racks are there in the store of this cell?";\nIF a=2 SetDO do1,1;\nENDPROC\nENDMODULE\n',
    ),
    "vplus": (
        "t.v2",
        '.PROGRAM t()\n PROMPT "How many racks: ", a\n IF a == 2 THEN\n  SIGNAL 1\n END\n.END\n',
    ),
}


@pytest.mark.parametrize("language", FORMS)
def test_questions_of_other_languages(language: str) -> None:
    name, text = FORMS[language]
    read = read_sources([source_from_text(name, text)], language, Diagnostics())
    diagnostics = Diagnostics()
    translation = translate_program(read, "inform", None, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    assert b"INPUT" in translation.files[0].data
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "inform", Diagnostics())
    result = run_program(back.program, None, parse_cell(CELL.format(answer=2)), "T")
    assert [value for _, _, value in result.outputs] == [True]


LOST = {
    "text-question-lost": '.PROGRAM t()\n PROMPT "Operator: ", $who\n TYPE $who\n.END\n',
}


@pytest.mark.parametrize("named", LOST)
def test_questions_that_cannot_be_asked(named: str) -> None:
    read = read_sources([source_from_text("t.v2", LOST[named])], "vplus", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(read, "inform", None, None, diagnostics)
    assert named in {item.code.name for item in diagnostics.of(Severity.LOSS)}
