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
    (("J PR[1:home] 50% FINE",), ["PR[1:home]"]),
    (("PR[1]=LPOS", "J PR[1] 50% FINE"), []),
    (("PR[2]=PR[1]", "PR[2,3]=PR[2,3]+10", "J PR[2] 50% FINE"), ["PR[1]"]),
    (("R[1]=PR[4,2]",), ["PR[4]"]),
    (("PR[4,2]=5", "R[1]=PR[4,2]"), []),
    (("PR[4,2]=5", "J PR[4] 50% FINE"), ["PR[4]"]),
    ((*(f"PR[4,{axis}]=0" for axis in range(1, 7)), "J PR[4] 50% FINE"), []),
    (("PR[1]=PR[1]-PR[1]", "PR[1,3]=50", "L PR[1] 100mm/sec FINE"), []),  # the usual zero
    (("R[1]=1", "J PR[R[1]] 50% FINE"), ["PR[...]"]),
    (("R[1]=1", "PR[2]=LPOS", "J PR[R[1]] 50% FINE"), []),  # some element was set
    (("R[1]=1", "PR[R[1]]=LPOS", "J PR[2] 50% FINE"), []),
]

SEARCH = ("PR[9]=LPOS", "SKIP CONDITION DI[1]=ON", "L PR[9] 20mm/sec FINE Skip,LBL[1],PR[2]=LPOS")


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


@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus"])
def test_at_the_declaration_stands_what_is_to_be_filled_in(target: str) -> None:
    """A zero in a declaration looks like a value; where the numbers are to be read off is said there."""
    program = read("tp", listing("J PR[1:home] 50% FINE", "L PR[1] R[2:speed]mm/sec FINE"))
    text = "\n".join(file.data.decode("latin-1") for file in translate_program(program, target).files)
    assert "fill in: R[2:speed] as on the controller (DATA, Registers)" in text
    assert "fill in: PR[1:home] as on the controller (DATA, Position Registers)" in text


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus"])
def test_position_variables_without_a_value_are_named(target: str) -> None:
    program = read("inform", job("MOVJ P001 VJ=50.00", "MOVL P002 V=100.0"))
    found = Diagnostics()
    written = translate_program(program, target, None, None, found)
    (told,) = [item for item in found.of(Severity.LOSS) if item.code.name == "kept-value-unknown"]
    assert told.message.endswith("read: P001, P002 (line 10)")  # one report for one cause
    assert '"P001" = ..., "P002" = ...' in told.as_text()
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = run_program(back.program, "motoman_gp7")
    assert result.status == "stopped" and not [event for event in result.trace if event.kind == "move"]


def test_known_elements_of_a_list_of_places_are_kept() -> None:
    posreg = """[*POSREG*]$POSREG  Storage: CMOS  Access: RW  : ARRAY[1,100] OF Position Reg
    [1,1] =   'up'   Group: 1   Config: N U T, 0, 0, 0
  X:   400.000   Y:     0.000   Z:   450.000
  W:   180.000   P:     0.000   R:     0.000
"""
    found = Diagnostics()
    program = read("tp", listing("R[1]=1", "J PR[R[1]] 50% FINE"), ("POSREG.VA", posreg))
    text = "\n".join(f.data.decode("latin-1") for f in translate_program(program, "rapid", diagnostics=found).files)
    assert not found.has_losses and "PR{1}:=[[400,0,450]" in text


