"""Does a written file load? What a controller checks before it looks at the program: characters, lines, names."""

from __future__ import annotations

from collections.abc import Iterator

from rpl import registry
from rpl.ir.walk import walk
from rpl.project import ReadProgram
from rpl.writing.target import OutputFile


def objections(files: tuple[OutputFile, ...], back: ReadProgram, target: str) -> list[str]:
    """What the target's controller would refuse of the written files and of what was read back from them."""
    return [*_texts(files, target), *_names(back, target), *_unread(back)]


def _texts(files: tuple[OutputFile, ...], target: str) -> Iterator[str]:
    record = registry.target(target)
    for file in files:
        text = None
        for encoding in record.encodings:
            try:
                text = file.data.decode(encoding)
                break
            except UnicodeDecodeError:
                continue
        if text is None:
            yield f"{file.path}: not in {' or '.join(record.encodings)}"
            continue
        for number, line in enumerate(text.splitlines(), 1):
            if record.longest_line and len(line) > record.longest_line:
                yield f"{file.path}:{number}: {len(line)} characters, {record.longest_line} are read"


def _names(back: ReadProgram, target: str) -> Iterator[str]:
    rules = registry.target(target).capabilities().names
    for module in back.program.modules:
        for routine in module.routines:
            if len(routine.name) > rules.longest:
                yield f"{routine.name}: a name of more than {rules.longest} characters"


def _unread(back: ReadProgram) -> Iterator[str]:
    from rpl import ir

    for report in back.files:
        if report.opaque:
            yield f"{report.path}: {report.opaque} statements cannot be read back"
    for module in back.program.modules:
        for node in walk(module.declarations):
            if isinstance(node, ir.Unread) and node.text:
                yield f"{module.name}: {node.text}"
