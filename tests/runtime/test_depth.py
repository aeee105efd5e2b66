"""Programs nested deeply are read, run and written; what is nested beyond all sense is refused at its place."""

import threading
from collections.abc import Callable

import pytest

from rpl import registry
from rpl.depth import at_any_depth, deeply
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.errors import SourceError
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text
from rpl.translation import translate_program

# Per language: the file, the text around a body, how an assignment of a value looks, a block's beginning and end.
FORMS = {
    "rapid": ("d.mod", "MODULE d\nVAR num x;\nPROC main()\n{}\nENDPROC\nENDMODULE\n", "x:={};", "IF x>0 THEN", "ENDIF"),
    "krl": ("d.src", "DEF d()\nDECL INT X\n{}\nEND\n", "X={}", "IF X>0 THEN", "ENDIF"),
    "rpl": ("d.rpl", "VAR x: INT\n{}\n", "x = {}", "IF x > 0 THEN", "END IF"),
    "urscript": ("d.script", "def d():\n{}\nend\n", "x={}", "if x>0:", "end"),
    "vplus": ("d.v2", ".PROGRAM d()\n{}\n.END\n", "x = {}", "IF x > 0 THEN", "END"),
    "inform": (
        "D.JBI",
        "/JOB\n//NAME D\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\n///DATE 2020/01/01 10:00\n///ATTR SC,RW\n"
        "///GROUP1 RB1\nNOP\n{}\nEND\n",
        "SET I000 EXPRESS {}",
        "IFTHEN I000>0",
        "ENDIF",
    ),
    "tp": ("D.LS", "/PROG D\n/ATTR\n/MN\n{}\n/POS\n/END\n", "R[1]=({})", "IF (R[1]>0) THEN", "ENDIF"),
}


def program(language: str, statements: list[str]) -> tuple[ReadProgram, Diagnostics]:
    path, around, *_ = FORMS[language]
    if language == "tp":
        statements = [f"{number:4}:  {one} ;" for number, one in enumerate(statements, 1)]
    diagnostics = Diagnostics()
    text = around.format("\n".join(statements))
    return read_sources([source_from_text(path, text)], language, diagnostics), diagnostics


def nested_blocks(language: str, depth: int) -> tuple[ReadProgram, Diagnostics]:
    _, _, assignment, begin, end = FORMS[language]
    inner = assignment.format("7")
    return program(language, [assignment.format("1"), *[begin] * depth, inner, *[end] * depth])


def of_severity(diagnostics: Diagnostics, severity: Severity) -> list[str]:
    return [item.as_text() for item in diagnostics.of(severity)]


@pytest.mark.parametrize("language", FORMS)
def test_a_thousand_nested_blocks_are_read_and_run(language: str) -> None:
    read, diagnostics = nested_blocks(language, 1000)
    assert of_severity(diagnostics, Severity.ERROR) == []
    result = run_program(read.program)
    assert (result.status, result.fault) == ("finished", None)
    assert result.statements >= 1002


def test_blocks_beyond_all_sense_are_refused_at_their_place() -> None:
    read, diagnostics = nested_blocks("krl", 1300)
    refused = of_severity(diagnostics, Severity.LOSS)
    assert len(refused) == 1
    assert refused[0].startswith("d.src:1103:1: loss blocks-too-deep")
    assert of_severity(diagnostics, Severity.ERROR) == []
    assert run_program(read.program).fault is not None  # it stops there


@pytest.mark.parametrize("language", FORMS)
def test_a_thousand_brackets_are_read_and_run(language: str) -> None:
    assignment = FORMS[language][2]
    for value in ("(" * 990 + "5" + ")" * 990, "(1+" * 500 + "1" + ")" * 500):
        read, diagnostics = program(language, [assignment.format(value)])
        assert of_severity(diagnostics, Severity.ERROR) == []
        assert run_program(read.program).status == "finished"


@pytest.mark.parametrize("language", FORMS)
def test_ten_thousand_brackets_around_a_value_are_the_value(language: str) -> None:
    assignment = FORMS[language][2]
    read, diagnostics = program(language, [assignment.format("(" * 10_000 + "5" + ")" * 10_000)])
    plain, _ = program(language, [assignment.format("(5)")])
    assert [item.as_text() for item in diagnostics] == []
    assert read.program == plain.program
    assert run_program(read.program).status == "finished"


_SUM = "(1+" * 10_000 + "1" + ")" * 10_000


