"""What a bank that is chosen by number starts with stands in the program that sets the other values, too."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

HEAD = "/JOB\n//NAME SUMS\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\n///DATE 2025/05/14 10:22\n///ATTR SC,RW\n///GROUP1 RB1\n"
FURTHER = "".join(f"INC I{number:03d}\n" for number in range(10, 22))
JOB = f"{HEAD}NOP\nSET D003 5\nFOR I000 = 0 TO 5\nADD D007 D[I000]\nNEXT I000\n{FURTHER}DOUT OT#(1) ON\nEND\n"
ZEROS = "0,0,0,0,0,0,0,0,0,0\n" * 10
KEPT = f"//VAR\n///I\n{ZEROS}///D\n{ZEROS}"


def test_the_program_itself_begins_with_its_steps() -> None:
    files = [source_from_text("SUMS.JBI", JOB), source_from_text("VAR.DAT", KEPT)]
    read = read_sources(files, "inform", Diagnostics())
    done = translate_program(read, "tp", None, None, Diagnostics())
    texts = {file.path.rsplit("/", 1)[-1]: file.data.decode() for file in done.files}
    assert "D8]=0" not in texts["SUMS.LS"]
    assert "CALL RPL_INITIALISE" in texts["SUMS.LS"]
    assert "D8]=0" in texts["RPL_INITIALISE.LS"]
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], "tp", Diagnostics())
    result = run_program(back.program, entry="SUMS")
    assert result.status == "finished"
