"""Which taught data of a program means the same in its translation when it is taught anew: `rpl translate --teach`,
for many programs.

    python benchmarks/reteaching.py FOLDER... [--to TARGET...] [--seed N] [--names] [--into PAGE]

A folder is one program with its `expected.toml` (the arm) and `cell.toml`. Each is written in every target and both are
run and compared again with every point, tool, frame and kept number moved alike. A row counts, over the programs from
one language to another:

data         taught data of the sources
holds        means the same when it is taught anew at one place
copied       kept in several places of the output, which mean the same when all of them are taught
not          taught anew it means something else (a place that the output holds as joints, when its tool is taught)
not kept     nothing in the output holds it
not asked    the run does not come to it, or the arm cannot go there; or both programs differ as they are

--names prints which. --into puts the table between the marks of a page (docs/output.md).
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import sys
import tomllib
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from rpl.cli.main import run

LANGUAGES = ("krl", "rapid", "tp", "inform", "urscript", "vplus")
_BEGIN, _END = "<!-- re-taught -->", "<!-- re-taught until here -->"
_COLUMNS = {"holds": "holds", "copied": "copied", "fails": "not", "missing": "not kept", "unasked": "not asked"}
_UNASKED = ("unreached", "unmoved")

Rows = dict[tuple[str, str], Counter[str]]


def language_of(folder: Path) -> str:
    """The language of samples/<language>/<task>."""
    return folder.resolve().parent.name


def asked(folder: Path, target: str, seed: int) -> Mapping[str, object]:
    """What `rpl translate --teach --json` says of a program; empty where it says nothing."""
    expected = tomllib.loads((folder / "expected.toml").read_text("utf-8"))
    words = ["translate", str(folder), "--to", target, "--json", "--teach", "--seed", str(seed)]
    words += ["--robot", expected["robot"]] if "robot" in expected else []
    words += ["--cell", str(folder / "cell.toml")] if (folder / "cell.toml").exists() else []
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(io.StringIO()):
        run(words)
    text = said.getvalue()
    found: dict[str, object] = json.loads(text).get("proof") or {} if text.strip() else {}
    return found


def counted(proof: Mapping[str, object]) -> tuple[Counter[str], list[str]]:
    """The data by what became of it, and the names of what does not hold."""
    retaught = proof.get("taught")
    if not isinstance(retaught, dict) or retaught["note"]:
        return Counter(programs_unasked=1), [str(retaught["note"]) if isinstance(retaught, dict) else "no verdict"]
    found: Counter[str] = Counter()
    names = []
    for one in retaught["data"]:
        state = "unasked" if one["state"] in _UNASKED else one["state"]
        found[state] += 1
        names += [f"{one['state']} {one['name']}: {one['reason']}"] if state != "holds" else []
    return found, names


def measured(folders: Sequence[Path], targets: Sequence[str], seed: int, names: bool) -> Rows:
    """The counts of all programs, by source and target."""
    rows: Rows = {}
    for folder in folders:
        source = language_of(folder)
        for target in (one for one in targets if one != source):
            found, told = counted(asked(folder, target, seed))
            rows.setdefault((source, target), Counter()).update(found)
            print(f"{folder.name} {source} -> {target}: {dict(found)}", file=sys.stderr, flush=True)
            for line in told if names else ():
                print(f"  {line}", file=sys.stderr)
    return rows


def table(rows: Rows) -> str:
    """The rows and their sum, in Markdown."""
    lines = [f"| from | to | data | {' | '.join(_COLUMNS.values())} |", f"|---|---|{'---:|' * (len(_COLUMNS) + 1)}"]
    whole: Counter[str] = Counter()
    for (source, target), found in sorted(rows.items()):
        whole.update(found)
        lines.append(_line(source, target, found))
    return "\n".join([*lines, _line("all", "all", whole)])


def _line(source: str, target: str, found: Counter[str]) -> str:
    data = sum(found[state] for state in _COLUMNS)
    differ = found["programs_unasked"]
    told = f" (and {differ} program{'' if differ == 1 else 's'})" if differ else ""
    cells = [str(data), *(str(found[state]) for state in _COLUMNS)]
    return f"| {source} | {target} | {' | '.join(cells)}{told} |"


def put_into(page: Path, text: str) -> None:
    """The table between the marks of a page. Raises ValueError where it has no marks."""
    before, begin, rest = page.read_text("utf-8").partition(_BEGIN)
    _, end, behind = rest.partition(_END)
    if not begin or not end:
        raise ValueError(f"{page} has no {_BEGIN} and {_END}")
    page.write_text(f"{before}{begin}\n\n{text}\n\n{end}{behind}", "utf-8")


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=Path, nargs="+", help="programs: samples/<language>/<task>")
    parser.add_argument("--to", nargs="+", default=list(LANGUAGES), choices=LANGUAGES)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--names", action="store_true", help="name what does not hold, and why")
    parser.add_argument("--into", type=Path, metavar="PAGE", help="put the table between the marks of this page")
    options = parser.parse_args(arguments)
    text = table(measured(options.folders, options.to, options.seed, options.names))
    print(text)
    if options.into is not None:
        put_into(options.into, text)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
