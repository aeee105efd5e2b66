"""Programs that are chosen by a text stay in one script, where they share the variables."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "fanuc_lrmate200id"


def listing(name: str, *lines: str) -> str:
    numbered = "\n".join(f"{number:4}:  {line} ;" for number, line in enumerate(lines, 1))
    return f"/PROG  {name}\n/ATTR\n/MN\n{numbered}\n/POS\n/END\n"


CHOICE = ("SR[1]='ADD'", "SR[2]='TEN'", "SR[1]=SR[1]+SR[2]", "R[1]=5")
NUMREG = "[*NUMREG*]$NUMREG  Storage: CMOS  Access: RW  : ARRAY[1,200] OF Numeric Reg\n  [1] = 0  ''\n"
ADDTEN = ("R[1]=R[1]+10",)


def scripts(files: dict[str, tuple[str, ...]], entry: str = "") -> dict[str, str]:
    """The scripts; with a name of the program to start, after checking that they do what the programs do."""
    sources = [source_from_text(f"{name}.ls", listing(name, *lines)) for name, lines in files.items()]
    sources.append(source_from_text("NUMREG.VA", NUMREG))
    diagnostics = Diagnostics()
    program = read_sources(sources, "tp", diagnostics)
    written = translate_program(program, "urscript", ROBOT, diagnostics=diagnostics)
    assert not [item.as_text() for item in diagnostics if item.severity >= Severity.LOSS]
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], "urscript", diagnostics)
    if entry:
        named = with_signal_names(back.program, written.program)
        proof = prove_programs(program.program, named, ROBOT, entry=entry, to_entry=written.renamed.get(entry, entry))
        assert proof.agrees, proof.as_text()
    return {file.path: file.data.decode() for file in written.files}


def test_the_program_that_chooses_is_the_script() -> None:
    files = {"ADDTEN": ADDTEN, "START": (*CHOICE, "CALL SR[1]", "DO[1]=(R[1]=15)")}
    assert list(scripts(files, "START")) == ["start.script"]


def test_the_program_that_leads_to_the_choice_is_the_script() -> None:
    files = {
        "ADDTEN": ADDTEN,
        "CHOOSE": (*CHOICE, "CALL SR[1]"),
        "START": ("CALL CHOOSE", "DO[1]=(R[1]=15)"),
    }
    assert list(scripts(files, "START")) == ["start.script"]


def test_scripts_bring_what_they_call_along() -> None:
    files = {
        "ADDTEN": (*ADDTEN, "IF R[1]>99,CALL TWICE"),
        "TWICE": ("R[1]=R[1]*2", "IF R[1]>99,CALL ADDTEN"),
    }
    found = scripts(files)
    assert all("def addten()" in text and "def twice()" in text for text in found.values())
