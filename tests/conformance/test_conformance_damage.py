"""Damaged programs of every language: reading and translating them reports, and never fails.

Driven by the registry and the samples; names no vendor. Each file of a sample is damaged a few times in ways that
editors and transfers damage programs. Every sign of the damaged text has to be claimed by its reader, and a translation
into a language that is drawn ends, or is refused by an error of ours. The draw depends on the sample's name alone.
"""

import random
import tomllib
from pathlib import Path

import pytest

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.errors import InternalError, RplError
from rpl.project import read_sources
from rpl.reading import assemble
from rpl.reading.ledger import Ledger
from rpl.source import Source, source_from_bytes, source_from_text
from rpl.translation import translate_program

ROOT = Path(__file__).parents[2]
SAMPLES = sorted(path.parent for path in (ROOT / "samples").glob("*/*/expected.toml"))
DAMAGES = ("line lost", "line twice", "token cut", "lines swapped", "end lost", "sign added")
PER_SAMPLE = 3
ZERO_BYTES = "zero-bytes"
SIGNS = "()[]{}\"'=,;:!#x9-\\\x00é"

each_sample = pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: f"{sample.parent.name}-{sample.name}")


def damaged(text: str, damage: str, rng: random.Random) -> str:
    """The text with one damage somewhere."""
    lines = text.splitlines(keepends=True)
    at = rng.randrange(len(lines))
    match damage:
        case "line lost":
            del lines[at]
        case "line twice":
            lines.insert(rng.randrange(len(lines) + 1), lines[at])
        case "token cut":
            tokens = lines[at].split(" ")
            del tokens[rng.randrange(len(tokens))]
            lines[at] = " ".join(tokens)
        case "lines swapped":
            other = rng.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        case "sign added":
            column = rng.randrange(len(lines[at]))
            lines[at] = lines[at][:column] + rng.choice(SIGNS) + lines[at][column:]
        case _:
            return text[: rng.randrange(len(text))]
    return "".join(lines)


def sources_of(sample: Path) -> list[Source]:
    described = tomllib.loads((sample / "expected.toml").read_text("utf-8"))
    beside = {"expected.toml", described.get("cell", "expected.toml")}
    files = [file for file in sorted(sample.rglob("*")) if file.is_file() and file.name not in beside]
    return [source_from_bytes(str(file.relative_to(sample)), file.read_bytes()) for file in files]


@pytest.fixture
def ledgers(monkeypatch: pytest.MonkeyPatch) -> list[Ledger]:
    """The ledgers of everything that is read, in order."""
    kept: list[Ledger] = []

    def kept_ledger(source: Source) -> Ledger:
        kept.append(Ledger(source))
        return kept[-1]

    monkeypatch.setattr(assemble, "Ledger", kept_ledger)
    return kept


@each_sample
def test_damage_is_reported_and_never_raises(sample: Path, ledgers: list[Ledger]) -> None:
    rng = random.Random(f"{sample.parent.name}/{sample.name}")
    robot = tomllib.loads((sample / "expected.toml").read_text("utf-8"))["robot"]
    whole = sources_of(sample)
    for damage in rng.sample(DAMAGES, PER_SAMPLE):
        sources, hurt = list(whole), rng.randrange(len(whole))
        sources[hurt] = source_from_text(whole[hurt].path, damaged(whole[hurt].text, damage, rng))
        ledgers.clear()
        diagnostics = Diagnostics()
        read = read_sources(sources, sample.parent.name, diagnostics)
        assert {report.path for report in read.files} == {source.path for source in sources}, damage
        if "\x00" in sources[hurt].text:  # the file is refused as a whole
            assert ZERO_BYTES in {item.code.name for item in diagnostics if item.origin.file == sources[hurt].path}
            continue
        assert ledgers, damage
        for ledger in ledgers:
            assert not ledger.gaps(), damage
            assert ledger.rebuilt() == ledger.source.text, damage
        target = rng.choice(registry.target_names())
        try:
            translate_program(read, target, robot)
        except InternalError:
            raise
        except RplError as error:
            assert str(error), f"{damage}, to {target}"
