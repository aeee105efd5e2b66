"""EIO.cfg of a backup says what the numbers of analogue signals stand for.

ABB technical reference, system parameters, topic I/O System: Maximum and Minimum Logical Value are what programs use
where the signal has Maximum and Minimum Physical Value. M: the unit by the size, and equal logical values.
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_program
from rpl.proof.prove import prove_programs
from rpl.source import source_from_text
from tests.there_and_back import there_and_back

EIO = """EIO:CFG_1.0:6:0::
#
EIO_SIGNAL:

      -Name "flow" -SignalType "AO" -Unit "Board1" -UnitMap "0-15"\\
      -MaxLog 200 -MaxPhys 10 -MaxPhysLimit 10 -MaxBitVal 4095

      -Name "lift" -SignalType "AO" -MinLog -1 -MaxLog 1 -MinPhys -10 -MaxPhys 10
      -Name "plain" -SignalType "AO" -MinPhys -10 -MaxPhys 10
      -Name "current" -SignalType "AO" -MaxLog 100 -MinPhys 4 -MaxPhys 20
      -Name "heat" -SignalType "AI" -MaxLog 50 -MaxPhys 10
      -Name "open" -SignalType "AO" -MaxLog 50
      -Name "lamp" -SignalType "DO"
#
EIO_CROSS:

      -Name "late" -SignalType "AO" -MaxLog 50 -MaxPhys 10
"""
PROGRAM = "MODULE m\n  PROC main()\n    {body}\n  ENDPROC\nENDMODULE\n"


def _files(body: str, configuration: str = EIO) -> dict[str, str]:
    return {"RAPID/m.mod": PROGRAM.replace("{body}", body), "SYSPAR/EIO.cfg": configuration}


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize(
    ("body", "written"),
    [
        ("SetAO flow,100;", "AOUT AO#(1) 5.0"),
        ("SetAO lift,-0.5;", "AOUT AO#(1) -5.0"),
        ("SetAO plain,2.5;", "AOUT AO#(1) 2.5"),
    ],
)
def test_the_level_is_that_of_the_configuration(body: str, written: str, end: str) -> None:
    given = there_and_back(_files(body, EIO.replace("\n", end)), "rapid", "inform")
    assert not given.losses and written in given.text
    assert given.prove().equal


@pytest.mark.parametrize(
    ("body", "loss"),
    [
        ("SetAO current,50;", "analog-other-unit"),
        ("SetAO open,5;", "analog-unit-unknown"),
        ("SetAO late,5;", "analog-unit-unknown"),
        ("SetAO nowhere,5;", "analog-unit-unknown"),
    ],
)
def test_what_it_does_not_say_is_a_loss(body: str, loss: str) -> None:
    assert there_and_back(_files(body), "rapid", "inform").losses == [loss]


def test_a_reading_is_scaled() -> None:
    given = there_and_back(_files("IF AInput(heat)>25 SetDO lamp,1;"), "rapid", "krl")
    assert not given.losses and "0.5" in given.text


def test_a_translation_is_for_the_same_controller() -> None:
    for target in ("rapid", "rpl"):
        given = there_and_back(_files("SetAO flow,100; SetAO lift,0.5;"), "rapid", target)
        assert not given.losses and given.prove().equal


def test_it_is_recognised_by_its_content() -> None:
    found = Diagnostics()
    files = _files("SetAO flow,100;")
    program = read_program([source_from_text(name, text) for name, text in files.items()], None, found)
    assert not list(found) and program.dialects == ("rapid",)
    assert [(one.path, one.statements) for one in program.files][1] == ("SYSPAR/EIO.cfg", 0)
    other = read_program([source_from_text("m.mod", files["RAPID/m.mod"].replace("100", "50"))], None, found)
    assert not prove_programs(program.program, other.program).equal
