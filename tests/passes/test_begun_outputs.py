"""What stands behind a move in V+ is done when the move begins; elsewhere it stands in front of the move."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PLACES = " SET a = TRANS(330,-50,260,0,180,0)\n SET b = TRANS(330,50,260,0,180,0)\n MOVE a\n BREAK\n"
# The V+ lines behind that, what stands in URScript from the first move on, and the warnings of outputs that come late.
CASES = {
    "between moves": (
        "MOVES b\nSIGNAL 1\nMOVES a\nSIGNAL -1",
        ["digital_out(0, True)", "movel", "digital_out(0, False)", "movel"],
        0,
    ),
    "behind a step that only counts": ("MOVES b\nn = n+1\nSIGNAL 1\nBREAK", ["digital_out(0, True)", "movel"], 0),
    "a value counted behind the move": ("MOVES b\nn = n+1\nAIO.OUT 1 = n\nBREAK", ["movel", "analog_out"], 1),
    "a watch": ("MOVES b\nTIMER 1 = 0\nBREAK", ["timer_1", "movel"], 0),
    "in a branch": ("MOVES b\nIF n == 1 THEN\nSIGNAL 1\nEND\nBREAK", ["digital_out(0, True)", "movel"], 0),
    "behind branches that end with moves": (
        "IF n == 1 THEN\nMOVES b\nELSE\nMOVES SHIFT(b BY 9,0,0)\nEND\nSIGNAL 1\nBREAK",
        ["movel", "movel", "digital_out(0, True)"],
        1,
    ),
    "behind branches of which one drives": (
        "IF n == 1 THEN\nMOVES b\nEND\nSIGNAL 1\nBREAK",
        ["movel", "digital_out(0, True)"],
        1,
    ),
    "a look at an input": (
        "MOVES b\nIF SIG(1001) THEN\nn = 2\nEND\nMOVES a",
        ["standard_digital_in", "movel"],
        0,
    ),
    "what the move depends on": ("n = 5\nMOVES SHIFT(a BY n,0,0)\nn = TIMER(1)\nBREAK", ["movel", "timer"], 0),
    "behind a wait beside the move": ("MOVES b\nWAIT SIG(1002)\nSIGNAL 1\nBREAK", ["movel", "digital_out(0, True)"], 1),
    "behind the end": ("MOVES b\nBREAK\nSIGNAL 1", ["movel", "digital_out(0, True)"], 0),
    "the same output twice": (
        "MOVES b\nSIGNAL 1\nAIO.OUT 1 = n\nn = 2\nAIO.OUT 1 = n\nSIGNAL 1\nBREAK",
        ["digital_out(0, True)", "analog_out", "movel", "analog_out", "digital_out(0, True)"],
        2,
    ),
    "behind a loop": ("FOR i = 1 TO 2\nMOVES b\nEND\nSIGNAL 1\nBREAK", ["movel", "digital_out(0, True)"], 1),
    "behind a routine": ("CALL go\nSIGNAL 1\nBREAK", ["go()", "digital_out(0, True)"], 1),
    "behind a routine that waits": ("CALL go\nBREAK\nSIGNAL 1", ["go()", "digital_out(0, True)"], 0),
}
GO = ".PROGRAM go()\n MOVES TRANS(330,50,260,0,180,0)\n.END\n"


def written(statements: str, target: str) -> tuple[list[str], list[str]]:
    """The lines, and the codes of warnings."""
    text = f".PROGRAM main()\n n = 1\n{PLACES}{statements}\n.END\n" + (GO if "CALL go" in statements else "")
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.v2", text)], "vplus", diagnostics)
    done = translate_program(read, target, None, None, diagnostics)
    lines = [line.strip() for file in done.files for line in file.data.decode("latin-1").splitlines()]
    return lines, [item.code.name for item in diagnostics.of(Severity.WARNING)]


@pytest.mark.parametrize("name", CASES)
def test_the_order_is_that_of_the_robot(name: str) -> None:
    statements, wanted, late = CASES[name]
    lines, warned = written(statements, "urscript")
    start = next(at for at, line in enumerate(lines) if line.startswith("movej"))
    places = []
    for words in wanted:
        start = next(at for at, line in enumerate(lines) if at > start and words in line)
        places.append(start)
    assert places == sorted(places) and warned.count("begun-output") == late


def test_a_controller_that_runs_ahead_switches_with_the_main_run() -> None:
    lines, _ = written(CASES["between moves"][0], "krl")
    on = lines.index("$OUT_C[1]=TRUE")
    assert any(line.startswith("LIN") for line in lines[on:]) and "CONTINUE" not in lines


@pytest.mark.parametrize(
    ("name", "late"),
    [
        ("between moves", 0),
        ("behind branches that end with moves", 1),
        ("behind branches of which one drives", 1),
        ("behind a loop", 1),
        ("behind a routine", 1),
        ("behind a routine that waits", 0),
    ],
)
def test_an_output_that_ends_running_ahead_is_told_as_late(name: str, late: int) -> None:
    lines, warned = written(CASES[name][0], "krl")
    assert warned.count("begun-output") == late and ("$OUT_C[1]=TRUE" in lines) == (not late and "waits" not in name)


def test_v_plus_itself_keeps_its_order() -> None:
    lines, warned = written(CASES["between moves"][0], "vplus")
    moves = [line for line in lines if line.startswith(("MOVES", "SIGNAL"))]
    assert [line.split()[0] for line in moves] == [
        "MOVES",
        "SIGNAL",
        "MOVES",
        "SIGNAL",
    ] and "begun-output" not in warned


@pytest.mark.parametrize("target", ["rapid", "inform"])
def test_a_second_move_begins_when_the_first_has_ended(target: str) -> None:
    """The watch behind the second move is looked at when that one begins, not at once."""
    program = f""".PROGRAM main()
        AUTO LOC h
{PLACES}
        TIMER 1 = 0
        SPEED 50 MMPS
        MOVES b
        HERE h
        MOVES a
        t = TIMER(1)
        BREAK
        IF (t > 1.9) AND (t < 2.4) AND (DY(h) < -45) THEN
            SIGNAL 1
        END
.END
"""
    read = read_sources([source_from_text("p.v2", program)], "vplus", Diagnostics())
    done = translate_program(read, target, "adept_viper_s650", None, Diagnostics())
    back = read_sources([source_from_bytes(one.path, one.data) for one in done.files], target, Diagnostics())
    for one in (read.program, back.program):
        result = run_program(one, "adept_viper_s650")
        assert result.fault is None and [state for _, _, state in result.outputs] == [True]
