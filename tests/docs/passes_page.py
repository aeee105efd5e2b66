"""docs/passes.md: what translation rewrites, pass by pass, from the passes themselves.

python tests/docs/passes_page.py        writes the page
"""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.pipeline import PASSES
from rpl.passes.legalise.stages import Pass

PAGE = Path(__file__).parents[2] / "docs" / "passes.md"
ARM = "kuka_kr6r900sixx"  # any: some passes are needed only where an arm is named
_HEAD = """# What translation rewrites

This page is generated from the passes: `python tests/docs/passes_page.py` makes it.

A program is rewritten for what its target lacks, pass by pass. The passes stand in folders by what they are about
(`rpl/passes/legalise/`). A pass is called where its target needs it and the program holds something that it sees; the
number says when it runs. What no pass rewrites is refused by name ([what is supported](support.md)).
"""


def folder_of(one: Pass) -> str:
    return one.run.__module__.split(".")[3]


def purpose_of(one: Pass) -> str:
    """The first sentence of its file, or its own where the file holds several passes."""
    home = one.run.__module__
    if len({each.name for each in PASSES if each.run.__module__ == home}) > 1:
        return one.purpose
    text = " ".join((import_module(home).__doc__ or "").split())
    return text.split(". ")[0].rstrip(".")


def targets_of(one: Pass) -> list[str]:
    """Targets that need the pass for at least one source."""
    arm = load_robot(ARM)
    names = registry.target_names()
    found = []
    for target in names:
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
    folders: dict[str, list[tuple[int, Pass]]] = {}
    for number, one in enumerate(PASSES, 1):
        folders.setdefault(folder_of(one), []).append((number, one))
    lines = [_HEAD]
    for folder in sorted(folders):
        about = " ".join((import_module(f"rpl.passes.legalise.{folder}").__doc__ or "").split())
        lines += [f"## {folder}", "", about, "", "| | pass | what it does | for | sees |", "|---|---|---|---|---|"]
        for number, one in folders[folder]:
            targets = targets_of(one)
            shown = "all" if targets == every else ", ".join(targets)
            sees = ", ".join(f"`{kind}`" for kind in sorted(one.sees))
            home = one.run.__module__.rpartition(".")[2]
            lines.append(f"| {number} | `{home}.{one.name}` | {purpose_of(one)} | {shown} | {sees} |")
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(0 if PAGE.write_text(page(), "utf-8") else 1)
