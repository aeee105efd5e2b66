"""docs/passes.md: what translation rewrites, pass by pass, from the passes themselves.

python tests/docs/passes_page.py        writes the page
"""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import TypeGuard

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.pipeline import STAGES
from rpl.passes.legalise.stages import Pass, with_placed

PAGE = Path(__file__).parents[2] / "docs" / "passes.md"
ARM = "kuka_kr6r900sixx"  # any: some passes are needed only where an arm is named
_HEAD = """# What translation rewrites

This page is generated from the passes: `python tests/docs/passes_page.py` makes it.

A program is rewritten for what its target lacks, stage by stage in the order of this page; each stage stands once, and
`rpl/passes/legalise/<stage>/stage.py` lists its passes. What only one target needs stands in
`postprocessors/<target>/passes/` and takes its place in a stage. A pass is called where its target needs it and the
program holds something that it sees. What no pass rewrites is refused by name ([what is supported](support.md)).
"""

_LAST = """## In front of the writer

What one instruction of the target says together, and what its files share: `LAST` of `postprocessors/<target>/passes/`.
It is done when all names are given, also where a program is written in its own language.
"""


def purpose_of(one: Pass) -> str:
    """The first sentence of its file, or its own where the file holds several passes."""
    home = one.run.__module__
    if len({each.name for each in vars(import_module(home)).values() if _stands_in(each, home)}) > 1:
        return one.purpose
    text = " ".join((import_module(home).__doc__ or "").split())
    return text.split(". ")[0].rstrip(".")


def _stands_in(each: object, home: str) -> TypeGuard[Pass]:
    return isinstance(each, Pass) and each.run.__module__ == home


def targets_of(one: Pass) -> list[str]:
    """Targets that need the pass for at least one source."""
    arm = load_robot(ARM)
    names = registry.target_names()
    every = [each.one for target in names for each in registry.target(target).passes()]
    found = []
    for target in names:
        if one in every and one not in (each.one for each in registry.target(target).passes()):
            continue
        can = registry.target(target).capabilities()
        if can.carries_rules:
            continue
        for source in registry.dialect_names():
            if source != target and one.needed(Context(source, target, can, Diagnostics(), arm, arm)):
                found.append(target)
                break
    return found


def page() -> str:
    every = [name for name in registry.target_names() if not registry.target(name).capabilities().carries_rules]
    brought = tuple(each for target in registry.target_names() for each in registry.target(target).passes())
    lines = [_HEAD]
    for number, stage in enumerate(with_placed(STAGES, brought), 1):
        about = " ".join((import_module(f"rpl.passes.legalise.{stage.name}.stage").__doc__ or "").split())
        lines += [
            f"## {number}. {stage.name}",
            "",
            about,
            "",
            "| pass | what it does | for | sees |",
            "|---|---|---|---|",
        ]
        for one in stage.passes:
            targets = targets_of(one)
            shown = "all" if targets == every else ", ".join(targets)
            sees = ", ".join(f"`{kind}`" for kind in sorted(one.sees))
            home = one.run.__module__.rpartition(".")[2]
            lines.append(f"| `{home}.{one.name}` | {purpose_of(one)} | {shown} | {sees} |")
        lines.append("")
    return "\n".join([*lines, *last()])


def last() -> list[str]:
    """The passes right in front of the writers."""
    rows = [_LAST, "| pass | what it does | for |", "|---|---|---|"]
    for target in registry.target_names():
        for one in registry.target(target).last():
            home = import_module(one.__module__)
            text = " ".join((home.__doc__ or "").split()).split(". ")[0].rstrip(".")
            rows.append(f"| `{one.__module__.rpartition('.')[2]}.{one.__name__}` | {text} | {target} |")
    return [*rows, ""]


if __name__ == "__main__":
    sys.exit(0 if PAGE.write_text(page(), "utf-8") else 1)