@pytest.mark.parametrize("language", FORMS)
def test_a_statement_that_is_too_deep_is_a_loss_of_its_own(language: str) -> None:
    """The rest of the program is read, run up to there, and written in every language with a stop in its place."""
    assignment = FORMS[language][2]
    read, diagnostics = program(language, [assignment.format("1"), assignment.format(_SUM), assignment.format("2")])
    assert of_severity(diagnostics, Severity.ERROR) == []
    refused = of_severity(diagnostics, Severity.LOSS)
    path, around, *_ = FORMS[language]
    line = around.partition("{}")[0].count("\n") + 2
    assert len(refused) == 1
    assert refused[0].startswith(f"{path}:{line}:")
    assert "expressions-too-deep" in refused[0]
    assert [report.opaque for report in read.files] == [1]
    result = run_program(read.program)
    assert result.fault is not None
    assert result.fault.origin.line == line
    for target in registry.target_names():
        if target not in ("rpl", language):  # these keep the text
            collected = Diagnostics()
            assert len(translate_program(read, target, diagnostics=collected).losses) == 1
            assert of_severity(collected, Severity.ERROR) == []


# Per language: statements around a deep expression that open, divide or end a block; the line of the block.
BLOCKS = [
    ("krl", ["IF {}>0 THEN", "X=4", "ENDIF"]),
    ("krl", ["REPEAT", "X=4", "UNTIL {}>0"]),
    ("krl", ["FOR X=1 TO {}", "X=4", "ENDFOR"]),
    ("rapid", ["IF x>0 THEN", "x:=4;", "ELSEIF {}>0 THEN", "x:=5;", "ENDIF"]),
    ("rapid", ["WHILE {}>0 DO", "x:=4;", "ENDWHILE"]),
    ("rapid", ["TEST {}", "CASE 1:", "x:=4;", "ENDTEST"]),
    ("rpl", ["IF x > 0 THEN", "x = 4", "ELSEIF {} > 0 THEN", "x = 5", "END IF"]),
    ("rpl", ["REPEAT", "x = 4", "UNTIL {} > 0"]),
    ("urscript", ["if x>0:", "x=4", "elif {}>0:", "x=5", "end"]),
    ("urscript", ["while {}>0:", "x=4", "end"]),
    ("vplus", ["CASE {} OF", "VALUE 1:", "x = 4", "END"]),
    ("vplus", ["DO", "x = 4", "UNTIL {} > 0"]),
    ("tp", ["IF ({}>0) THEN", "R[1]=4", "ELSE", "R[1]=5", "ENDIF"]),
]


@pytest.mark.parametrize(("language", "block"), BLOCKS, ids=lambda value: value if isinstance(value, str) else value[0])
def test_the_block_of_a_statement_that_is_too_deep_is_kept_whole(language: str, block: list[str]) -> None:
    assignment = FORMS[language][2]
    lines = [assignment.format("1"), *(line.format(_SUM) for line in block), assignment.format("2")]
    read, diagnostics = program(language, lines)
    assert of_severity(diagnostics, Severity.ERROR) == []
    refused = of_severity(diagnostics, Severity.LOSS)
    assert len(refused) == 1
    line = FORMS[language][1].partition("{}")[0].count("\n") + 2
    at = next(number for number, text in enumerate(block) if "{}" in text)
    assert refused[0].startswith(f"{FORMS[language][0]}:{line + at}:")
    assert [report.opaque for report in read.files] == [1]
    fault = run_program(read.program).fault
    assert fault is not None
    assert fault.origin.line == line


def test_long_chains_of_operators_are_written() -> None:
    read, diagnostics = program("krl", [FORMS["krl"][2].format("+".join("1" * 300))])
    written = translate_program(read, "urscript", diagnostics=diagnostics)
    assert written.losses == ()
    assert b"+ 1 + 1" in written.files[0].data or b"300" in written.files[0].data


_ELSE = {"urscript": "else:"}
_LOOP = {
    "rapid": ("WHILE {} DO", "ENDWHILE"),
    "krl": ("WHILE {}", "ENDWHILE"),
    "rpl": ("WHILE {}", "END WHILE"),
    "urscript": ("while {}:", "end"),
    "vplus": ("WHILE {} DO", "END"),
    "inform": ("WHILE {}", "ENDWHILE"),
}
_VALUE = {"inform": "I000", "tp": "R[1]"}


def blocks(language: str, depth: int) -> list[str]:
    _, _, assignment, begin, end = FORMS[language]
    return [assignment.format("1"), *[begin] * depth, assignment.format("7"), *[end] * depth]


def branches(language: str, depth: int) -> list[str]:
    """Each `else` holds the next question."""
    _, _, assignment, begin, end = FORMS[language]
    asked = [line for at in range(depth) for line in (begin, assignment.format(at), _ELSE.get(language, "ELSE"))]
    return [assignment.format("0"), *asked, assignment.format("5"), *[end] * depth]


