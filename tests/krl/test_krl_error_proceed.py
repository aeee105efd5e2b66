"""ON_ERROR_PROCEED: an error of the next statement does not stop the program; $ERR has its number until ERR_CLEAR."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl import read
from rpl.simulation import run_program


def outputs(tmp_path: Path, body: str) -> tuple[str, list[str]]:
    """How it ends, and the outputs that are set."""
    (tmp_path / "main.src").write_text(f"DEF main()\nDECL INT n,m,list[2]\n{body}\nEND\n")
    result = run_program(read([tmp_path]).program, entry="main")
    return result.status, [name for _, name, value in result.outputs if value]


@pytest.mark.parametrize(
    ("body", "status", "wanted"),
    [
        ("ON_ERROR_PROCEED\nn=m\nIF $ERR.NUMBER<>0 THEN\n$OUT[1]=TRUE\nENDIF", "finished", ["$OUT[1]"]),
        ("m=1\nON_ERROR_PROCEED\nn=m\nIF $ERR.NUMBER<>0 THEN\n$OUT[1]=TRUE\nENDIF", "finished", []),
        ("ON_ERROR_PROCEED\nn=m\nERR_CLEAR($ERR)\n$OUT[1]=$ERR.NUMBER==0", "finished", ["$OUT[1]"]),
        ("ON_ERROR_PROCEED\nlist[3]=1\n$OUT[1]=$ERR.NUMBER<>0", "finished", ["$OUT[1]"]),
        ("ON_ERROR_PROCEED\n$OUT[1]=TRUE\nn=m\n$OUT[2]=TRUE", "fault", ["$OUT[1]"]),  # the next statement alone
        ("ON_ERROR_PROCEED\nn=m\nn=m\n$OUT[2]=TRUE", "fault", []),
        ("ON_ERROR_PROCEED\naway()\n$OUT[1]=TRUE", "fault", []),  # nothing says what that routine does
        ("ON_ERROR_PROCEED\nWAIT FOR TODO TODO\n$OUT[1]=TRUE", "fault", []),
    ],
)
def test_the_next_statement_is_passed_over(tmp_path: Path, body: str, status: str, wanted: list[str]) -> None:
    assert outputs(tmp_path, body) == (status, wanted)


def test_machine_data_of_the_project_is_read(tmp_path: Path) -> None:
    """`$VEL_MA.CP` has the value that $machine.dat gives; without that list only the controller has it."""
    (tmp_path / "$machine.dat").write_text(
        "DEFDAT $MACHINE PUBLIC\nDECL CP $VEL_MA={CP 3.5,ORI1 400.0,ORI2 400.0}\nENDDAT\n"
    )
    assert outputs(tmp_path, "$OUT[1]=$VEL_MA.CP==3.5") == ("finished", ["$OUT[1]"])
    (tmp_path / "$machine.dat").unlink()
    assert outputs(tmp_path, "$OUT[1]=$VEL_MA.CP==3.5") == ("fault", [])


def test_an_argument_that_is_left_out_can_be_filled(tmp_path: Path) -> None:
    """As KUKA's MsgLib does: options that a caller leaves out get their defaults, and texts have no length."""
    (tmp_path / "main.src").write_text(
        "DEF main()\nnote(1)\nEND\nDEF note(n :IN, options :IN, text[] :IN)\nDECL INT n\nDECL OPTION_T options\n"
        "DECL CHAR text[]\nON_ERROR_PROCEED\nn=options.level\n"
        "IF $ERR.NUMBER<>0 THEN\noptions.level=4\nERR_CLEAR($ERR)\nENDIF\n"
        "$OUT[1]=(options.level==4) AND (STRLEN(text[])==0) AND ($ERR.NUMBER==0)\nEND\n"
    )
    (tmp_path / "$config.dat").write_text("DEFDAT $CONFIG PUBLIC\nGLOBAL STRUC OPTION_T INT level\nENDDAT\n")
    result = run_program(read([tmp_path]).program, entry="main")
    assert result.status == "finished" and result.outputs == ((0.0, "$OUT[1]", True),), result
