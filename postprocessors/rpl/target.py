"""Files of RPL, and what RPL can say: everything."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import get_args

from rpl import ir
from rpl.errors import UsageError
from rpl.ir import words
from rpl.writing.target import Capabilities, NameRules, OutputFile, WriteContext

from .modules import entry_lines, module_lines, program_lines

CAPABILITIES = Capabilities(
    statements=frozenset(node.__name__ for node in get_args(ir.Statement)),
    functions=frozenset(ir.FUNCTIONS),
    procedures=frozenset(ir.PROCEDURES),
    system_variables=frozenset(ir.SYSTEM_VARIABLES),
    operators=frozenset((*ir.BINARY_OPERATORS, *ir.UNARY_OPERATORS)),
    types=frozenset(node.__name__ for node in get_args(ir.Type)),
    # In backticks a name may be spelled as its own language does, so that it still means what that language predefines.
    names=NameRules(
        longest=1000,
        case_sensitive=True,
        reserved=words.RESERVED,
        first="abcdefghijklmnopqrstuvwxyz_$",
        further="abcdefghijklmnopqrstuvwxyz0123456789_$.",
    ),
    modal_motion=True,
    notation=words.NATIVE,
    rotation="zyx",
    for_at_least_once=True,
    for_scoped=True,
    for_automatic=True,
    error_handlers=True,
    optional_parameters=True,
    short_circuit=True,
    enums=True,
    conversions=frozenset(ir.CONVERSIONS),
    for_real=True,
    wait_timeout=True,
    timers=1_000_000,
    dynamic_calls=True,
    named_aggregates=True,
    partial_aggregates=True,
    carries_rules=True,
    numbered_groups=True,
    static_locals=True,
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
