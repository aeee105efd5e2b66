"""Shared by the URScript tests: read text, look at single statements, run programs that switch outputs."""

from __future__ import annotations

from rpl import ir, registry
from rpl.cell import Cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.typing import normalise
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text

ROBOT = "ur5e"


def read(files: dict[str, str] | str, normal: bool = True) -> tuple[ir.Program, Diagnostics]:
    """The program of some files (a bare text is `p.script`) and what was reported."""
    named = {"p.script": files} if isinstance(files, str) else files
    diagnostics = Diagnostics()
    sources = [source_from_text(name, text) for name, text in named.items()]
    program = registry.dialect("urscript").read(sources, diagnostics).program
    return (normalise(program, diagnostics) if normal else program), diagnostics


def codes(diagnostics: Diagnostics, least: Severity = Severity.WARNING) -> list[str]:
    return [item.code.name for item in diagnostics if item.severity >= least]


def routine(program: ir.Program, name: str) -> ir.Routine:
    (found,) = [each for module in program.modules for each in module.routines if each.name == name]
    return found


def variable(program: ir.Program, name: str) -> ir.Variable:
    declared = [d for m in program.modules for d in m.declarations]
    declared += [d for m in program.modules for r in m.routines for d in r.declarations]
    (found,) = [d for d in declared if isinstance(d, ir.Variable) and d.name == name]
    return found


def body(lines: str) -> ir.Body:
    """The statements of a program with these lines, which read without a report."""
    program, diagnostics = read(f"def prog():\n{lines}\nend\n", normal=False)
    assert not [item.as_text() for item in diagnostics if item.severity > Severity.INFO]
    return routine(program, "prog").body


def statement(lines: str) -> ir.Statement:
    """The last statement of these lines."""
    return body(lines)[-1]


def value(text: str, before: str = "") -> ir.Expression:
    """An expression in the IR."""
    assign = statement(f"{before}\nresult = {text}\nresult = result")
    del assign
    made = [s for s in body(f"{before}\nresult = {text}\nresult = result") if isinstance(s, ir.Assign)]
    return next(s.value for s in made if s.target == ir.Name("result"))


def shown(expression: ir.Expression) -> str:
    """An expression with all its brackets, for tables of cases."""
    match expression:
        case ir.Binary(op=op, left=left, right=right):
            return f"({shown(left)} {op} {shown(right)})"
        case ir.Unary(op=op, operand=operand):
            return f"({op} {shown(operand)})"
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number) | ir.BoolLiteral(value=number):
            return str(number)
        case ir.TextLiteral(value=text):
            return repr(text)
        case ir.Name(id=name):
            return name
        case ir.Field(base=base, name=name):
            return f"{shown(base)}.{name}"
        case ir.Index(base=base, indices=indices):
            return f"{shown(base)}[{','.join(map(shown, indices))}]"
        case ir.Aggregate(entries=entries):
            return (
                "{" + ",".join(shown(part) if name is None else f"{name} {shown(part)}" for name, part in entries) + "}"
            )
        case ir.Call(name=name, arguments=arguments):
            return f"{name}({','.join(shown(a.value) for a in arguments if a.value is not None)})"
        case ir.Builtin(function=name, arguments=values):
            return f"{name}({','.join(map(shown, values))})"
        case ir.System(name=name):
            return f"@{name}"
        case ir.Magnitude(value=part, unit=unit) | ir.Quantity(value=part, unit=unit):
            return f"<{shown(part)} {unit}>"
        case ir.Signal(kind=kind, index=index, name=name):
            return f"{kind}:{shown(index) if index is not None else name}"
        case ir.Convert(how=how, operand=operand):
            return f"{how}({shown(operand)})"
        case ir.VendorValue(text=text):
            return f"?{text}"
    return repr(expression)


def run(text: str | dict[str, str], robot: str | None = ROBOT, cell: Cell | None = None) -> RunResult:
    """What a program does; it reads without an error."""
    program, diagnostics = read(text)
    assert Severity.ERROR not in [item.severity for item in diagnostics], [item.as_text() for item in diagnostics]
    return run_program(program, robot=robot, cell=cell)


def holds(lines: str, *expectations: str) -> None:
    """Run these lines; each expectation switches an output on where it holds."""
    checks = "\n".join(f"set_standard_digital_out({n}, {text})" for n, text in enumerate(expectations))
    result = run(f"def prog():\n{lines}\n{checks}\nend\n")
    assert result.fault is None, result.fault
    on = {name for _, name, state in result.outputs if state}
    failed = [text for n, text in enumerate(expectations) if f"digital_out[{n}]" not in on]
    assert not failed
