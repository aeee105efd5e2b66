"""A tool that one file sets by a name of its own is the same tool in the moves of another file: there the name may mean
nothing, or something else."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
MAIN = """DEF BEND( )
DECL E6POS NOW
BAS(#INITMOV,0)
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
$BASE = TABLE
$TOOL = GRIP
REACH( )
NOW = $POS_ACT
$OUT[1] = (ABS(NOW.X - 20.0) < 0.1) AND (ABS(NOW.Z - 40.0) < 0.1)
$TOOL = $NULLFRAME
NOW = $POS_ACT
$OUT[2] = (ABS(NOW.X - 20.0) < 0.1) AND (ABS(NOW.Z - 160.0) < 0.1)
$TOOL = GRIP
OTHER( )
NOW = $POS_ACT
$OUT[3] = (ABS(NOW.X - 30.0) < 0.1) AND (ABS(NOW.Z - 60.0) < 0.1)
LIN {X 20.0,Y 0.0,Z 60.0,A 0.0,B 180.0,C 0.0}
$TOOL = $NULLFRAME
NOW = $POS_ACT
$OUT[4] = ABS(NOW.Z - 110.0) < 0.1
END
"""
DATA = """DEFDAT BEND PUBLIC
DECL FRAME GRIP={X 0.0,Y 0.0,Z 120.0,A 0.0,B 0.0,C 0.0}
DECL FRAME TABLE={X 450.0,Y 0.0,Z 200.0,A 0.0,B 0.0,C 0.0}
ENDDAT
"""
LIBRARY = """DEF LIBRARY( )
END
GLOBAL DEF REACH( )
LIN {X 20.0,Y 0.0,Z 40.0,A 0.0,B 180.0,C 0.0}
END
GLOBAL DEF OTHER( )
LIN {X 40.0,Y 0.0,Z 60.0,A 0.0,B 180.0,C 0.0}
$TOOL = GRIP
LIN {X 30.0,Y 0.0,Z 60.0,A 0.0,B 180.0,C 0.0}
END
"""
LIBRARY_DATA = "DEFDAT LIBRARY PUBLIC\nDECL FRAME GRIP={X 0.0,Y 0.0,Z 50.0,A 0.0,B 0.0,C 0.0}\nENDDAT\n"


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "vplus", "inform", "urscript", "rpl"])
@pytest.mark.parametrize("own", [True, False], ids=["the same name there", "no such name there"])
def test_a_private_tool_in_the_moves_of_another_file(target: str, own: bool) -> None:
    library = LIBRARY if own else LIBRARY.replace("$TOOL = GRIP", "$TOOL = {X 0.0,Y 0.0,Z 50.0,A 0.0,B 0.0,C 0.0}")
    texts = {"bend.src": MAIN, "bend.dat": DATA, "library.src": library}
    if own:
        texts["library.dat"] = LIBRARY_DATA
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(name, text) for name, text in texts.items()], "krl", diagnostics)
    assert run_program(read.program, ROBOT, entry="BEND").fault is None
    written = translate_program(read, target, ROBOT, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    files = [source_from_bytes(one.path, one.data) for one in written.files]
    back = read_sources(files, target, Diagnostics()).program
    result = run_program(back, ROBOT, entry=back.entry or written.renamed.get("BEND", "BEND"))
    assert result.fault is None
    assert [state for _, _, state in result.outputs] == [True] * 4, result.outputs
