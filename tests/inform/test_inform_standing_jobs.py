"""Jobs that ask where the tool is and do not drive: they carry the tool of the moves."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr6r900sixx"
KRL = """DEF MAIN()
DECL POS P
$TOOL={{X 0,Y 0,Z 120,A 0,B 0,C 0}}
$BASE={{X 400,Y 0,Z 200,A 0,B 0,C 0}}
$VEL.CP=0.2
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}}
PTP {{X 80,Y 60,Z 100,A 0,B 180,C 0,S 2,T 35}}
P=$POS_ACT
{more}
LOOK()
END
DEF LOOK()
DECL POS NOW
NOW=$POS_ACT
$OUT[1]=(ABS(NOW.Z-{z})<0.1) AND (ABS(NOW.X-80)<0.1)
END
"""
OTHER = "$TOOL={{X 0,Y 0,Z 80,A 0,B 0,C 0}}\nLIN {{X 80,Y 60,Z 130,A 0,B 180,C 0}}"


def codes(more: str, z: int) -> set[str]:
    """The codes of the reports; the place is the same in both programs."""
    read = read_sources([source_from_text("MAIN.src", KRL.format(more=more, z=z))], "krl", Diagnostics())
    diagnostics = Diagnostics()
    files = translate_program(read, "inform", ARM, None, diagnostics).files
    back = read_sources([source_from_bytes(f.path, f.data) for f in files], "inform", Diagnostics())
    if not more:
        result = prove_programs(read.program, back.program, ARM, None, entry="MAIN", to_entry="MAIN")
        assert result.agrees, result.as_text()
        assert "///TOOL 1" in next(f.data.decode() for f in files if f.path.startswith("LOOK"))
    return {item.code.name for item in diagnostics}


def test_a_job_that_only_looks_has_the_tool_of_the_moves() -> None:
    assert "inform-tool-of-place" not in codes("", 100)


def test_several_tools_are_told() -> None:
    assert "inform-tool-of-place" in codes(OTHER.replace("{{", "{").replace("}}", "}"), 130)
