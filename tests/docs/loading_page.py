"""docs/loading.md: what controllers refuse to load, language by language, from the rules of the checkers.

python tests/docs/loading_page.py        writes the page
"""

from __future__ import annotations

import sys
from pathlib import Path

from rpl import registry

PAGE = Path(__file__).parents[2] / "docs" / "loading.md"
_HEAD = """# What controllers refuse to load

This page is generated from the rules: `python tests/docs/loading_page.py` makes it.

Our readers accept more than controllers do. `rpl check` warns of what the controller of the language refuses when it
loads a program, and of what loads but stops when it runs; what the writers write is held against the same rules by the
tests. Options of a controller are only named, as something that has to be there. The code of a warning is `load-` with
the name of its rule. The rules stand in `dialects/<name>/loading.py`; a rule marked `M` rests on memory.
"""


def page() -> str:
    lines = [_HEAD]
    for name in registry.dialect_names():
        dialect = registry.dialect(name)
        if dialect.loading is None:
            continue
        lines += [
            f"## {dialect.title}",
            "",
            "| rule | what must be so | otherwise | what to do | known from | |",
            "|---|---|---|---|---|---|",
        ]
        for rule in dialect.loading().rules:
            told = "option" if rule.option else ""
            cells = (f"`{rule.name}`", rule.says, rule.answer, rule.advice, f"{rule.trust}; {rule.source}", told)
            lines.append(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |")
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(0 if PAGE.write_text(page(), "utf-8") else 1)
