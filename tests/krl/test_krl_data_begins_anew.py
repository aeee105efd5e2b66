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
