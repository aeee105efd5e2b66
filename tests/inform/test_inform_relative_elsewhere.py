"""IMOV with a tool and in a user frame, from where the robot was asked to be, in every language."""

from __future__ import annotations

import pytest
from inform_helpers import job

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "motoman_gp7"
JOB = job(
    """
SETTOOL TL#(1) P004
MFRAME UF#(1) P000 P001 P002
MOVJ C00000 VJ=50.00 PL=0
CALL JOB:NOTHING
SETE P005 (1) 30000
SETE P005 (2) 20000
SETE P005 (3) -40000
IMOV P005 V=100.0 UF#(1) PL=0
IMOV P005 V=100.0 TF PL=0
""",
    """
///TOOL 1
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=440.000,0.000,300.000,180.0000,0.0000,0.0000
P00005=0.000,0.000,0.000,0.0000,0.0000,0.0000
///TOOL 0
P00000=400.000,50.000,300.000,180.0000,0.0000,0.0000
P00001=400.000,100.000,300.000,180.0000,0.0000,0.0000
P00002=300.000,50.000,300.000,180.0000,0.0000,0.0000
P00004=0.000,0.000,100.000,0.0000,0.0000,0.0000
""",
)


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl"])
def test_the_way_is_counted_from_the_tool_in_the_frame(target: str) -> None:
    texts = {"TEST.JBI": JOB, "NOTHING.JBI": job("NOP", name="NOTHING")}
    read = read_sources([source_from_text(name, text) for name, text in texts.items()], "inform", Diagnostics())
    diagnostics = Diagnostics()
    translation = translate_program(read, target, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    ours = run_program(read.program, ARM, None, "TEST")
    theirs = run_program(back.program, ARM, None, translation.renamed.get("TEST", "TEST"))
    assert ours.status == theirs.status == "finished", theirs.fault
    assert ours.joints is not None and theirs.joints == pytest.approx(ours.joints, abs=0.01)


# A way whose turn is not known beforehand, behind a move in a user frame; the way itself is in the base frame.
BEHIND_A_FRAME = job(
    """
MFRAME UF#(1) P000 P001 P002
MOVJ C00000 VJ=50.00 PL=0
CALL JOB:NOTHING
GETS PX005 $PX001
SETE P005 (1) 30000
SETE P005 (2) 20000
SETE P005 (3) -40000
SETE P005 (4) 0
SETE P005 (5) 0
SETE P005 (6) 100000
IMOV P005 V=100.0 BF PL=0
""",
    """
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
P00000=400.000,50.000,300.000,180.0000,0.0000,0.0000
P00001=400.000,100.000,300.000,180.0000,0.0000,0.0000
P00002=300.000,50.000,300.000,180.0000,0.0000,0.0000
///USER 1
///POSTYPE USER
C00000=20.000,10.000,30.000,180.0000,0.0000,0.0000
""",
)


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl"])
def test_a_way_in_the_base_frame_behind_a_move_in_a_user_frame(target: str) -> None:
    texts = {"TEST.JBI": BEHIND_A_FRAME, "NOTHING.JBI": job("NOP", name="NOTHING")}
    read = read_sources([source_from_text(name, text) for name, text in texts.items()], "inform", Diagnostics())
    diagnostics = Diagnostics()
    translation = translate_program(read, target, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [one.as_text() for one in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    ours = run_program(read.program, ARM, None, "TEST")
    theirs = run_program(back.program, ARM, None, translation.renamed.get("TEST", "TEST"))
    assert ours.status == theirs.status == "finished", theirs.fault
    assert ours.joints is not None and theirs.joints == pytest.approx(ours.joints, abs=0.01)
