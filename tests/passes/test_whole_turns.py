"""The three angles of a place set at once, for targets that put each angle together with the two others."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.record import signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "abb_irb1200_5_90"
# The tool points up at first; about its new Y by 90 degrees the first and the last angle turn about one axis.
UP = "VAR robtarget p:=[[20,30,40],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"
SEEN = "p:=RelTool(p,0,0,0\\Ry:=-30);\n"
SEEN += "IF Distance(PoseVect([[0,0,0],p.rot],[1,2,3]),[{}])<0.01 AND p.trans.x=20 SetDO do1,1;"
CASES = {
    "constant": ("p.rot:=OrientZYX(0,90,0);", "3.098,2,0.634"),
    "computed": ("n:=90;\np.rot:=OrientZYX(0,n,0);", "3.098,2,0.634"),
    "in a branch": ("IF n=0 THEN\np.rot:=OrientZYX(90,90,0);\nENDIF", "-2,3.098,0.634"),
    "of the place itself": ("p.rot:=OrientZYX(0,EulerZYX(\\Y,p.rot)+90,0);", "3.098,2,0.634"),
}


@pytest.mark.parametrize("target", ["urscript", "vplus", "krl"])
@pytest.mark.parametrize("name", CASES)
def test_rotation_at_its_limit(name: str, target: str) -> None:
    steps, seen = CASES[name]
    text = f"MODULE a\nPROC main()\n{UP}\nVAR num n:=0;\n{steps}\n{SEEN.format(seen)}\nENDPROC\nENDMODULE\n"
    read = read_sources([source_from_text("a.mod", text)], "rapid", Diagnostics())
    files = translate_program(read, target, ARM, None, Diagnostics()).files
    back = read_sources([source_from_bytes(file.path, file.data) for file in files], target, Diagnostics())
    result = run_program(back.program, ARM, None, back.program.entry or "main", 10.0)
    assert result.status == "finished", result.fault
    outputs = [
        signal_names(one.port[0], one.names, *one.port[1:3])
        for one in result.trace
        if one.kind == "output" and one.port
    ]
    assert any("digital_out:1" in keys for keys in outputs)
