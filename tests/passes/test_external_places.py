"""External axes that a place leaves out stay where they are, also in languages whose places name all of them."""

import pytest

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import ProofResult, prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr10r1420"
CELL = parse_cell(
    """
[[mechanism]]
name = "rail"
kind = "track"
axes = [{ number = 1, direction = "y", speed = 1000 }]
"""
)
HEAD = "DEF a( )\nINT I\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0,E1 100}\n"
PLACE = "X 650,Y 300,Z 600,A 180,B 0,C 180"


def translated(body: str, target: str) -> tuple[ProofResult, list[str], str]:
    read = read_sources([source_from_text("a.src", f"{HEAD}{body}\nEND\n")], "krl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, ARM, None, diagnostics)
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, Diagnostics())
    result = prove_programs(
        read.program, back.program, ARM, ARM, CELL, entry="a", to_entry=written.renamed.get("a", "a")
    )
    told = [item.code.name for item in diagnostics if item.severity.word == "loss"]
    return result, told, "\n".join(file.data.decode("utf-8", "replace") for file in written.files)


KNOWN = {
    "a line behind a joint move": f"LIN {{{PLACE}}}\n$OUT[1]=TRUE",
    "two moves later": f"LIN {{{PLACE},E1 300}}\nLIN {{X 650,Y 310,Z 600,A 180,B 0,C 180}}\n$OUT[1]=TRUE",
    "joints": "PTP {A1 5,A2 -90,A3 90,A4 0,A5 90,A6 0}\n$OUT[1]=TRUE",
    "in a choice": f"IF $IN[1]==FALSE THEN\nLIN {{{PLACE}}}\nENDIF\n$OUT[1]=TRUE",
    "behind a frame": f"$BASE={{X 0,Y 10,Z 0,A 0,B 0,C 0}}\nLIN {{{PLACE}}}\n$OUT[1]=TRUE",
    "in a loop that moves nothing else": f"FOR I=1 TO 2\n$OUT[I]=TRUE\nENDFOR\nLIN {{{PLACE}}}",
}


@pytest.mark.parametrize("body", KNOWN.values(), ids=KNOWN.keys())
@pytest.mark.parametrize("target", ["rapid", "tp"])
def test_where_it_is_known_it_is_written(body: str, target: str) -> None:
    result, told, _ = translated(body, target)
    assert result.agrees, result.as_text()
    assert not told


def test_krl_leaves_it_out_as_well() -> None:
    result, told, text = translated(KNOWN["two moves later"], "krl")
    assert result.agrees and not told
    assert text.count("E1") == 2


UNKNOWN = {
    "behind a computed axis": f"LIN {{{PLACE},E1 100.0*$OV_PRO}}\nLIN {{X 650,Y 310,Z 600,A 180,B 0,C 180}}",
    "in a loop": f"FOR I=1 TO 2\nLIN {{{PLACE}}}\nLIN {{X 650,Y 310,Z 600,A 180,B 0,C 180,E1 200}}\nENDFOR",
}


@pytest.mark.parametrize("body", UNKNOWN.values(), ids=UNKNOWN.keys())
@pytest.mark.parametrize("target", ["rapid", "tp"])
def test_where_it_is_not_known_the_loss_has_a_name(body: str, target: str) -> None:
    _, told, _ = translated(body, target)
    assert "external-axis-left-out" in told
