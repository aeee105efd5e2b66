"""Files of RPL, and what RPL can say: everything."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import get_args

from rpl import ir
from rpl.errors import UsageError
from rpl.ir import words
from rpl.passes.capabilities import (
    Aggregate,
    Composite,
    Control,
    Counting,
    Data,
    Errors,
    GroupRule,
    Io,
    Local,
    Passing,
    Places,
    Rotation,
    Routines,
    Settings,
)
from rpl.writing.target import Capabilities, NameRules, OutputFile, WriteContext

from .modules import entry_lines, module_lines, program_lines

CAPABILITIES = Capabilities(
    statements=frozenset(node.__name__ for node in get_args(ir.Statement)),
    functions=frozenset(ir.FUNCTIONS),
    procedures=frozenset(ir.PROCEDURES),
    system_variables=frozenset(ir.SYSTEM_VARIABLES),
    operators=frozenset((*ir.BINARY_OPERATORS, *ir.UNARY_OPERATORS)),
    types=frozenset(node.__name__ for node in get_args(ir.Type)),
    names=NameRules(
        longest=1000,
        case_sensitive=True,
        reserved=words.RESERVED,
        first="abcdefghijklmnopqrstuvwxyz_$",
        further="abcdefghijklmnopqrstuvwxyz0123456789_$.",
    ),
    conversions=frozenset(ir.CONVERSIONS),
    carries_rules=True,
    places=Places(notation=words.NATIVE, rotation=Rotation.ZYX),
    settings=Settings(modal=True),
    io=Io(
        wait_timeout=True, timers=1_000_000, groups=frozenset((GroupRule.COMPUTED, GroupRule.FREE, GroupRule.NUMBERED))
    ),
    data=Data(
        composites=frozenset((Composite.ARRAYS, Composite.ENUMS, Composite.RECORDS)),
        aggregates=frozenset((Aggregate.NAMED, Aggregate.PARTIAL)),
    ),
    errors=Errors(handlers=True),
    routines=Routines(
        dynamic_calls=True,
        passing=frozenset((Passing.ARRAYS_BY_VALUE, Passing.OPTIONAL, Passing.REFERENCES, Passing.WRITTEN_LISTS)),
        locals=frozenset((Local.CLOCKS, Local.STATICS, Local.VARIABLES)),
    ),
    control=Control(
        short_circuit=True,
        counting=frozenset((Counting.AT_LEAST_ONCE, Counting.AUTOMATIC, Counting.REAL, Counting.SCOPED)),
    ),
)


def write(program: ir.Program, context: WriteContext) -> list[OutputFile]:
    """The program as one file, or one for each module."""
    style = context.options.get("files", "program")
    if style == "program":
        names = [program.entry, *(module.name for module in program.modules), "program"]
        return [_file(next(name for name in names if name), program_lines(program))]
    if style != "module":
        raise UsageError(f"option files is `program` or `module`, not {style!r}")
    files = [_file(module.name, module_lines(module)) for module in program.modules]
    tasks = [*entry_lines(program)]
    return [*files, _file("tasks", tasks)] if tasks else files


def program_text(program: ir.Program) -> str:
    """The text of a whole program."""
    return "".join(f"{line}\n" for line in program_lines(program))


def _file(name: str, lines: Iterable[str]) -> OutputFile:
    safe = re.sub(r"[^\w.-]", "_", name).strip(".") or "program"
    return OutputFile(f"{safe}.rpl", "".join(f"{line}\n" for line in lines).encode("utf-8"))