# lines of a listing, places that nothing sets (a loss), places that may be read before all of them is set (a warning)
PLACES: list[tuple[str, tuple[str, ...], str, str]] = [
    ("never", ("J PR[1] 50% FINE",), "PR[1]", ""),
    ("never-offset", ("PR[1]=LPOS", "L PR[1] 100mm/sec FINE Offset,PR[2]"), "PR[2]", ""),
    ("never-element", ("R[1]=PR[4,2]",), "PR[4]", ""),
    ("never-any", ("R[1]=2", "J PR[R[1]] 50% FINE"), "PR[...]", ""),
    ("another", ("PR[1]=LPOS", "J PR[2] 50% FINE"), "PR[2]", ""),
    ("own-shift", ("PR[1]=PR[2]", "PR[1,3]=PR[1,3]+50", "L PR[1] 100mm/sec FINE"), "PR[2]", ""),
    ("latched", ("PR[1]=LPOS", "J PR[1] 50% FINE"), "", ""),
    ("latched-joints", ("PR[1]=JPOS", "J PR[1] 50% FINE"), "", ""),
    ("zeroed", ("PR[1]=PR[1]-PR[1]", "PR[1,3]=50", "L PR[1] 100mm/sec FINE"), "", ""),
    ("component", ("PR[2,3]=5", "R[1]=PR[2,3]"), "", ""),
    ("all-parts", (*(f"PR[4,{axis}]=0" for axis in range(1, 7)), "J PR[4] 50% FINE"), "", ""),
    ("some-parts", ("PR[4,1]=400", "PR[4,2]=5", "J PR[4] 50% FINE"), "", "PR[4]"),
    ("part-by-number", ("R[2]=3", "PR[R[2],1]=4", "R[3]=PR[3,1]"), "", ""),
    ("parts-in-a-loop", ("FOR R[1]=1 TO 6", "PR[2,R[1]]=0", "ENDFOR", "J PR[2] 50% FINE"), "", "PR[2]"),
    ("parts-by-both", ("R[1]=1", "R[2]=3", "PR[R[1],R[2]]=5", "R[3]=PR[1,3]"), "", "PR[1]"),
    ("whole-in-a-loop", ("FOR R[1]=1 TO 6", "PR[R[1]]=LPOS", "ENDFOR", "J PR[2] 50% FINE"), "", ""),
    ("one-way", ("IF DI[1]=ON,JMP LBL[1]", "PR[2]=LPOS", "LBL[1]", "J PR[2] 50% FINE"), "", "PR[2]"),
    ("too-late", ("J PR[2] 50% FINE", "PR[2]=LPOS"), "", "PR[2]"),
    ("computed-call", ("CALL SR[1]", "J PR[2] 50% FINE"), "SR[1]", "PR[2]"),
    ("unknown-call", ("CALL SOMEWHERE", "J PR[2] 50% FINE"), "", "PR[2]"),
    ("vision", ("VISION GET_OFFSET 'A' VR[1] JMP LBL[1]", "LBL[1]", "J PR[2] 50% FINE"), "", "PR[2]"),
    ("trigger", ("PR[9]=LPOS", "L PR[9] 20mm/sec FINE TB .1sec,PR[3]=LPOS", "J PR[3] 50% FINE"), "", "PR[3]"),
    ("search-found", (*SEARCH, "J PR[2] 50% FINE", "LBL[1]"), "", ""),
    ("search-missed", (*SEARCH, "LBL[1]", "J PR[2] 50% FINE"), "", "PR[2]"),
    ("search-joints", (*(line.replace("LPOS", "JPOS") for line in SEARCH), "J PR[2] 50% FINE", "LBL[1]"), "", ""),
    ("search-unused", (*SEARCH, "LBL[1]"), "", ""),
]


@pytest.mark.parametrize(("lines", "lost", "warned"), [one[1:] for one in PLACES], ids=[one[0] for one in PLACES])
def test_only_a_place_that_nothing_sets_stops_the_program(lines: tuple[str, ...], lost: str, warned: str) -> None:
    found = unset_reads(read("tp", listing(*lines)).program)
    assert " ".join(one.name for one in found if not one.may_be_set) == lost
    assert " ".join(one.name for one in found if one.may_be_set) == warned


