"""Data that begins anew at each start of the program does so in KRL too, whose data lists keep the last values."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr6r900sixx"
RAPID = """MODULE k
  VAR num count:=5;
  PERS num kept:=7;
  VAR bool seen;
  VAR num list{3}:=[1,2,3];
  PROC main()
    IF count=5 SetDO do1,1;
    IF kept=7 SetDO do2,1;
    IF NOT seen SetDO do3,1;
    IF list{2}=2 SetDO do4,1;
    count:=count+1; kept:=kept+1; seen:=TRUE; list{2}:=9;
  ENDPROC
ENDMODULE
"""


def lists_of(files: dict[str, str]) -> dict[str, str]:
    """The data lists, as the run before has left them."""
    left = {"count=5": "count=6", "kept=7": "kept=8", "seen=FALSE": "seen=TRUE", "list[2]=2": "list[2]=9"}
    for name in [one for one in files if one.endswith(".dat")]:
        for first, last in left.items():
            files[name] = files[name].replace(first, last)
    return files


@pytest.mark.parametrize("lines", [1, 9])
def test_only_what_the_source_keeps_is_as_the_last_run_left_it(lines: int) -> None:
    more = "".join(f"  VAR num more{at}:={at};\n" for at in range(lines))
    used = "".join(f" more{at}:=more{at}+1;" for at in range(lines))
    text = RAPID.replace("  PROC main", f"{more}  PROC main").replace("    count:=", f"    {used}count:=")
    read = read_sources([source_from_text("k.mod", text)], "rapid", Diagnostics())
    translation = translate_program(read, "krl", ARM, None, Diagnostics())
    files = lists_of({one.path: one.data.decode() for one in translation.files})
    back = read_sources([source_from_bytes(name, one.encode()) for name, one in files.items()], "krl", Diagnostics())
    result = run_program(back.program, ARM, None, translation.renamed.get("main", "main"))
    assert result.status == "finished", result.fault
    assert [signal for _, signal, value in result.outputs if value] == ["$OUT[1]", "$OUT[3]", "$OUT[4]"]


# Data of a module, what `main` does and what other routines there are; is `n` set where the program starts?
BEGINS = [
    ("VAR num n:=5;", "n:=0; n:=n+1; SetGO go1,n;", "", False),
    ("VAR num n:=5;", "n:=n+1; SetGO go1,n;", "", True),
    ("VAR num n:=5;", "SetGO go1,n;", "", False),
    ("VAR num n{2}:=[1,2];", "SetGO go1,n{2};", "", False),
    ("VAR num n{2}:=[1,2];", "n{1}:=3; SetGO go1,n{2};", "", True),
    ("VAR num n:=5;", "IF DInput(di1)=1 n:=1; SetGO go1,n;", "", True),
    ("VAR num n:=5;", "IF DInput(di1)=1 THEN n:=1; ELSE n:=2; ENDIF SetGO go1,n;", "", False),
    ("VAR num n:=5;", "begin; SetGO go1,n;", "PROC begin() n:=1; ENDPROC", False),
    ("VAR num n:=5;", "begin; SetGO go1,n;", "PROC begin() IF DInput(di1)=1 RETURN; n:=1; ENDPROC", True),
    ("VAR num n:=5;", "begin; SetGO go1,n;", "PROC begin() VAR num n; n:=1; SetGO go1,n; ENDPROC", True),
    ("VAR num n:=5;", "look; n:=1; look;", "PROC look() SetGO go1,n; ENDPROC", True),
    ("VAR num n:=5;", "SetGO go1,twice(); n:=1; n:=n+1;", "FUNC num twice() RETURN 2*n; ENDFUNC", True),
    (
        "VAR num n:=5; VAR intnum i;",
        "CONNECT i WITH t; ISignalDI di1,1,i; n:=1; WaitTime 1;",
        "TRAP t SetGO go1,n; ENDTRAP",
        True,
    ),
    (
        "VAR num n:=5; VAR intnum i;",
        "n:=1; CONNECT i WITH t; ISignalDI di1,1,i; WaitTime 1;",
        "TRAP t SetGO go1,n; ENDTRAP",
        False,
    ),
    (
        "VAR num n:=5; VAR bool up:=FALSE;",
        "up:=FALSE; look; IF up SetGO go1,n;",
        "PROC look() IF DInput(di1)=1 THEN n:=1; up:=TRUE; ENDIF ENDPROC",
        False,
    ),
    (
        "VAR num n:=5; VAR bool up:=FALSE;",
        "up:=FALSE; look; IF up SetGO go1,n;",
        "PROC look() IF DInput(di1)=1 THEN up:=TRUE; n:=1; RETURN; ENDIF up:=TRUE; ENDPROC",
        True,
    ),
]


@pytest.mark.parametrize(("data", "main", "more", "begins"), BEGINS)
def test_what_the_program_sets_before_it_looks_at_it_is_not_set_at_the_start(
    data: str, main: str, more: str, begins: bool
) -> None:
    text = f"MODULE k\n  {data}\n  PROC main()\n    {main}\n  ENDPROC\n  {more}\nENDMODULE\n"
    read = read_sources([source_from_text("k.mod", text)], "rapid", Diagnostics())
    translation = translate_program(read, "krl", ARM, None, Diagnostics())
    written = "".join(one.data.decode() for one in translation.files if one.path.endswith(".src"))
    assert bool({"n=5", "n[1]=1"} & set(written.splitlines())) == begins, written
