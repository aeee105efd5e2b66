r"""Texts of RAPID: digits in them, other forms of numbers, and their 80 characters.

Source: RAPID reference manual, StrFind (\NotInSet), NumToStr (\Exp), StrToByte (\Hex \Okt \Bin), DecToHex, HexToDec,
StrDigCmp, StrDigCalc and the data type string. M: the form of \Exp, and that digits count up to 32 bits.
"""

from __future__ import annotations

import pytest
from rapid_helpers import read

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SHOWN = {
    r'ValToStr(StrFind("aab;c",1,"ab"\NotInSet))': "4",
    r'ValToStr(StrFind("aab",1,"ab"\NotInSet))': "4",
    r"NumToStr(0.38521,2\Exp)": "3.85E-01",
    r'ValToStr(StrToByte("1F"\Hex))': "31",
    r'ValToStr(StrToByte("17"\Okt))': "15",
    r'ValToStr(StrToByte("101"\Bin))': "5",
    'DecToHex("99999999")': "5F5E0FF",
    'HexToDec("5F5E0FF")': "99999999",
    'ValToStr(StrDigCmp("234",LT,"1234"))': "TRUE",
    'ValToStr(StrDigCmp("7",LTEQ,"007"))': "TRUE",
    'ValToStr(StrDigCmp("7",NOTEQ,"007"))': "FALSE",
    'ValToStr(StrDigCmp("10",GT,"9"))': "TRUE",
    'ValToStr(StrDigCmp("9",GTEQ,"10"))': "FALSE",
    'StrDigCalc("3000000000",OpAdd,"5")': "3000000005",
    'StrDigCalc("13",OpSub,"5")': "8",
    'StrDigCalc("13",OpMult,"5")': "65",
    'StrDigCalc("13",OpDiv,"5")': "2",
    'StrDigCalc("13",OpMod,"5")': "3",
}


def ran(statements: str) -> RunResult:
    result, diagnostics = read(f"MODULE m\nPROC main()\n{statements}\nENDPROC\nENDMODULE\n")
    assert not diagnostics.has_errors
    return run_program(result.program, "abb_irb1200_5_90")


@pytest.mark.parametrize("call", SHOWN)
def test_functions_of_texts(call: str) -> None:
    run = ran(f"TPWrite {call};")
    assert run.status == "finished", run.fault
    assert [event.data["text"] for event in run.trace if event.kind == "message"] == [SHOWN[call]]


@pytest.mark.parametrize("call", ['StrDigCalc("3",OpSub,"5")', 'StrDigCalc("4294967295",OpAdd,"1")', 'DecToHex("1.5")'])
def test_digits_that_come_to_nothing_are_faults(call: str) -> None:
    assert ran(f"TPWrite {call};").status == "fault"


def test_a_text_holds_80_characters() -> None:
    most = ran(f'VAR string t:="{"x" * 40}";\nt:=t+t;\nTPWrite t;')
    assert most.status == "finished", most.fault
    beyond = ran(f'VAR string t:="{"x" * 40}";\nt:=t+t;\nt:=t+"x";\nTPWrite t;')
    assert beyond.status == "fault"
    assert "80" in str(beyond.fault)


def test_a_handler_takes_a_text_that_is_too_long() -> None:
    run = ran(f'VAR string t:="{"x" * 79}";\nt:=t+"yz";\nERROR (ERR_STRTOOLNG)\nSetDO do1,1;\nTRYNEXT;')
    assert run.status == "finished", run.fault


@pytest.mark.parametrize("target", ["krl", "tp", "urscript", "vplus", "inform"])
def test_other_languages_refuse_digits_in_texts(target: str) -> None:
    text = 'MODULE m\nPROC main()\nVAR string t:="13";\nt:=StrDigCalc(t,OpMod,"5");\nTPWrite t;\nENDPROC\nENDMODULE\n'
    program = read_sources([source_from_text("m.mod", text)], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(program, target, "abb_irb1200_5_90", None, diagnostics)
    assert diagnostics.of(Severity.LOSS)


def test_rapid_says_them_again() -> None:
    body = "\n".join(f"TPWrite {call};" for call in SHOWN if "StrToByte" not in call)
    program = read_sources(
        [source_from_text("m.mod", f"MODULE m\nPROC main()\n{body}\nENDPROC\nENDMODULE\n")], "rapid", Diagnostics()
    )
    native = translate_program(program, "rpl", None, None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in native.files], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(back, "rapid", "abb_irb1200_5_90", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    again = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "rapid", Diagnostics())
    run = run_program(again.program, "abb_irb1200_5_90")
    found = [event.data["text"] for event in run.trace if event.kind == "message"]
    assert found == [shown for call, shown in SHOWN.items() if "StrToByte" not in call]
