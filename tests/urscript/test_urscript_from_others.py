"""Programs of other languages mean the same as URScript: written, read back, run, compared."""

from __future__ import annotations

import re

import pytest

from rpl.cell import Cell, parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import ProofResult, prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOTS = {
    "vplus": "adept_viper_s650",
    "tp": "fanuc_lrmate200id",
    "rpl": "ur5e",
    "krl": "kuka_kr6r700sixx",
    "rapid": "abb_irb120_3_58",
}
SUFFIX = {"vplus": "v2", "tp": "ls", "rpl": "rpl", "krl": "src", "rapid": "mod"}


def translated(language: str, text: str, cell: Cell | None = None) -> tuple[str, list[str], ProofResult]:
    """The script, the codes of its losses, and what the proof says."""
    source = source_from_text(f"main.{SUFFIX[language]}", text)
    read = Diagnostics()
    program = read_sources([source], language, read)
    assert not read.has_errors, [item.as_text() for item in read]
    diagnostics = Diagnostics()
    robot = ROBOTS[language]
    levels = cell.analog if cell is not None else ()
    result = translate_program(program, "urscript", robot, diagnostics=diagnostics, analog=levels)
    (file,) = result.files
    again = Diagnostics()
    back = read_sources([source_from_bytes(file.path, file.data)], "urscript", again)
    assert not again.has_errors, [item.as_text() for item in again]
    named = with_signal_names(back.program, result.program)
    proof = prove_programs(program.program, named, robot, robot, cell, entry="main", to_entry="main")
    return file.data.decode(), [item.code.name for item in diagnostics.of(Severity.LOSS)], proof


def equal(language: str, text: str, cell: Cell | None = None) -> str:
    """The script of a program that has to mean the same, without a loss."""
    script, losses, proof = translated(language, text, cell)
    assert not losses, script
    assert proof.agrees, f"{proof.as_text()}\n{script}"
    return script


VPLUS = """.PROGRAM main()
        SET a = TRANS(300, -200, 120, 0, 180, 0)
        SET b = TRANS(400, -200, 120, 0, 180, 0)
        SET c = TRANS(400, 0, 120, 0, 180, 0)
        SPEED 100 ALWAYS
        MOVE #PPOINT(0, -90, 180, 180, 60, 0)
        MOVE a
        BREAK
{lines}
        BREAK
        SIGNAL 1
.END
"""


def test_continuous_path_leaves_each_move_where_its_braking_would_begin() -> None:
    script = equal("vplus", VPLUS.format(lines="        SPEED 40\n        MOVES b\n        MOVES c"))
    (radius,) = re.findall(r"movel\(b, .*r=([\d.]+)\)", script)
    speed = float(re.findall(r"movel\(b, a=2, v=([\d.]+)", script)[0]) * 1000.0
    assert float(radius) * 1000.0 == pytest.approx(speed**2 / 4000.0, rel=0.01)


def test_full_acceleration_decides_the_corner_too() -> None:
    equal("vplus", VPLUS.format(lines="        ACCEL 50\n        SPEED 40\n        MOVES b\n        MOVES c"))


RPL = """VAR p: POSE = {{x: 300, y: 0.57, z: 300, a: 90, b: 0, c: 0}}
VAR x: REAL = 0
PROCEDURE main()
{lines}
END PROCEDURE
"""


@pytest.mark.parametrize(
    "lines",
    [
        "x = p.a\nSET do[1] TO x = 90",
        "SET do[1] TO p.a = 90 AND p.y = 0.57",
        "p.b = 5\nx = p.b + p.a\nSET do[1] TO x = 95",
        "p.x = 57.3\nSET do[1] TO p.x >= 57.3 AND p.x <= 57.3",
        "p.a = 44\nSET do[1] TO TRUNC(p.a) = 44",
    ],
)
def test_numbers_out_of_poses_are_those_of_the_source(lines: str) -> None:
    equal("rpl", RPL.format(lines=lines))


@pytest.mark.parametrize(
    "lines",
    [
        "SET do[19] TO TRUE\nSET do[1] TO do[19] AND NOT do[20]",
        "VAR n: INT = 16\nFOR n = 16 TO 22\nSET do[n] TO TRUE\nEND FOR\nSET do[40] TO do[n - 1]",
        "SET ao[7] TO 2.5\nSET do[1] TO ao[7] > 2",
    ],
)
def test_signals_beyond_the_control_box_are_registers(lines: str) -> None:
    volts = "[analog.urscript]\nao7 = { numbers = [0, 1], volts = [0, 1] }"  # a register has no unit of its own
    script = equal("rpl", RPL.format(lines=lines), parse_cell(volts))
    assert "write_output_boolean_register(" in script or "write_output_float_register(" in script


def test_a_loop_that_only_sets_outputs_takes_no_time() -> None:
    lines = "WHILE x < 3\nSET do[2] TO x > 1\nx = x + 1\nEND WHILE\nSET do[1] TO x = 3"
    assert "sync()" not in equal("rpl", RPL.format(lines=lines))


def test_a_move_along_the_tool_starts_where_the_last_pass_of_a_loop_went() -> None:
    lines = """        FOR n = 1 TO 2
            MOVES b:TRANS(0, n * 20)
            BREAK
        END
        DEPARTS 40"""
    assert "get_actual_tcp_pose" not in equal("vplus", VPLUS.format(lines=lines))


KRL = """DEF MAIN()
DECL REAL SEEN
{lines}
END
"""


def test_timers_are_counted_by_a_thread() -> None:
    lines = "$TIMER[1]=0\n$TIMER_STOP[1]=FALSE\nWAIT SEC 1.5\n$TIMER_STOP[1]=TRUE\nWAIT SEC 1.0\nSEEN=$TIMER[1]\n"
    lines += "$OUT[1]=SEEN>1490 AND SEEN<1510\n$TIMER_STOP[1]=FALSE\nWAIT SEC 0.5\n$OUT[2]=$TIMER[1]>1990"
    script = equal("krl", KRL.format(lines=lines))
    assert "get_steptime()" in script


def test_a_message_keeps_its_sender() -> None:
    assert 'popup("late", title="cell")' in equal("krl", KRL.format(lines='MsgNotify("late","cell")'))


def test_searches_in_texts() -> None:
    lines = [
        f"SET do[{number}] TO {one}"
        for number, one in enumerate(
            (
                'TEXT_FIND_ANY("pallet-12", 1, "0123456789") = 8',
                'TEXT_FIND_ANY("pallet", 1, "0123456789") = 7',
                'TEXT_MATCH("pallet-12", 1, "let") = 4',
                'TEXT_MATCH("pallet-12", 5, "let") = 10',
                'TEXT_MEMBER("pallet", 3, "klm")',
            ),
            1,
        )
    ]
    equal("rpl", RPL.format(lines="\n".join(lines)))
