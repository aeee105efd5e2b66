"""Programs read from text, targets as data, and a short text of IR for comparisons."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.capabilities import (
    Aggregate,
    Capabilities,
    Composite,
    Control,
    Data,
    NameRules,
    PlaceRule,
    Places,
    Settings,
)
from rpl.passes.legalise.context import Context, names_in
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

NAMES = NameRules(longest=24, case_sensitive=False, reserved=frozenset())
SIMPLE = ("IntType", "RealType", "BoolType", "CharType", "StringType", "NamedType", "ArrayType")
KRL = Capabilities(
    statements=frozenset(),
    functions=frozenset(("abs", "sqrt", "sin", "cos", "tan", "acos", "atan2", "inverse", "text_length", "round")),
    procedures=frozenset(),
    system_variables=frozenset(("tool", "base", "actual_pose", "actual_joints", "null_frame")),
    operators=frozenset(("+", "-", "*", "/", "div", ":", "and", "or", "xor", "=", "<>", "<", ">", "<=", ">=")),
    types=frozenset((*SIMPLE, "PoseType", "TargetType", "JointsType")),
    names=NAMES,
    places=Places(notation="krl"),
    settings=Settings(modal=True),
    data=Data(
        composites=frozenset((Composite.ARRAYS, Composite.ENUMS, Composite.RECORDS)),
        aggregates=frozenset((Aggregate.CONSTANT, Aggregate.NAMED, Aggregate.PARTIAL)),
    ),
    control=Control(switch_types=frozenset(("IntType", "CharType"))),
)
RAPID = Capabilities(
    statements=frozenset(),
    functions=frozenset((*KRL.functions, "compose", "transform", "offset", "tool_offset", "rotation_zyx", "distance"))
    | {"magnitude", "dot", "euler_x", "euler_y", "euler_z", "normalise", "trunc", "character_code", "from_code"},
    procedures=frozenset(),
    system_variables=frozenset(("joint_configuration_check", "path_configuration_check")),
    operators=frozenset(("+", "-", "*", "/", "div", "mod", "&", "@", "cand", "cor", "=", "<>", "<", ">", "<=", ">=")),
    types=frozenset(
        (
            *("RealType", "BoolType", "StringType", "NamedType", "ArrayType", "PoseType", "TargetType", "JointsType"),
            *("VectorType", "RotationType", "ConfigType", "ExternalType", "AxesType", "ToolType", "WorkObjectType"),
            *("LoadType", "SpeedType", "ZoneType", "ClockType", "InterruptType", "TriggerType"),
        )
    ),
    names=NAMES,
    places=Places(notation="rapid", rules=frozenset((PlaceRule.KEEP_ANGLES, PlaceRule.QUATERNIONS, PlaceRule.TURNS))),
    settings=Settings(modal=False),
    control=Control(short_circuit=True),
)


def read(text: str, dialect: str, name: str = "t") -> ir.Program:
    """The normalised program of one source text (KRL: `DEF t()` in a .src, or a .dat behind a line `====`)."""
    diagnostics = Diagnostics()
    suffixes = {"krl": ("src", "dat"), "rapid": ("mod",)}[dialect]
    parts = text.split("====\n")
    sources = [source_from_text(f"{name}.{suffix}", part) for part, suffix in zip(parts, suffixes, strict=False)]
    found = read_sources(sources, dialect, diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return found.program


def means_the_same(text: str, target: str, robot: str = "kuka_kr6r900sixx") -> None:
    """The RPL program `main` is written without a loss, and what was written is proved to mean the same."""
    read = read_sources([source_from_text("p.rpl", text)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, robot, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = entry_name(back.program, written.renamed.get("main", "main"))
    result = prove_programs(read.program, back.program, robot, entry="main", to_entry=entry)
    assert result.agrees, result.as_text()


def context(program: ir.Program, source: str, robot: object = None, to_robot: object = None) -> Context:
    """A context for the other one of KRL and RAPID."""
    target = "rapid" if source == "krl" else "krl"
    capabilities = RAPID if source == "krl" else KRL
    made = Context(source, target, capabilities, Diagnostics(), robot, to_robot or robot)  # type: ignore[arg-type]
    made.taken |= names_in(program)
    return made


def routine(program: ir.Program, name: str) -> ir.Routine:
    return next(one for module in program.modules for one in module.routines if one.name.lower() == name.lower())


def variable(program: ir.Program, name: str) -> ir.Variable:
    for module in program.modules:
        for one in (*module.declarations, *(d for r in module.routines for d in r.declarations)):
            if isinstance(one, ir.Variable) and one.name.lower() == name.lower():
                return one
    raise AssertionError(f"no variable {name}")


def lines(program: ir.Program, name: str = "t") -> list[str]:
    """The statements of a routine as short text."""
    return [line for statement in routine(program, name).body for line in show_statement(statement)]


def show_statement(statement: ir.Statement) -> list[str]:
    match statement:
        case ir.Assign(target=target, value=value):
            return [f"{show(target)} := {show(value)}"]
        case ir.CallRoutine(name=name, arguments=arguments):
            return [f"{name}({', '.join(show(a.value) for a in arguments if a.value is not None)})"]
        case ir.Return(value=value):
            return [f"return {show(value)}" if value is not None else "return"]
        case ir.Move(kind=kind, target=target):
            return [f"{kind} {show(target)}"]
        case ir.ExitLoop():
            return ["exit"]
        case ir.If(branches=branches, otherwise=otherwise):
            found = []
            for at, (condition, body) in enumerate(branches):
                found.append(f"{'elseif' if at else 'if'} {show(condition)}")
                found.extend(_indented(body))
            return [*found, *(["else", *_indented(otherwise)] if otherwise else [])]
        case ir.While(condition=condition, body=body):
            return [f"while {show(condition)}", *_indented(body)]
        case ir.Loop(body=body):
            return ["loop", *_indented(body)]
        case ir.For(counter=counter, start=start, stop=stop, body=body):
            return [f"for {counter} = {show(start)} to {show(stop)}", *_indented(body)]
        case ir.Switch(selector=selector, cases=cases, default=default):
            found = [f"switch {show(selector)}"]
            for case in cases:
                found.append("case " + ", ".join(map(show, case.values)))
                found.extend(_indented(case.body))
            return [*found, *(["default", *_indented(default)] if default is not None else [])]
        case ir.Nothing():
            return []
    return [type(statement).__name__]


def _indented(body: ir.Body) -> list[str]:
    return ["  " + line for one in body for line in show_statement(one)]


def show(expression: ir.Expression) -> str:
    match expression:
        case ir.IntLiteral(value=value):
            return str(value)
        case ir.RealLiteral(value=value):
            return f"{value:.6g}" if value != int(value) else f"{value:.1f}"
        case ir.BoolLiteral(value=value):
            return str(value)
        case ir.TextLiteral(value=value):
            return repr(value)
        case ir.EnumLiteral(member=member):
            return f"#{member}"
        case ir.Name(id=name):
            return name
        case ir.Index(base=base, indices=indices):
            return f"{show(base)}[{', '.join(map(show, indices))}]"
        case ir.Field(base=base, name=name):
            return f"{show(base)}.{name}"
        case ir.Unary(op=op, operand=operand):
            return f"{op}{' ' if op.isalpha() else ''}{show(operand)}"
        case ir.Binary(op=op, left=left, right=right):
            return f"({show(left)} {op} {show(right)})"
        case ir.Call(name=name, arguments=arguments):
            return f"{name}({', '.join(show(a.value) for a in arguments if a.value is not None)})"
        case ir.Builtin(function=function, arguments=arguments):
            return f"{function}({', '.join(map(show, arguments))})"
        case ir.Aggregate(entries=entries):
            return "{" + ", ".join(f"{name} {show(v)}" if name else show(v) for name, v in entries) + "}"
        case ir.System(name=name, indices=indices):
            return f"${name}" + (f"[{', '.join(map(show, indices))}]" if indices else "")
        case ir.Convert(how=how, operand=operand):
            return f"{how}<{show(operand)}>"
        case ir.Quantity(value=value, unit=unit):
            return f"({show(value)} {unit})"
    return type(expression).__name__
