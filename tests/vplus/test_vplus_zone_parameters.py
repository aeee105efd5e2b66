"""Corners whose size a parameter says: V+ stops there where the caller gives none."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_bytes
from rpl.translation import translate_program

_PROGRAM = """MODULE Zones
  CONST robtarget p:=[[500,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    Corner fine;
    Corner z10;
    MoveL p,v100,z20,tool0;
    MoveL p,v100,fine,tool0;
  ENDPROC
  PROC Corner(zonedata zone)
    MoveL Offs(p,60,0,0),v300,zone,tool0;
    MoveL p,v300,zone,tool0;
  ENDPROC
ENDMODULE
"""


def test_the_program_stops_where_the_size_is_nothing() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_bytes("Zones.mod", _PROGRAM.encode())], "rapid", diagnostics)
    done = translate_program(read, "vplus", None, None, diagnostics)
    assert not list(diagnostics.of(Severity.LOSS))
    lines = [line.strip() for file in done.files for line in file.data.decode("ascii").splitlines()]
    corner = lines[lines.index(next(line for line in lines if line.startswith(".PROGRAM corner"))) :]
    corner = corner[: corner.index(".END")]
    moves = [at for at, line in enumerate(corner) if line.startswith("MOVES")]
    assert len(moves) == 2
    for at in moves:
        assert corner[at + 1].startswith("IF ") and corner[at + 1].endswith("<= 0 THEN")
        assert corner[at + 2 : at + 4] == ["BREAK", "END"]
    assert sum(line.endswith("<= 0 THEN") for line in lines) == 2  # nowhere else
