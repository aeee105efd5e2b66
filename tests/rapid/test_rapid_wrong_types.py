"""Values of a type that does not fit are told with the function and both types, in RAPID's words."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_program, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes
from rpl.translation import translate_program

ROBOT = "abb_irb1200_5_90"
FRAME = """MODULE M
RECORD item num a; pos b; ENDRECORD
PERS tooldata t:=[TRUE,[[0,0,150],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
CONST robtarget p:=[[460,-70,200],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget far:=[[5460,-70,200],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
VAR robtarget q; VAR pos v; VAR orient o; VAR pose f; VAR item i; VAR num n; VAR jointtarget j;
PROC main()
  BODY
ENDPROC
PROC Change(INOUT pos a) a.x:=1; ENDPROC
FUNC num NumOf(pos a,robtarget b) RETURN a.x; ENDFUNC
ENDMODULE
"""


def errors_of(body: str) -> list[str]:
    diagnostics = Diagnostics()
    text = FRAME.replace("BODY", body)
    read_sources([source_from_bytes("m.mod", text.encode())], "rapid", diagnostics)
    return [item.message for item in diagnostics.of(Severity.ERROR)]


@pytest.mark.parametrize(
    ("body", "messages"),
    [
        ("f:=DefFrame(v,p,p);", ["argument 1 of DefFrame is pos; robtarget is needed"]),
        ("q:=Offs(v,1,2,3);", ["argument 1 of Offs is pos; robtarget is needed"]),
        ("MoveL RelTool(v,1,2,3),v100,fine,t;", ["argument 1 of RelTool is pos; robtarget is needed"]),
        ("IF Distance(p,v)<1 Stop;", ["argument 1 of Distance is robtarget; pos is needed"]),
        ("n:=NumOf(v,i);", ["argument 2 of NumOf is item; robtarget is needed"]),
        ("Change p;", ["argument 1 of Change is robtarget; pos is needed"]),
        ("n:=ClkRead(n);", ["argument 1 of ClkRead is num; clock is needed"]),
        ('n:=Sin("a");', ["argument 1 of Sin is string; num is needed"]),
        ("f:=p;", ["robtarget where pose is needed"]),
        ("f:=PoseMult(p,f);", ["argument 1 of PoseMult is robtarget; pose is needed"]),
        ("v.t:=3;", ["pos has no component t"]),
    ],
)
def test_what_does_not_fit_is_told(body: str, messages: list[str]) -> None:
    assert errors_of(body) == messages


@pytest.mark.parametrize(
    "body",
    [
        r"f:=DefFrame(p,[[1,2,3],p.rot,p.robconf,p.extax],Offs(p,1,2,3)\Origin:=2);",
        "f:=DefFrame([f.trans,[1,0,0,0],[0,0,0,0],p.extax],p,p);",
        "f:=DefDFrame(p,p,q,q,q,p);",
        "o:=o*OrientZYX(10,0,0); v:=v*v; v:=-v*2; v:=PoseVect(f,v); n:=NumOf(i.b,p);",
        r"q:=CRobT(\Tool:=t\WObj:=wobj0); q.rot:=OrientZYX(0,0,1)*q.rot; f:=PoseMult(PoseInv(f),[v,o]);",
    ],
)
def test_what_fits_is_not(body: str) -> None:
    assert errors_of(body) == []


def test_inverse_kinematics_name_what_is_out_of_reach() -> None:
    diagnostics = Diagnostics()
    text = FRAME.replace("BODY", "j:=CalcJointT(far,t);")
    read = read_sources([source_from_bytes("m.mod", text.encode())], "rapid", diagnostics)
    fault = run_program(read.program, ROBOT).fault
    assert fault is not None and "5460.000, -70.000, 200.000 mm (far, tool t, frame wobj0)" in fault.message


def test_a_program_with_errors_is_not_started(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "m.mod"
    program.write_text(FRAME.replace("BODY", "SetDO do1,1; f:=DefFrame(v,v,v);"), "utf-8")
    assert run(["run", str(program)]) == 1
    told = capsys.readouterr()
    assert told.err.count("argument 1 of DefFrame") == 1 and "not started: 3 errors" in told.err
    assert not told.out
    assert run(["run", str(program), "--json"]) == 1
    assert '"code": "program-errors"' in capsys.readouterr().out
    assert run(["run", str(program), "--despite-errors"]) == 1
    told = capsys.readouterr()
    assert "do1 = TRUE" in told.out and "tuple" not in told.err


def test_the_cell_file_of_a_project_is_not_told_as_a_stranger(tmp_path: Path) -> None:
    (tmp_path / "m.mod").write_text(FRAME.replace("BODY", ""), "utf-8")
    (tmp_path / "cell.toml").write_text('[[input]]\ntime = 1.0\nsignal = "di1"\nvalue = true\n', "utf-8")
    (tmp_path / "other.toml").write_text("[tool]\nname = 1\n", "utf-8")
    diagnostics = Diagnostics()
    read_program([tmp_path], diagnostics=diagnostics)
    assert [Path(item.origin.file).name for item in diagnostics] == ["other.toml"]


def test_a_pose_is_moved_by_a_product() -> None:
    """Offs and RelTool take robtargets."""
    source = """.PROGRAM main()
SET a = TRANS(100,20,30,0,180,0)
SET b = SHIFT(a BY 0,0,-60)
IF ABS(DZ(b)+30) < 0.01 THEN
SIGNAL 1
END
.END
"""
    diagnostics = Diagnostics()
    read = read_sources([source_from_bytes("m.v2", source.encode())], "vplus", diagnostics)
    done = translate_program(read, "rapid", None, None, diagnostics)
    written = "\n".join(file.data.decode() for file in done.files)
    assert "PoseMult([[0,0,-60],[1,0,0,0]],a)" in written, written
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], "rapid", diagnostics)
    assert not diagnostics.has_errors
    assert [name for _, name, _ in run_program(back.program, ROBOT).outputs] == ["do1"]
