"""Data lists that set structures or the controller's own data, and names that are words of another language."""

from __future__ import annotations

import re

import pytest
from krl_helpers import sources

from rpl import registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.recording import record_of
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
OTHERS = [name for name in registry.target_names() if name != "krl"]

STRUCTURES = {
    "checks.src": """DEF CHECKS()
PART_T HELD
INT I,N
N=0
FOR I=1 TO 2
SWITCH PARTS[I].GRADE
CASE #FINE
N=N+PARTS[I].ID
ENDSWITCH
ENDFOR
HELD=PARTS[2]
HELD.ID=99
$OUT[1]=(N==11)
$OUT[2]=(PARTS[2].ID==12) AND (HELD.WEIGHT==0.75)
$OUT[3]=PARTS[1].OK AND NOT HELD.OK
END
""",
    "checks.dat": """DEFDAT CHECKS
ENUM GRADE_T FINE,SCRAP
STRUC PART_T INT ID,REAL WEIGHT,BOOL OK,CHAR NAME[12],GRADE_T GRADE
DECL PART_T PARTS[2]
PARTS[1]={ID 11,WEIGHT 2.5,OK TRUE,NAME[] "BOLT",GRADE #FINE}
PARTS[2]={ID 12,WEIGHT 0.75,OK FALSE,NAME[] "NUT",GRADE #SCRAP}
ENDDAT
""",
}
TOOLS = {
    "checks.src": """DEF CHECKS()
$TOOL=TOOL_DATA[1]
$OUT[1]=(TOOL_DATA[1].Z==120)
$OUT[2]=(TOOL_DATA[2].Z==0)
$OUT[3]=(TOOL_DATA[1].X==0)
END
""",
    "$config.dat": "DEFDAT $CONFIG PUBLIC\nTOOL_DATA[1]={X 0.0,Y 0.0,Z 120.0,A 0.0,B 0.0,C 0.0}\nENDDAT\n",
}
OWN_TOOLS = {  # the list of a controller declares what is predefined, in its own size
    "checks.src": TOOLS["checks.src"],
    "$config.dat": "DEFDAT $CONFIG PUBLIC\nFRAME TOOL_DATA[16]\nTOOL_DATA[1]={X 0.0,Y 0.0,Z 120.0,A 0.0,B 0.0,C 0.0}\n"
    "TOOL_DATA[2]={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}\nENDDAT\n",
}
MACHINE = {  # what the lists of the machine declare is known everywhere
    "checks.src": "DEF CHECKS()\n$OUT[1]=($EX_AX_NUM==2)\n$OUT[2]=$TCP_IPO\n$OUT[3]=($LOAD_A1.M==0)\nEND\n",
    "$machine.dat": "DEFDAT $MACHINE PUBLIC\nINT $EX_AX_NUM=2\nENDDAT\n",
    "$option.dat": "DEFDAT $OPTION PUBLIC\nBOOL $TCP_IPO=TRUE\nENDDAT\n",
}
TWO_LISTS = {
    "checks.src": "DEF CHECKS()\nQ()\n$OUT[1]=(V[1]==1)\n$OUT[3]=(V[2]==2)\nEND\n",
    "checks.dat": "DEFDAT CHECKS\nINT V[2]\nV[1]=1\nV[2]=2\nENDDAT\n",
    "q.src": "DEF Q()\n$OUT[2]=(V[1]==7) AND (V[2]==8)\nEND\n",
    "q.dat": "DEFDAT Q\nINT V[2]\nV[1]=7\nV[2]=8\nENDDAT\n",
}
WORDS = {"checks.src": "DEF CHECKS()\nPASS()\n$OUT[2]=TRUE\n$OUT[3]=TRUE\nEND\nDEF PASS()\n$OUT[1]=TRUE\nEND\n"}
BITS = {
    "checks.src": """DEF CHECKS()
INT A,B
A=180
B=-6
$OUT[1]=((A B_AND B)==176) AND ((B B_AND A)==176) AND ((A B_AND (B_NOT 'B100'))==176)
$OUT[2]=((A B_OR B)==-2) AND ((A B_EXOR B)==-178)
$OUT[3]=((B B_AND -77)==-78) AND ((B B_OR -77)==-5)
END
"""
}


def outputs(files: dict[str, str], target: str | None) -> set[int]:
    """Numbers of the digital outputs that are on at the end, here or in another language."""
    first = read_sources(sources(files), "krl", Diagnostics())
    program, entry = first.program, "CHECKS"
    if target is not None:
        translation = translate_program(first, target, ROBOT)
        assert [item.as_text() for item in translation.losses if item.code.name != "tp-text-case"] == []
        again = Diagnostics()
        back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, again)
        assert not again.of(Severity.ERROR)
        program, entry = with_signal_names(back.program, translation.program), translation.renamed.get(entry, entry)
    result = run_program(program, ROBOT, None, entry)
    assert result.status == "finished", result.fault
    state = {
        name: bool(happening.value)
        for happenings in record_of(result, program).tasks.values()
        for happening in happenings
        if happening.kind == "output"
        for name in happening.names
    }
    return {int(found[1]) for name, on in state.items() if on and (found := re.fullmatch(r"digital_out:(\d+)", name))}


@pytest.mark.parametrize("target", [None, *OTHERS])
@pytest.mark.parametrize(
    "files",
    [STRUCTURES, TOOLS, OWN_TOOLS, TWO_LISTS, WORDS, BITS],
    ids=["struc", "tool", "own", "two", "pass", "bits"],
)
def test_what_holds_here_holds_there(files: dict[str, str], target: str | None) -> None:
    assert outputs(files, target) == {1, 2, 3}


def test_what_the_lists_of_the_machine_declare_is_known_everywhere() -> None:
    assert outputs(MACHINE, None) == {1, 2, 3}