# the same in jobs
POSITIONS: list[tuple[str, tuple[str, ...], str, str]] = [
    ("never", ("MOVJ P001 VJ=50.00",), "P001", ""),
    ("never-any", ("SET B001 2", "MOVJ P[B001] VJ=50.00"), "P[...]", ""),
    ("never-element", ("GETE D001 P004 (3)",), "P004", ""),
    ("latched", ("GETS PX001 $PX001", "MOVL P001 V=100.0"), "", ""),
    ("whole", ("GETS PX001 $PX001", "SET P002 P001", "MOVL P002 V=100.0"), "", ""),
    ("component", ("SETE P004 (3) 100", "GETE D001 P004 (3)"), "", ""),
    ("some-parts", ("SETE P004 (3) 100", "MOVL P004 V=100.0"), "", "P004"),
    ("by-number", ("SET B001 2", "GETS PX001 $PX001", "SET P[B001] P001", "MOVL P002 V=100.0"), "", ""),
    ("one-way", ("JUMP *A IF IN#(1)=ON", "GETS PX001 $PX001", "*A", "MOVL P001 V=100.0"), "", "P001"),
    ("unknown-call", ("CALL JOB:SOMEWHERE", "MOVL P001 V=100.0"), "", "P001"),
]


@pytest.mark.parametrize(("lines", "lost", "warned"), [one[1:] for one in POSITIONS], ids=[one[0] for one in POSITIONS])
def test_positions_of_jobs_alike(lines: tuple[str, ...], lost: str, warned: str) -> None:
    found = [one for one in unset_reads(read("inform", job(*lines)).program) if one.name.startswith("P")]
    assert " ".join(one.name for one in found if not one.may_be_set) == lost
    assert " ".join(one.name for one in found if one.may_be_set) == warned


def test_values_that_stand_in_a_job_are_known() -> None:
    name, text = job("SET B001 2", "SET P003 P[B001]", "MOVL P[B001] V=100.0", "MOVL P002 V=100.0", "MOVL P004 V=100.0")
    place = (
        "///POSTYPE ROBOT\n///RECTAN\n///RCONF 1,0,0,0,0,0,0,0\nP00002=400.000,0.000,300.000,180.0000,0.0000,0.0000\n"
    )
    given = name, text.replace("0,0,0,0,0,0\n", f"0,0,0,1,0,0\n{place}", 1)
    assert unset("inform", given) == ["P004"]


def test_what_another_program_or_task_sets_is_no_loss() -> None:
    sets, uses = listing("PR[2]=LPOS", name="SETS"), listing("J PR[2] 50% FINE", name="USES")
    assert unset("tp", listing("CALL SETS", "CALL USES"), sets, uses) == []
    for first in ("RUN SETS", "CALL USES"):
        (one,) = unset_reads(read("tp", listing(first, "CALL USES", "CALL SETS"), sets, uses).program)
        assert one.name == "PR[2]" and one.may_be_set
    (one,) = unset_reads(read("inform", job("MOVJ P001 VJ=50.00"), job("GETS PX001 $PX001", name="SETS")).program)
    assert one.name == "P001" and one.may_be_set


@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus"])
@pytest.mark.parametrize(
    ("lines", "codes"),
    [
        (("J PR[2] 50% FINE",), ["kept-value-unknown"]),
        (("IF DI[1]=ON,JMP LBL[1]", "PR[2]=LPOS", "LBL[1]", "J PR[2] 50% FINE"), ["kept-value-uncertain"]),
        (("PR[2]=LPOS", "J PR[2] 50% FINE"), []),
    ],
)
def test_a_place_that_may_be_set_is_a_warning(target: str, lines: tuple[str, ...], codes: list[str]) -> None:
    found = Diagnostics()
    written = translate_program(read("tp", listing(*lines)), target, None, None, found)
    assert [item.code.name for item in found if item.code.name.startswith("kept-value")] == codes
    text = "\n".join(file.data.decode("latin-1") for file in written.files)
    assert ("set first, as on the controller" in text) == ("kept-value-unknown" in codes)


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
    assert b"PERS num speed:=10; !R2" in written.files[0].data


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
