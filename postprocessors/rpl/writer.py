"""Files of RPL."""

from __future__ import annotations

import re
from collections.abc import Iterable

from rpl import ir
from rpl.errors import UsageError
from rpl.writing.target import OutputFile, WriteContext

from .modules import entry_lines, module_lines, program_lines


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


def _file(name: str, lines: Iterable[str]) -> OutputFile:
    safe = re.sub(r"[^\w.-]", "_", name).strip(".") or "program"
    return OutputFile(f"{safe}.rpl", "".join(f"{line}\n" for line in lines).encode("utf-8"))
