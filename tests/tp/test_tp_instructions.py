"""Several neutral statements that are one TP instruction: put together right in front of the writer."""

from __future__ import annotations

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.errors import InternalError
from rpl.ir.walk import walk
from rpl.passes.typing import normalise
from rpl.source import source_from_text
from rpl.writing.ledger import EmissionLedger
from rpl.writing.target import WriteContext

POINTS = "".join(
    f"P[{number}]{{ GP1: UF : 1, UT : 2, J1= {number}.0 deg, J2= 2.0 deg, J3= 3.0 deg, J4= 4.0 deg, J5= 5.0 deg,"
    f" J6= 6.0 deg }};\n"
    for number in (1, 2)
)


def read(lines: str) -> ir.Program:
    text = "".join(f"   :{line if line[1:2] == ' ' else '  ' + line} ;\n" for line in lines.splitlines())
    diagnostics = Diagnostics()
    source = source_from_text("P.LS", f"/PROG  P\n/MN\n{text}/POS\n{POINTS}/END\n")
    return normalise(registry.dialect("tp").read([source], diagnostics).program, diagnostics)


def together(program: ir.Program) -> ir.Program:
    for one in registry.target("tp").last():
        program = one(program, WriteContext(Diagnostics()))
    return program


def found(lines: str) -> list[tuple[str, list[str]]]:
    """Text and kinds of the statements of each instruction that was put together."""
    made = [one for one in walk(together(read(lines))) if isinstance(one, ir.Instruction)]
    return [(one.text, [type(part).__name__ for part in one.parts]) for one in made]


@pytest.mark.parametrize(
    "lines, instructions",
    [
        ("UFRAME_NUM=2", [("", ["Assign", "Assign"])]),
        ("UFRAME[3]=PR[5]", [("", ["Assign", "If"])]),
        ("UALM[3]", [("UALM[3]", ["Message", "Halt"])]),
        ("WAIT DI[1]=ON TIMEOUT,LBL[9]\nLBL[9]", [("", ["WaitUntil", "If"])]),
        ("SKIP CONDITION DI[5]=ON\nL P[1] 50mm/sec FINE Skip,LBL[9]\nLBL[9]", [("", ["Move", "If"])]),
        ("SKIP CONDITION DI[5]=ON\nL P[1] 50mm/sec FINE Skip,LBL[9],PR[9]=JPOS\nLBL[9]", [("", ["Move", "If", "If"])]),
        ("J P[R[1]] 50% FINE", [("J P[R[1]] 50% FINE", ["Switch"])]),
        ("L P[1] 45deg/sec FINE MROT CTV50", [("L P[1] 45deg/sec FINE MROT CTV50", ["Vendor", "Vendor", "Move"])]),
        ("SELECT R[1]=1,JMP LBL[9]\nLBL[9]", []),
        ("PAYLOAD[2]\nL P[1] 50mm/sec FINE", []),
        ("WAIT DI[1]=ON\nIF DI[2]=ON,JMP LBL[9]\nLBL[9]", []),
    ],
)
def test_what_is_one_instruction(lines: str, instructions: list[tuple[str, list[str]]]) -> None:
    assert found(lines) == instructions


def test_instructions_stand_in_loops_that_are_instructions() -> None:
    lines = "R[R[4]]=0\nFOR R[1]=1 TO R[2]\nUTOOL_NUM=2\nFOR R[3]=9 DOWNTO 1\nUALM[1]\nENDFOR\nENDFOR"
    loop = ["Assign", "While"]
    assert found(lines) == [("", loop), ("", ["Assign", "Assign"]), ("", loop), ("UALM[1]", ["Message", "Halt"])]


def test_nothing_is_lost_on_the_way() -> None:
    """The same statements in the same order, and the ledger misses each of them until it is accounted for."""
    before = read("R[R[4]]=0\nUFRAME_NUM=2\nFOR R[1]=1 TO 3\nWAIT DI[1]=ON TIMEOUT,LBL[9]\nLBL[9]\nENDFOR\nUALM[1]")
    behind = together(before)

    def told(program: ir.Program) -> list[str]:
        made = (node for node in walk(program) if not isinstance(node, ir.Instruction))
        return [type(node).__name__ for node in made]

    assert told(behind) == told(before)
    ledger = EmissionLedger()
    missed = [type(one).__name__ for one in ledger.missed(behind)]
    assert {"Instruction", "Assign", "While", "WaitUntil", "Message", "Halt"} <= set(missed)
    ledger.written(behind.modules[0])
    with pytest.raises(InternalError, match="were not written"):
        ledger.check(behind)
