"""The tables of docs/rpl.md, made from the data. Run this file to write them into the page."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from rpl import ir, registry
from rpl.ir import words

PAGE = Path(__file__).resolve().parents[2] / "docs" / "rpl.md"
_KINDS = {
    "n": "number",
    "i": "whole number",
    "b": "BOOL",
    "t": "text",
    "c": "character",
    "p": "pose or target",
    "v": "vector",
    "r": "rotation",
    "j": "joints",
    "x": "any value",
    "l": "place",
    "P": "pose",
    "J": "joints",
    "T": "tool",
    "W": "work object",
    "L": "load",
}


def _signature(function: ir.Function) -> str:
    parts = []
    for kind, mark in re.findall(r"(\w)([?*]?)", function.parameters):
        word = _KINDS[kind]
        parts.append(f"[{word}]" if mark == "?" else f"{word}..." if mark == "*" else word)
    return f"`{function.name}`({', '.join(parts)})"


def _result(function: ir.Function) -> str:
    return "like its argument" if function.result.isdigit() else _KINDS[function.result]


def _functions() -> str:
    rows = [f"| {_signature(f)} | {_result(f)} | {_cell(f.meaning)} |" for f in ir.FUNCTIONS.values()]
    return "\n".join(["| function | gives | meaning |", "|---|---|---|", *rows])


def _procedures() -> str:
    rows = [f"| {_signature(f)} | {_cell(f.meaning)} |" for f in ir.PROCEDURES.values()]
    return "\n".join(["| procedure | meaning |", "|---|---|", *rows])


def _system() -> str:
    rows = []
    for row in ir.SYSTEM_VARIABLES.values():
        index = "[n]" if row.indexed else ""
        access = "read and write" if row.access == "rw" else "read"
        kind = " ".join(part for part in (_KINDS[row.type], row.unit) if part)
        rows.append(f"| `${row.name}{index}` | {kind} | {access} | {_cell(row.meaning)} |")
    return "\n".join(["| variable | value | access | meaning |", "|---|---|---|---|", *rows])


def _types() -> str:
    plain = ", ".join(f"`{word.upper()}`" for word in words.TYPE_WORDS)
    rows = [
        f"Types: {plain}, `TARGET` and `CONFIGURATION` (of a notation: `TARGET.krl`), `ARRAY[...] OF ...`,",
        "`STRING[n]`, `SIGNAL kind`, `VENDOR language.name`, and the names of records, enumerations and aliases.",
        "",
        "| type | components |",
        "|---|---|",
    ]
    names: dict[type, str] = {type.__class__: word.upper() for word, type in words.TYPE_WORDS.items()}
    names[ir.TargetType] = "TARGET"
    for node, components in ir.COMPONENTS.items():
        rows.append(f"| `{names[node]}` | {', '.join(components)} |")
    return "\n".join(rows)


def _words() -> str:
    def listed(table: Mapping[str, str]) -> str:
        return ", ".join(f"`{word}` ({meaning.replace('_', ' ')})" for word, meaning in table.items())

    units = ", ".join(f"`{unit}`" for unit in words.UNIT_WORDS)
    conversions = ", ".join(f"`{word}`" for word in words.CONVERSION_WORDS)
    reserved = " ".join(sorted(words.RESERVED))
    return "\n".join(
        [
            f"Units: {units}.",
            "",
            f"Conversions: {conversions}.",
            "",
            f"Signals: {listed(words.SIGNAL_WORDS)}. By number `do[3]`, as a group `gi[1 TO 8]`, by name `do(lamp)`.",
            "",
            f"Reserved words, in backticks when they are names: {reserved}.",
        ]
    )


def _errors() -> str:
    names = registry.dialect("rpl").rules().errors
    rows = [f"| `{name}` | {number} |" for name, number in names.items()]
    return "\n".join(["| error | number |", "|---|---|", *rows])


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


TABLES = {
    "types": _types,
    "words": _words,
    "functions": _functions,
    "procedures": _procedures,
    "system": _system,
    "errors": _errors,
}


def with_tables(page: str) -> str:
    """The page with every table between its marks made anew."""
    for name, table in TABLES.items():
        pattern = re.compile(rf"<!-- {name} -->\n.*?<!-- end -->", re.DOTALL)
        text = f"<!-- {name} -->\n\n{table()}\n\n<!-- end -->"
        page = pattern.sub(lambda _, text=text: text, page)
    return page


if __name__ == "__main__":
    PAGE.write_text(with_tables(PAGE.read_text("utf-8")), "utf-8")
