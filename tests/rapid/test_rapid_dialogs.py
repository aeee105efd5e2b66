"""Questions to the operator: UIMessageBox, UINumEntry, UIAlphaEntry and UIMsgBox with a result.

Reference manual, those functions: a predefined button gives its constant (resYes ...), a button of one's own its place;
a number outside of the bounds is not taken.
"""

import pytest
from rapid_helpers import body, read, written

from rpl import ir
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text

DATA = "VAR num n;\nVAR string s;\nVAR btnres btn;\nVAR string list{2};\nVAR bool p;"


@pytest.mark.parametrize(
    ("text", "answer", "holds"),
    [
        ('btn:=UIMessageBox(\\Header:="H"\\Message:="Ask"\\Buttons:=btnYesNo\\Icon:=iconInfo);', "1", "btn=resYes"),
        ('btn:=UIMessageBox(\\Message:="Ask"\\Buttons:=btnYesNo);', "2", "btn=resNo"),
        ('btn:=UIMessageBox(\\Message:="Ask"\\Buttons:=btnYesNoCancel);', "3", "btn=resCancel"),
        ('btn:=UIMessageBox(\\Message:="Ask"\\Buttons:=btnAbrtRtryIgn);', "2", "btn=resRetry"),
        ('btn:=UIMessageBox(\\Message:="Ask"\\Buttons:=btnOKCancel);', "2", "btn=resCancel"),
        ('btn:=UIMessageBox(\\Message:="Ask");', "1", "btn=resOK"),
        ('n:=UIMessageBox(\\MsgArray:=["A","sk"]\\BtnArray:=["x","y"]);', "2", "n=2"),
        ('UIMsgBox\\Header:="H","Ask"\\Buttons:=btnRetryCancel\\Result:=btn;', "1", "btn=resRetry"),
        ('IF UIMessageBox(\\Message:="Ask"\\Buttons:=btnYesNo)=resNo n:=5;', "2", "n=5"),
        ('n:=UINumEntry(\\Message:="Ask"\\InitValue:=1\\MinValue:=0\\MaxValue:=9\\AsInteger);', "7", "n=7"),
        ('s:=UIAlphaEntry(\\Header:="H"\\Message:="Ask"\\InitString:="");', "'abc'", 's="abc"'),
    ],
)
def test_the_answer(text: str, answer: str, holds: str) -> None:
    program = f"MODULE m\n{DATA}\nPROC main()\n{text}\nIF {holds} SetDO do1,1;\nENDPROC\nENDMODULE\n"
    diagnostics = Diagnostics()
    found = read_sources([source_from_text("m.mod", program)], "rapid", diagnostics).program
    assert not diagnostics.has_errors
    result = run_program(found, None, parse_cell(f"[[answer]]\nanswer = {answer}\n"), "main")
    assert result.status == "finished" and [name for _, name, _ in result.outputs] == ["do1"]


def test_a_number_out_of_bounds_is_asked_for_again() -> None:
    text = 'n:=UINumEntry(\\Message:="Ask"\\MinValue:=2\\MaxValue:=9);\nIF n=5 SetDO do1,1;'
    program = f"MODULE m\n{DATA}\nPROC main()\n{text}\nENDPROC\nENDMODULE\n"
    found = read_sources([source_from_text("m.mod", program)], "rapid", Diagnostics()).program
    cell = parse_cell("[[answer]]\nanswer = 1\n[[answer]]\nanswer = 12\n[[answer]]\nanswer = 5\n")
    result = run_program(found, None, cell, "main")
    assert [name for _, name, _ in result.outputs] == ["do1"]


@pytest.mark.parametrize(
    "text",
    [
        'n:=UIMessageBox(\\Message:="Ask"\\BtnArray:=list);',
        'p:=p AND UIMessageBox(\\Message:="Ask")=resOK;',
        'n:=UINumEntry(\\Message:="Ask"\\DIBreak:=di1);',
    ],
)
def test_what_has_no_neutral_form_stays_a_call(text: str) -> None:
    inside = list(walk(*body(text, DATA)))
    assert any(isinstance(one, ir.Call) for one in inside) and not any(isinstance(one, ir.Dialog) for one in inside)


@pytest.mark.parametrize(
    "text",
    [
        'btn:=UIMessageBox(\\Header:="H"\\Message:="Ask"\\Buttons:=btnYesNo);',
        's:=UIAlphaEntry(\\Message:="Ask");',
        'TPReadFK n,"Ask","x","y",stEmpty,stEmpty,stEmpty;',
    ],
)
def test_written_as_it_was(text: str) -> None:
    result, _ = read(f"MODULE m\n{DATA}\nPROC main()\n{text}\nENDPROC\nENDMODULE\n")
    again, diagnostics = written(result.program)
    assert text in again and not diagnostics.has_errors