def loops(language: str, depth: int) -> list[str]:
    _, _, assignment, *_ = FORMS[language]
    begin, end = _LOOP[language]
    begin = begin.format(f"{_VALUE.get(language, 'x')}<1")
    return [assignment.format("0"), *[begin] * depth, assignment.format("7"), *[end] * depth]


def long_sum(language: str, terms: int) -> list[str]:
    assignment = FORMS[language][2]
    return [assignment.format("1"), assignment.format("+".join([_VALUE.get(language, "x")] * terms))]


@pytest.mark.slow
@pytest.mark.parametrize("target", registry.target_names())
@pytest.mark.parametrize(("make", "size"), [(blocks, 400), (branches, 200), (loops, 200), (long_sum, 300)])
@pytest.mark.parametrize("language", FORMS)
def test_deep_programs_are_written_in_every_language(
    language: str, make: Callable[[str, int], list[str]], size: int, target: str
) -> None:
    if make is loops and language not in _LOOP:
        pytest.skip("it has no such loop")
    read, diagnostics = program(language, make(language, size))
    assert diagnostics.of(Severity.ERROR) == []
    collected = Diagnostics()
    written = translate_program(read, target, diagnostics=collected)
    assert collected.of(Severity.ERROR) == []
    if make is long_sum:
        return  # a controller may have no room for it, and says so
    assert written.losses == ()
    again = Diagnostics()
    sources = [source_from_text(file.path, file.data.decode("utf-8")) for file in written.files]
    back = read_sources(sources, target, again)
    assert again.of(Severity.ERROR) == []
    assert run_program(back.program).status == "finished"


@pytest.mark.parametrize("language", ["rapid", "inform", "urscript"])
def test_loops_in_loops_are_each_followed_once(language: str) -> None:
    """What follows each loop twice would follow the innermost one 2**60 times."""
    read, _ = program(language, loops(language, 60))
    assert translate_program(read, "krl", diagnostics=Diagnostics()).losses == ()


def test_counting_loops_in_loops_are_read_once_each() -> None:
    lines = [*(f"FOR R[{at}]=1 TO 1" for at in range(1, 61)), "R[70]=1", *["ENDFOR"] * 60]
    _, diagnostics = program("tp", lines)
    assert diagnostics.of(Severity.ERROR) == []


def test_a_long_sum_is_cut_into_lines() -> None:
    """V+ lines have 255 characters, so a sum of 400 terms takes a few variables, not one for each term."""
    read, _ = program("rapid", long_sum("rapid", 400))
    written = translate_program(read, "vplus", diagnostics=Diagnostics())
    lines = written.files[0].data.decode().splitlines()
    assert written.losses == ()
    assert max(map(len, lines)) <= 255
    assert len(lines) < 40


def test_work_that_overflows_is_done_once_more_and_reports_once() -> None:
    note = code("test-depth-note", Severity.INFO, "seen")
    diagnostics = Diagnostics()

    def down(levels: int) -> int:
        return 0 if levels == 0 else 1 + down(levels - 1)

    def work() -> int:
        diagnostics.report(note)
        return down(50_000)

    assert at_any_depth(work, diagnostics) == 50_000
    assert len(diagnostics) == 1


def test_work_without_end_is_refused_by_name() -> None:
    def down() -> int:
        return 1 + down()

    with pytest.raises(SourceError, match="nested too deeply"):
        at_any_depth(down)


def test_large_stacks_are_given_back() -> None:
    before, size = threading.active_count(), threading.stack_size()
    assert deeply(lambda: 5) == 5
    assert threading.stack_size() == size
    assert threading.active_count() <= before + 1


def test_an_array_without_elements_is_no_list_to_gather() -> None:
    text = 'MODULE d\nCONST num none{0}:=[];\nPROC main()\nTPWrite "ok";\nENDPROC\nENDMODULE\n'
    read = read_sources([source_from_text("d.mod", text)], "rapid", Diagnostics())
    assert translate_program(read, "urscript").files


def test_a_handler_that_names_what_is_not_declared_is_a_fault() -> None:
    """A controller refuses such a module when it is loaded; a run of what was read stops where it asks."""
    text = "MODULE d\nPROC main()\nVAR num x;\nx:=1/0;\nERROR(NOT_DECLARED)\nTRYNEXT;\nENDPROC\nENDMODULE\n"
    read = read_sources([source_from_text("d.mod", text)], "rapid", Diagnostics())
    fault = run_program(read.program).fault
    assert fault is not None
    assert "NOT_DECLARED is not declared" in fault.message
    assert fault.origin.line == 4
