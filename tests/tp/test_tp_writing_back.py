"""Listings written back: the lines of a program that was read, and what is read from what was written."""

from __future__ import annotations

import pytest
from tp_writing_helpers import numbered

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.passes.typing import normalise
from rpl.source import Source, source_from_text
from rpl.writing.target import WriteContext

POINTS = """P[1:"home"]{ GP1: UF : 1, UT : 2, CONFIG : 'N U T, 0, 0, 0', X = 600.0 mm, Y = -0.5 mm, Z = 400.0 mm,
 W = -180.0 deg, P = 0.0 deg, R = 12.3456 deg };
P[2]{ GP1: UF : 1, UT : 2, CONFIG : 'F D B, 0, -1, 1', X = 600.0 mm, Y = 0.0 mm, Z = 400.0 mm, W = 1.0 deg,
 P = 2.0 deg, R = 3.0 deg, E1= 250.0 mm };
P[3]{ GP1: UF : 1, UT : 2, J1= 1.0 deg, J2= -2.0 deg, J3= 3.0 deg, J4= 4.0 deg, J5= 5.0 deg, J6= 6.0 deg };
P[4]{ GP1: UF : F, UT : F, CONFIG : 'N U T, 0, 0, 0', X = ******** mm, Y = ******** mm, Z = ******** mm,
 W = ******** deg, P = ******** deg, R = ******** deg };
P[5]{ GP1: UF : 1, UT : 2, CONFIG : 'N U T, 0, 0, 0', X = 600.0 mm, Y = 0.0 mm, Z = 400.0 mm, W = 1.0 deg, P = 2.0 deg,
 R = 3.0 deg
   GP2: UF : 1, UT : 2, J1= 45.0 deg };
"""

SAME = [
    "!\n!the part comes\n!\nUFRAME_NUM=1",  # lines between the parts of a program
    "UFRAME_NUM=2",
    "UTOOL_NUM=R[4]",
    "UFRAME[3]=PR[5]",
    "UFRAME[R[4]]=PR[R[5]]",
    "SEMAPHORE[1]=ON\nWAIT SEMAPHORE[2]\nSEMAPHORE[2]=OFF",
    "PR[5]=LPOS-LPOS",
    "PR[5]=JPOS-JPOS",
    "PR[6]=PR[5]+LPOS",
    "J P[1:home] 50% FINE",
    "J P[2] 100% CNT50 ACC80",
    "J P[3] 2.5sec CNT0",
    "L P[1:home] 250mm/sec CR10",
    "L PR[4] R[5]mm/sec CNT R[6] Offset,PR[7]",
    "L P[2] 120cm/min FINE Tool_Offset,PR[3]",
    "L P[2] 30inch/min FINE INC",
    "L P[2] 45deg/sec FINE Wjnt",
    "L P[2] 200mm/sec FINE TB 0.2sec,DO[4]=PULSE,0.5sec",
    "L P[2] 200mm/sec FINE DB 10.0mm,CALL A",
    "J P[R[3]] 20% FINE",
    "L P[1:home] 50mm/sec FINE EV50%",
    "FOR R[1]=1 TO R[2]\nR[3]=R[1]\nENDFOR",
    "FOR R[1]=5 DOWNTO 1\nR[R[3]]=R[1]\nENDFOR",
    "WAIT DI[1]=ON TIMEOUT,LBL[9]\nLBL[9:retry]",
    "WAIT   0.25(sec)",
    "WAIT R[3]",
    "WAIT ((DI[1] AND !DI[2]) OR F[3])",
    "IF SR[1]='abc',JMP LBL[3]\nLBL[3]",
    "R[1]=STRLEN SR[1]",
    "R[1]=FINDSTR SR[1],SR[2]",
    "SKIP CONDITION DI[5]=ON\nL P[1:home] 50mm/sec FINE Skip,LBL[9],PR[7]=LPOS\nLBL[9]",
    "SKIP CONDITION DI[5]=ON OR R[4]=1\nL P[1:home] 50mm/sec FINE Skip,LBL[9],PR[9]=JPOS\nLBL[9]",
    "IF DI[1]=ON,JMP LBL[1]\nSKIP CONDITION DI[5]=ON\nLBL[1]\nSKIP CONDITION DI[6]=ON\nIF DI[2]=ON,JMP LBL[2]\n"
    "SKIP CONDITION DI[7]=ON\nLBL[2]\nL P[1:home] 50mm/sec FINE Skip,LBL[9],PR[7]=LPOS\nLBL[9]",
    "OFFSET CONDITION PR[1]\nIF DI[2]=ON,JMP LBL[2]\nOFFSET CONDITION PR[2]\nLBL[2]\nL P[2] 50mm/sec FINE Offset",
    "R[R[8:at]]=0\nR[19:stack ok]=1\nDO[35:search]=ON\nWAIT RI[1:vacuum]=ON\nF[2:shift end]=(DI[3:door])",
    "R[95]=$MCR.$GENOVERRIDE",
    "IF R[1]=5 AND DI[2]=ON,JMP LBL[3]\nLBL[3]",
    "IF (!DI[1] AND (F[1] OR RI[2])) THEN\nCALL A\nCALL A\nELSE\nEND\nENDIF",
    "SELECT R[1]=1,CALL A\n=2,JMP LBL[9]\nELSE,CALL B(1,'x',R[3])\nLBL[9]",
    "UALM[1]",
    "MESSAGE[hello]",
    "R[R[5]]=SIN[R[6]]",
    "R[7]=((R[8]+3)*2)",
    "R[7]=ABS[R[8]-3]",
    "R[7]=(2*ROUND[R[8]/3])",
    "DO[3]=(ABS[R[7]-3]<0.1 AND ATAN2[R[5],R[6]]>4)",
    "R[3]=R[4] DIV 2",
    "R[3]=DI[3]",
    "R[3]=PR[4,1]",
    "PR[5]=PR[6]+P[2]-PR[7]",
    "PR[5]=LPOS",
    "PR[5,3]=PR[5,3]+100",
    "SR[1]=SR[2]+'abc'",
    "SR[1]=SR[1]+R[2]",
    "DO[3]=R[4]",
    "GO[1]=R[3]",
    "$WAITTMOUT=200",
    "TIMER[1]=RESET",
    "TIMER[1]=START",
    "R[5]=TIMER[1]",
    "OVERRIDE=50%",
    "RUN A",
    "PAYLOAD[2]",
    "LOCK PREG",
    "Open hand 1",
    "!a remark",
]


