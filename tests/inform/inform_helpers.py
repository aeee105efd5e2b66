"""Small jobs for the tests: put together, read, run."""

from rpl import ir
from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.project import read_sources
from rpl.simulation import RunResult, run_program
from rpl.source import source_from_text

HEADER = """/JOB
//NAME {name}
//POS
///NPOS 0,0,0,0,0,0
{points}
//INST
///DATE 2024/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
"""


def job(body: str, points: str = "///TOOL 0", name: str = "TEST") -> str:
    """The text of a job with these points and instructions."""
    return HEADER.format(name=name, points=points.strip()) + body.strip() + "\nEND\n"


def read(*texts: str) -> tuple[ir.Program, Diagnostics]:
    diagnostics = Diagnostics()
    sources = [source_from_text(f"job{number}.jbi", text) for number, text in enumerate(texts)]
    return read_sources(sources, "inform", diagnostics).program, diagnostics


def body_of(*texts: str, name: str = "TEST") -> ir.Body:
    """The statements of a job; it must read without an error."""
    program, diagnostics = read(*texts)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    routine = next(routine for module in program.modules for routine in module.routines if routine.name == name)
    return tuple(statement for statement in routine.body if not isinstance(statement, ir.Nothing))


def run(*texts: str, robot: str = "motoman_gp7", entry: str = "TEST", cell: str = "") -> RunResult:
    program, diagnostics = read(*texts)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return run_program(program, load_robot(robot), parse_cell(cell), entry)


def outputs(result: RunResult) -> list[tuple[str, object]]:
    return [(name, value) for _, name, value in result.outputs]
