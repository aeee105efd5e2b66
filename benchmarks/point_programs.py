"""How fast long lists of points are checked and translated, beside what other means need for the same text.

    python benchmarks/point_programs.py [--lines 20000] [--from krl] [--to rapid] [--alone]

Lines a second and bytes a line of whole commands, as a user calls them: processor time and the peak above that of a
program of twenty lines. Beside them, in this process: one regular expression over the text, Lark with the grammar on
the whole file (of 5,000 lines), and sqlglot on as many INSERT statements with the same numbers, where it is installed.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from importlib import import_module, resources
from importlib.util import find_spec
from pathlib import Path

from generate import POINTS
from lark import Lark

_NUMBER = re.compile(r"-?\d+(?:\.\d*)?")
_LARK_LINES = 5_000


def command(*arguments: str) -> tuple[float, int]:
    """Processor seconds and peak bytes of `rpl ARGUMENTS`."""
    child = os.posix_spawn(
        sys.executable,
        [sys.executable, "-m", "rpl.cli.main", *arguments],
        os.environ,
        file_actions=[(os.POSIX_SPAWN_OPEN, stream, os.devnull, os.O_WRONLY, 0) for stream in (1, 2)],
    )
    _, _, used = os.wait4(child, 0)
    return used.ru_utime + used.ru_stime, used.ru_maxrss * 1024


def timed(work: Callable[[], object]) -> float:
    started = time.process_time()
    work()
    return time.process_time() - started


def lark_on_the_file(text: str) -> float:
    """KRL by its own grammar, as one text: statements between line ends."""
    grammar = resources.files("rpl.grammars").joinpath("krl.lark").read_text("utf-8")
    parser = Lark(grammar + '\nfile: (statement? "\\n")*\n', parser="lalr", start="file", maybe_placeholders=False)
    return timed(lambda: parser.parse(text))


def sqlglot_on_rows(text: str) -> float:
    rows = [", ".join(_NUMBER.findall(line)) for line in text.splitlines()]
    script = ";\n".join(f"INSERT INTO points VALUES ({row or 0})" for row in rows)
    sqlglot = import_module("sqlglot")
    return timed(lambda: sqlglot.parse(script))


def told(what: str, lines: int, seconds: float, memory: int = 0) -> None:
    bytes_a_line = f", {memory / lines:,.0f} bytes a line" if memory else ""
    print(f"  {what:24} {lines:>9,} lines {seconds:8.2f} s {lines / seconds:>11,.0f} lines/s{bytes_a_line}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lines", type=int, default=20_000)
    parser.add_argument("--from", dest="names", action="append", choices=POINTS, help="only this language")
    parser.add_argument("--to", action="append", default=[], help="translate into this language, too")
    parser.add_argument("--alone", action="store_true", help="without the other means")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for name in given.names or POINTS:
            generate, path = POINTS[name]
            small, long = Path(folder) / f"small_{path}", Path(folder) / path
            small.write_text(generate(20))
            text = generate(given.lines)
            long.write_text(text)
            lines = text.count("\n")
            print(f"{name}:")
            for words in (["check"], *(["translate", "--to", target] for target in given.to if target != name)):
                _, least = command(*words, str(small))
                seconds, peak = command(*words, str(long))
                told("rpl " + " ".join(words), lines, seconds, peak - least)
            if given.alone:
                continue
            told("a regular expression", lines, timed(partial(_NUMBER.findall, text)))
            if name == "krl":
                few = generate(_LARK_LINES)
                told("Lark on the whole file", few.count("\n"), lark_on_the_file(few))
            if find_spec("sqlglot"):
                few = generate(_LARK_LINES)
                told("sqlglot on INSERT rows", few.count("\n"), sqlglot_on_rows(few))
            else:
                print("  sqlglot is not installed: left out")


if __name__ == "__main__":
    main()
