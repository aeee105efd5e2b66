"""A reaction is over when it has come, unless its program enables it again: here and in every language."""

from __future__ import annotations

import pytest
from vplus_helpers import as_rpl, outputs, program_of, read, run

from rpl import registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

EDGE = "SIGNAL 2001\nWAIT.EVENT , 0.1\nSIGNAL -2001\nWAIT.EVENT , 0.1\n"
MORE = (
    ".PROGRAM seen()\nn = n+1\n.END\n"
    ".PROGRAM again()\nn = n+1\nREACT 2001, again, 3\n.END\n"
    ".PROGRAM twice()\nn = n+1\nIF n < 2 THEN\nREACT 2001, twice, 3\nEND\n.END\n"
)
CASES = [
    ("REACT 2001, seen", 1),
    ("REACT -2001, seen", 1),
    ("REACTI 2001, seen", 1),
    ("REACT 2001, again, 3", 3),
    ("REACT 2001, twice, 3", 2),
    ("CALL seen\nREACT 2001, seen", 2),  # the program does something else as well
]


INTERRUPTS = {"DeclareInterrupt", "ConnectInterrupt"}  # a target has one of them, or none at all


def _reacting(text: str) -> list[int]:
    """The lines that begin to watch."""
    return [number for number, line in enumerate(text.splitlines(), 1) if line.startswith("REACT ")]


def text_of(step: str, count: int) -> str:
    return program_of(f"n = 0\nSIGNAL -2001\n{step}\n{EDGE * 3}IF n == {count} THEN\nSIGNAL 1\nEND", MORE)


@pytest.mark.parametrize(("step", "count"), CASES)
def test_it_comes_so_often(step: str, count: int) -> None:
    assert outputs(run(f"n = 0\nSIGNAL -2001\n{step}\n{EDGE * 3}IF n == {count} THEN\nSIGNAL 1\nEND", MORE))[-1] == (
        "1",
        True,
    )


@pytest.mark.parametrize(("step", "count"), [case for case in CASES if "REACTI" not in case[0]])
def test_it_comes_so_often_in_every_language(step: str, count: int) -> None:
    source = read_sources([source_from_text("main.v2", text_of(step, count))], "vplus", Diagnostics())
    for target in registry.target_names():
        found = Diagnostics()
        translation = translate_program(source, target, "adept_viper_s650", None, found)
        if not INTERRUPTS & registry.target(target).capabilities_under({}).statements:
            refused = {(item.code.name, item.origin.line) for item in found.of(Severity.LOSS)}
            assert refused == {("interrupt-lost", line) for line in _reacting(text_of(step, count))}, target
            continue
        assert not [item.as_text() for item in found.of(Severity.LOSS)], target
        files = [source_from_bytes(file.path, file.data) for file in translation.files]
        back = read_sources(files, target, Diagnostics())
        result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("test", "test"))
        assert result.status == "finished"
        assert [value for _, name, value in result.outputs if value and not name.endswith(("2001]", "flag[1]"))], target


def test_one_that_enables_itself_at_once_is_an_interrupt_that_comes_again() -> None:
    for again, words in (("", " EVERYWHERE ONCE "), ("REACT 2001, more, 3\n", " EVERYWHERE NAMED ")):
        program, _ = read(program_of("REACT 2001, more, 3", f".PROGRAM more()\nn = 1\n{again}.END\n"))
        assert words in as_rpl(program)[0]


def test_interrupts_of_other_languages_are_armed_again() -> None:
    text = (
        "DEF count( )\nGLOBAL INTERRUPT DECL 12 WHEN $IN[1] DO note( )\nINTERRUPT ON 12\nWAIT SEC 1\nEND\n"
        "DEF note( )\n$OUT[1]=TRUE\nEND\n"
    )
    source = read_sources([source_from_text("count.src", text)], "krl", Diagnostics())
    lines = translate_program(source, "vplus", "kuka_kr6r900sixx", None, Diagnostics()).files[0].data.decode().split()
    at = lines.index("note()")
    assert lines[at + 1 : at + 6] == ["REACT", "1001,", "note,", "116", "SIGNAL"]
