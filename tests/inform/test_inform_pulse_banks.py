"""Positions in pulses beside poses in a bank that is indexed: variables of their own, and translation elsewhere."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text
from tests.there_and_back import there_and_back

ARM = "motoman_mh24"
JOB = """/JOB
//NAME TABLE
//POS
///NPOS 2,0,0,0,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0,0,0
C00000=700.000,0.000,350.000,180.0000,0.0000,0.0000
C00001=720.000,50.000,300.000,180.0000,0.0000,0.0000
//INST
///DATE 2024/03/05 09:20
///ATTR SC,RW
///GROUP1 RB1
NOP
MOVJ C00000 VJ=50.00 PL=0
GETS PX{pulses} $PX000
GETS PX020 $PX001
SET B000 30
*FILL
SET P[B000] P020
SETE P[B000] (2) 60000
INC B000
JUMP *FILL IF B000<33
MOVL P031 V=200.0 PL=0
{then}
GETE D000 P{pulses} (1)
JUMP *BAD IF D000>20
DOUT OT#(1) ON
*BAD
END
"""


def read(pulses: str, then: str) -> ReadProgram:
    diagnostics = Diagnostics()
    found = read_sources([source_from_text("TABLE.JBI", JOB.format(pulses=pulses, then=then))], "inform", diagnostics)
    assert not diagnostics.has_errors
    return found


def variables(program: ir.Program) -> dict[str, ir.Type]:
    return {
        one.name: one.type for module in program.modules for one in module.declarations if isinstance(one, ir.Variable)
    }


@pytest.mark.parametrize(
    ("pulses", "then", "alone"),
    [
        ("000", "", True),
        ("043", "MOVJ P043 VJ=20.00 PL=0", True),
        ("000", "SET B001 0\nGETS PX[B001] $PX000\nMOVJ P[B001] VJ=20.00", False),
    ],
)
def test_pulses_with_fixed_numbers_are_no_array(pulses: str, then: str, alone: bool) -> None:
    found = variables(read(pulses, then).program)
    assert isinstance(found.get(f"P{pulses}_PULSES"), ir.JointsType) == alone
    assert isinstance(found["P"], ir.ArrayType)


def outputs(result: RunResult) -> list[tuple[str, object]]:
    return [(name, value) for _, name, value in result.outputs]


@pytest.mark.parametrize("target", ["tp", "urscript", "krl", "vplus"])
def test_such_a_bank_elsewhere(target: str) -> None:
    job = JOB.format(pulses="000", then="MOVJ P000 VJ=20.00 PL=0")
    journey = there_and_back({"TABLE.JBI": job}, "inform", target, ARM)
    assert outputs(run_program(journey.source.program, ARM)) == [("OT#(1)", True)]
    assert not journey.found.has_errors and not journey.losses
    result = journey.prove("TABLE")
    assert result.agrees, result.as_text()
    larger = [one for one in journey.found.of(Severity.WARNING) if one.code.name == "registers-set-up"]
    assert bool(larger) == (target == "tp")  # 128 positions, and the controller has 100 as delivered