def read(files: dict[str, str]) -> ir.Program:
    diagnostics = Diagnostics()
    sources: list[Source] = [source_from_text(name, text) for name, text in files.items()]
    return normalise(registry.dialect("tp").read(sources, diagnostics).program, diagnostics)


def written(program: ir.Program) -> tuple[dict[str, str], list[str]]:
    diagnostics = Diagnostics()
    files = registry.target("tp").write(program, WriteContext(diagnostics))
    return {file.path: file.data.decode("ascii") for file in files}, [item.as_text() for item in diagnostics]


def program(statements: str) -> str:
    lines = "\n".join(f"   :{line} ;" if line[1:2] == " " else f"   :  {line} ;" for line in statements.splitlines())
    return f'/PROG  P\n/ATTR\nCOMMENT = "a test";\n/MN\n{lines}\n/POS\n{POINTS}/END\n'


OTHERS = {name: f"/PROG  {name}\n/MN\n   :  R[99]=1 ;\n/POS\n/END\n" for name in ("A.LS", "B.LS")}
OTHERS = {name: text.replace(".LS", "", 1) for name, text in OTHERS.items()}


@pytest.mark.parametrize("statements", SAME)
def test_a_line_is_written_as_it_was(statements: str) -> None:
    files, reports = written(read({"P.LS": program(statements), **OTHERS}))
    assert not reports
    assert numbered(files["P.LS"]) == statements.splitlines()


def test_what_is_written_reads_as_the_same_program() -> None:
    first = read({"P.LS": program("\n".join(SAME)), **OTHERS})
    files, reports = written(first)
    assert not reports
    second = read(files)
    assert [one.body for module in second.modules for one in module.routines] == [
        one.body for module in first.modules for one in module.routines
    ]
    assert written(second)[0] == files


def test_points_keep_what_they_said() -> None:
    files, _ = written(read({"P.LS": program("J P[1] 50% FINE"), **OTHERS}))
    positions = files["P.LS"].split("/POS")[1].replace("\r\n", "\n")
    for part in (
        "P[1:\"home\"]{\n   GP1:\n\tUF : 1, UT : 2,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX =   600.000  mm,",
        "Y =    -0.500  mm,",
        "R =   12.3456 deg\n",
        "CONFIG : 'F D B, 0, -1, 1',",
        "R =     3.000 deg,\n\tE1=   250.000  mm\n",
        "J6=     6.000 deg\n",
        "UF : F, UT : F,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = ********  mm,",
        "R =     3.000 deg\n   GP2: UF : 1, UT : 2, J1= 45.0 deg\n};",
    ):
        assert part in positions


def test_a_condition_program_and_its_monitor() -> None:
    watch = "/PROG  WATCH\tCond\n/MN\n   1:  WHEN DI[3]=ON,CALL A ;\n/POS\n/END\n"
    files, reports = written(read({"P.LS": program("MONITOR WATCH\nMONITOR END WATCH"), "WATCH.LS": watch, **OTHERS}))
    assert not reports
    assert numbered(files["P.LS"]) == ["MONITOR WATCH", "MONITOR END WATCH"]
    assert numbered(files["WATCH.LS"]) == ["WHEN DI[3]=ON,CALL A"]
    assert files["WATCH.LS"].startswith("/PROG  WATCH\t  Cond\r\n")
