"""Places with an axis beyond 180 degrees: V+ goes to the joints, its locations do not tell the turn."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """/PROG  TURN
/ATTR
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  UFRAME_NUM=0 ;
   2:J P[1] 100%% FINE ;
/POS
P[1]{
   GP1:
	UF : 0, UT : 1,	CONFIG : 'N U T, 0, 0, %d',
	X = 420.0  mm,	Y = 50.0  mm,	Z = 20.000  mm,
	W = 180.000 deg,	P = 0.000 deg,	R = -150.000 deg
};
/END
"""


@pytest.mark.parametrize("target", ["rapid", "krl", "urscript", "vplus", "inform", "rpl"])
@pytest.mark.parametrize("turn", [0, 1])
def test_a_turn_that_a_location_loses_is_written_as_joints(target: str, turn: int) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("TURN.LS", PROGRAM % turn)], "tp", diagnostics)
    done = translate_program(read, target, "fanuc_lrmate200id", None, diagnostics)
    text = "\n".join(file.data.decode("latin-1") for file in done.files)
    assert ("MOVE #PPOINT(" in text) == (turn == 1 and target == "vplus")
    assert "turn-not-told" not in [item.code.name for item in diagnostics]
