"""`rpl dialects`: the languages there are."""

from __future__ import annotations

import click

from rpl import registry
from rpl.cli.output import json_option, print_json, say


@click.command("dialects")
@json_option
def command(as_json: bool) -> int:
    """List the languages that can be read and written."""
    reads, writes = set(registry.dialect_names()), set(registry.target_names())
    rows: list[dict[str, object]] = []
    for name in sorted(reads | writes):
        dialect = registry.dialect(name) if name in reads else None
        title = dialect.title if dialect else registry.target(name).title
        extensions = list(dialect.extensions) if dialect else []
        aliases = [*(dialect.aliases if dialect else ()), *(registry.target(name).aliases if name in writes else ())]
        rows.append(
            {
                "name": name,
                "title": title,
                "reads": name in reads,
                "writes": name in writes,
                "extensions": extensions,
                "aliases": aliases,
            }
        )
        if not as_json:
            does = f"{'reads' if name in reads else '':<6}{'writes' if name in writes else '':<7}"
            also = f"  (also: {', '.join(aliases)})" if aliases else ""
            say(f"{name:<10} {title:<46} {does} {' '.join(extensions)}{also}")
    if as_json:
        print_json(rows)
    return 0
