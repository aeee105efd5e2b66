"""Registers and variables that a controller keeps: read before they are set, they are no zero but a loss with a place
to fill in."""

import pytest

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.kept import report_taken_as_zero, unset_reads
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

TARGETS = ["krl", "rapid", "urscript", "vplus", "inform"]
NUMREG = "[*NUMREG*]$NUMREG  Storage: CMOS  Access: RW  : ARRAY[1,200] OF Numeric Reg\n  [2] = 10  'speed'\n"


def listing(*lines: str, name: str = "MAIN") -> tuple[str, str]:
    body = "\n".join(f"{number:4}:  {line} ;" for number, line in enumerate(lines, 1))
    return f"{name}.LS", f"/PROG {name}\n/MN\n{body}\n/POS\n/END\n"


def job(*lines: str, name: str = "MAIN") -> tuple[str, str]:
    head = f"/JOB\n//NAME {name}\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\n///DATE 2020/01/01 10:00\n///ATTR SC,RW\n"
    return f"{name}.JBI", head + "\n".join(("NOP", *lines, "END")) + "\n"


def read(language: str, *files: tuple[str, str]) -> ReadProgram:
    found = Diagnostics()
    done = read_sources([source_from_text(*file) for file in files], language, found)
    assert not found.has_errors, [item.as_text() for item in found]
    return done


def unset(language: str, *files: tuple[str, str]) -> list[str]:
    return [one.name for one in unset_reads(read(language, *files).program)]


# lines of the program, what is read before it is set
CASES: list[tuple[tuple[str, ...], list[str]]] = [
    (("R[1]=R[2:speed]",), ["R[2:speed]"]),
    (("R[2]=3", "R[1]=R[2]"), []),
    (("R[2]=R[2]+1",), ["R[2]"]),
    (("IF DI[1]=ON,JMP LBL[1]", "R[2]=1", "LBL[1]", "R[1]=R[2]"), ["R[2]"]),
    (("IF DI[1]=ON,JMP LBL[1]", "R[2]=1", "JMP LBL[2]", "LBL[1]", "R[2]=2", "LBL[2]", "R[1]=R[2]"), []),
    (("FOR R[3]=1 TO 4", "R[2]=R[3]", "ENDFOR", "R[1]=R[2]"), []),
    (("R[5]=DI[1]", "FOR R[3]=1 TO R[5]", "R[2]=R[3]", "ENDFOR", "R[1]=R[2]"), ["R[2]"]),
    (("LBL[1]", "R[2]=DI[1]", "IF R[2]=0,JMP LBL[1]"), []),
    (("JMP LBL[2]", "LBL[1]", "R[1]=R[2]", "END", "LBL[2]", "R[2]=1", "JMP LBL[1]"), []),
    (("FOR R[1]=1 TO 9", "R[R[1]]=0", "ENDFOR", "R[20]=R[R[1]]"), []),
    (("R[1]=2", "R[20]=R[R[1]]"), []),  # some element was set
    (("R[R[2]]=1",), ["R[2]"]),
    (("SR[1]=SR[2]",), ["SR[2]"]),
    (("WAIT R[2]=1",), ["R[2]"]),
]


@pytest.mark.parametrize(("lines", "wanted"), CASES, ids=range(len(CASES)))
def test_what_is_read_before_it_is_set(lines: tuple[str, ...], wanted: list[str]) -> None:
    assert unset("tp", listing(*lines)) == wanted


def test_calls_are_followed() -> None:
    sets, uses = listing("R[2]=1", name="SETS"), listing("R[1]=R[2]", name="USES")
    assert unset("tp", listing("CALL SETS", "CALL USES"), sets, uses) == []
    assert unset("tp", listing("CALL USES", "CALL SETS"), sets, uses) == ["R[2]"]
    assert unset("tp", listing("RUN USES", "CALL SETS"), sets, uses) == ["R[2]"]


def test_the_stop_stands_in_the_program_that_nothing_calls() -> None:
    uses = listing("R[1]=R[2]", name="USES")
    (one,) = unset_reads(read("tp", listing("CALL USES"), uses).program)
    assert one.roots == ("MAIN",) and one.origin.line == 3


@pytest.mark.parametrize("target", TARGETS)
def test_it_is_one_loss_by_name_and_a_stop(target: str) -> None:
    program = read("tp", listing("R[1]=R[2:speed]", "R[3]=R[2:speed]", "DO[1]=ON"))
    found = Diagnostics()
    written = translate_program(program, target, None, None, found)
    (loss,) = found.of(Severity.LOSS)
    assert loss.code.name == "kept-value-unknown" and "R[2:speed]" in loss.message and '"R2"' in loss.as_text()
    text = "\n".join(file.data.decode("latin-1") for file in written.files)
    assert "set first, as on the" in text and "R[2:speed]" in text
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, Diagnostics())
    result = run_program(back.program)
    assert (result.status, result.outputs) == ("stopped", ())


@pytest.mark.parametrize("target", TARGETS)
def test_a_dump_or_a_cell_file_gives_the_value(target: str) -> None:
    main = listing("R[1]=R[2:speed]", "DO[1]=(R[1]=10)")
    given = parse_cell("[variables]\nR2 = 10\n").variables
    for program, values in ((read("tp", main, ("NUMREG.VA", NUMREG)), {}), (read("tp", main), given)):
        found = Diagnostics()
        written = translate_program(program, target, None, None, found, given=values)
        assert not found.has_losses, [item.as_text() for item in found]
        sources = [source_from_bytes(file.path, file.data) for file in written.files]
        result = run_program(read_sources(sources, target, Diagnostics()).program)
        assert [value for *_, value in result.outputs] == [True]


def test_targets_that_keep_data_keep_it() -> None:
    written = translate_program(read("tp", listing("R[1]=R[2]"), ("NUMREG.VA", NUMREG)), "rapid")
    assert b"PERS num R2:=10;" in written.files[0].data


def test_a_run_goes_on_from_zero_and_says_so_once() -> None:
    program = read("tp", listing("R[1]=R[2:speed]", "R[3]=R[2:speed]", "DO[1]=(R[1]=0)")).program
    assert [value for *_, value in run_program(program).outputs] == [True]
    found = Diagnostics()
    report_taken_as_zero(program, found)
    assert [item.code.name for item in found] == ["kept-value-zero"]


def test_variables_of_jobs_are_kept_too() -> None:
    assert unset("inform", job("SET B000 D003")) == ["D003"]
    assert unset("inform", job("SET D003 1", "SET B000 D003")) == []
    assert unset("inform", job("SET LB000 LB001")) == []  # local ones begin at zero


SYSFRAME = """[*SYSTEM*]$MNUTOOL  Storage: SHADOW  Access: RW  : ARRAY[1,10] OF POSITION
     [1,1] =
  Group: 1   Config: N D B, 0, 0, 0
  X:     0.000   Y:     0.000   Z:   120.000
  W:     0.000   P:     0.000   R:     0.000
"""


def test_tools_and_frames_are_kept_too() -> None:
    lines = ("UFRAME_NUM=0", "UTOOL_NUM=1", "PR[1]=LPOS", "L PR[1] 100mm/sec FINE")
    assert unset("tp", listing(*lines)) == ["UTOOL[1]"]
    assert unset("tp", listing(*lines), ("SYSFRAME.VA", SYSFRAME)) == []
    assert unset("inform", job("GETS PX001 $PX001", "MOVL P001 V=100.0")) == []  # tool 0
    assert unset("inform", job("CNVRT PX001 PX002 UF#(3)"))[-1] == "UF#(3)"
