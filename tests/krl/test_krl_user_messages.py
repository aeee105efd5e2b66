"""User messages of KSS 8 (SET_KRLMSG, SET_KRLDLG and what asks for them): on the arm, and in targets with texts."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl.cell import read_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

HEAD = """DECL KRLMSG_T MSG
DECL KRLMSGPAR_T PAR[3]
DECL KRLMSGOPT_T OPT
DECL KRLMSGDLGSK_T KEYS[7]
DECL INT H,ANSWER
MSG={MODUL[] "CELL",NR 1,MSG_TXT[] "Which job?"}
OPT={VL_STOP TRUE,CLEAR_P_RESET TRUE,CLEAR_P_SAW FALSE,LOG_TO_DB FALSE}
"""
STATE = """H=SET_KRLMSG(#STATE,MSG,PAR[],OPT)
IF EXISTS_KRLMSG(H) THEN
  $OUT[1]=TRUE
ENDIF
IF CLEAR_KRLMSG(H) THEN
  IF NOT EXISTS_KRLMSG(H) THEN
    $OUT[2]=TRUE
  ENDIF
ENDIF
"""
QUIT = """H=SET_KRLMSG(#QUIT,MSG,PAR[],OPT)
WHILE EXISTS_KRLMSG(H)
  WAIT SEC 0.1
ENDWHILE
$OUT[1]=TRUE
"""
KEYS = "".join(f"KEYS[{n}]={{SK_TYPE #EMPTY}}\n" for n in range(3, 8))
DIALOG = f"""KEYS[1]={{SK_TYPE #VALUE,SK_TXT[] "small"}}
KEYS[2]={{SK_TYPE #VALUE,SK_TXT[] "big"}}
{KEYS}ANSWER=0
H=SET_KRLDLG(MSG,PAR[],KEYS[],OPT)
IF H>0 THEN
  WHILE EXISTS_KRLDLG(H,ANSWER)
    WAIT SEC 0.1
  ENDWHILE
ENDIF
IF ANSWER==2 THEN
  $OUT[1]=TRUE
ENDIF
"""
CELL = """[[answer]]
text = "Which job?"
answer = 2
[[answer]]
text = "Acknowledge the message"
answer = 1
"""


def read(lines: str, more: str = "") -> ReadProgram:
    diagnostics = Diagnostics()
    text = f"DEF CHECKS( )\n{HEAD}{more}{lines}END\n"
    done = read_sources([source_from_text("checks.src", text)], "krl", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return done


@pytest.mark.parametrize(("lines", "count"), [(STATE, 2), (QUIT, 1), (DIALOG, 1)], ids=["state", "quit", "dialog"])
def test_on_the_arm(lines: str, count: int, tmp_path: Path) -> None:
    (tmp_path / "cell.toml").write_text(CELL)
    result = run_program(read(lines).program, None, read_cell(str(tmp_path / "cell.toml")))
    assert (result.status, result.fault) == ("finished", None)
    assert {name for _, name, on in result.outputs if on} == {f"$OUT[{n}]" for n in range(1, count + 1)}


@pytest.mark.parametrize("target", ["rapid", "urscript", "rpl", "krl"])
def test_messages_in_other_languages(target: str) -> None:
    diagnostics = Diagnostics()
    done = translate_program(read(STATE), target, None, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    again = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    result = run_program(again.program, None)
    assert result.status == "finished" and len([1 for _, _, on in result.outputs if on]) == 2


def test_parameters_are_reported() -> None:
    diagnostics = Diagnostics()
    lines = "PAR[1]={PAR_TYPE #VALUE,PAR_INT 3}"
    read_sources([source_from_text("p.src", f"DEF P( )\n{HEAD}{lines}\nEND\n")], "krl", diagnostics)
    assert [item.code.name for item in diagnostics] == ["krl-message-parameters"]


OLD_DATA = """DEFDAT CHECKS
DECL LDAT LCP={VEL 2.0,ACC 100.0,APO_DIST 20.0,APO_FAC 50.0,ORI_TYP #VAR}
DECL FDAT F={TOOL_NO 3,BASE_NO 0,IPO_FRAME #BASE}
ENDDAT
"""


def test_path_data_of_older_systems_and_the_tool_in_use() -> None:
    text = "DEF CHECKS( )\nBAS(#INITMOV,0)\nLDAT_ACT=LCP\nFDAT_ACT=F\nBAS(#CP_PARAMS,0.5)\n$OUT[1]=$ACT_TOOL==3\nEND\n"
    files = [source_from_text("checks.src", text), source_from_text("checks.dat", OLD_DATA)]
    result = run_program(read_sources(files, "krl", Diagnostics()).program, "kuka_kr6r900sixx")
    assert result.status == "finished" and [name for _, name, on in result.outputs if on] == ["$OUT[1]"]


def test_at_home() -> None:
    text = "DEF P( )\nBAS(#INITMOV,0)\nPTP {A1 20}\nWAIT SEC 0\n$OUT[1]=NOT $IN_HOME\nPTP $H_POS\nWAIT SEC 0\n"
    files = [source_from_text("p.src", f"{text}$OUT[2]=$IN_HOME\nEND\n")]
    result = run_program(read_sources(files, "krl", Diagnostics()).program, "kuka_kr6r900sixx")
    assert [name for _, name, on in result.outputs if on] == ["$OUT[1]", "$OUT[2]"]
