"""Questions to the operator: read as dialogs, so that the answers of a cell file reach them, whatever their text is."""

from __future__ import annotations

import pytest

from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

CASES = [
    ("integer", 'str_cat("Which", " job?")', "2", "answer == 2"),
    ("float", '"How far?"', "2.5", "answer == 2.5"),
    ("string", '"Which name?"', '"left"', 'answer == "left"'),
]


@pytest.mark.parametrize(("kind", "question", "answer", "holds"), CASES)
def test_an_answer_is_kept(kind: str, question: str, answer: str, holds: str) -> None:
    text = (
        f"def job():\n  answer = request_{kind}_from_primary_client({question})\n"
        f"  if {holds}:\n    set_standard_digital_out(0, True)\n  end\nend\n"
    )
    program = read_sources([source_from_text("job.script", text)], "urscript", Diagnostics()).program
    cell = parse_cell(f'[[answer]]\ntext = "Which|How"\nanswer = {answer}\n')
    result = run_program(program, "ur5e", cell)
    assert result.status == "finished" and [value for _, _, value in result.outputs] == [True]


def test_a_dialog_with_keys_of_another_language() -> None:
    """The keys are numbered in the question, and the number is the answer."""
    text = (
        'DEF MAIN()\nDECL INT A\nDECL CHAR T[20]\nT[]="Which job?"\nA=0\n'
        'MSGDIALOG(A,T[],"CELL",,,,"small","big")\nIF A==2 THEN\n  $OUT[1]=TRUE\nENDIF\nEND\n'
    )
    read = read_sources([source_from_text("MAIN.src", text)], "krl", Diagnostics())
    diagnostics = Diagnostics()
    files = translate_program(read, "urscript", "ur5e", None, diagnostics).files
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in files], "urscript", Diagnostics())
    result = run_program(back.program, "ur5e", parse_cell('[[answer]]\ntext = "Which job"\nanswer = 2\n'))
    assert result.status == "finished" and len(result.outputs) == 1
