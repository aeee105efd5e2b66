"""Shared by the V+ tests: read text, show a program's steps as RPL, run it."""

from __future__ import annotations

from rpl import ir, registry
from rpl.cell.cellfile import Cell
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.passes.typing import normalise
from rpl.simulation import RunResult, run_program
from rpl.source import source_from_text
from rpl.writing.target import WriteContext


def read(files: dict[str, str] | str) -> tuple[ir.Program, Diagnostics]:
    """The program of some files (a bare text is `p.v2`) and what was reported."""
    named = {"p.v2": files} if isinstance(files, str) else files
    diagnostics = Diagnostics()
    sources = [source_from_text(name, text) for name, text in named.items()]
    program = registry.dialect("vplus").read(sources, diagnostics).program
    return normalise(program, diagnostics), diagnostics


def program_of(steps: str, more: str = "") -> str:
    """Steps as the program `test`, with further programs behind it."""
    return f".PROGRAM test()\n{steps}\n.END\n{more}"


def as_rpl(program: ir.Program, routine: str = "test") -> list[str]:
    """The steps of a routine as RPL shows them, without its declarations."""
    text = "\n".join(
        file.data.decode("utf-8") for file in registry.target("rpl").write(program, WriteContext(Diagnostics()))
    )
    lines = [line.strip() for line in text.splitlines()]
    start = next(at for at, line in enumerate(lines) if f"PROCEDURE {routine}(" in line)
    end = lines.index("END PROCEDURE", start)
    return [line for line in lines[start + 1 : end] if line and not line.startswith(("VAR ", "PERSISTENT "))]


def steps(text: str, more: str = "") -> list[str]:
    """Steps that must read without a report, as RPL shows them."""
    program, diagnostics = read(program_of(text, more))
    assert not [item.as_text() for item in diagnostics if item.severity > 0]
    return as_rpl(program)


def reported(text: str, more: str = "") -> list[str]:
    """The codes of what is reported for some steps."""
    return [item.code.name for item in read(program_of(text, more))[1]]


def variable(program: ir.Program, name: str) -> ir.Variable:
    """A global variable of the first module that has it."""
    return next(
        declaration
        for module in program.modules
        for declaration in module.declarations
        if isinstance(declaration, ir.Variable) and declaration.name == name
    )


def run(text: str, more: str = "", robot: str = "adept_viper_s650", cell: Cell | None = None) -> RunResult:
    """Run the program `test`."""
    program, diagnostics = read(program_of(text, more))
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return run_program(program, load_robot(robot), cell, "test")


def outputs(result: RunResult) -> list[tuple[str, object]]:
    """Changes of outputs in order."""
    assert result.status == "finished", result.as_json()["fault"]
    return [(name, value) for _, name, value in result.outputs]
