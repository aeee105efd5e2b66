"""What the writers write loads: a sample of each language in each target breaks no rule of the target's controller."""

from functools import cache
from pathlib import Path

import pytest

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_program
from rpl.source import source_from_bytes
from rpl.tomlfile import read_toml
from rpl.translation import translate_program

SAMPLES = Path(__file__).parents[2] / "samples"
# Rules that what is written still breaks, and why.
OPEN = {
    "rapid-named-twice": "modules and routines of one name",
    "tp-text-constant": "texts in registers would have to come as arguments of a call",
    "tp-text-comparison": "texts are compared by a jump only",
    "tp-text-argument": "as texts in registers",
    "tp-system-variable": "a free register keeps the number of the frame in force",
    "krl-reserved": "names of the source's own KRL",
}
LANGUAGES = sorted({path.parents[1].name for path in SAMPLES.glob("*/*/expected.toml")})
TARGETS = [name for name in registry.target_names() if name != "rpl" and registry.dialect(name).loading is not None]
PAIRS = [(source, target) for source in LANGUAGES for target in TARGETS if source != target]


@cache
def read(sample: Path) -> ReadProgram:
    return read_program([sample], None, Diagnostics())


def sample_of(source: str, target: str) -> Path:
    """Another sample for each target, so that all are seen by some."""
    found = sorted(path.parent for path in (SAMPLES / source).glob("*/expected.toml"))
    return found[TARGETS.index(target) % len(found)]


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_what_is_written_loads(source: str, target: str) -> None:
    sample = sample_of(source, target)
    robot = read_toml((sample / "expected.toml").read_text("utf-8"))["robot"]
    assert isinstance(robot, str)
    files = translate_program(read(sample), target, robot, None, Diagnostics()).files
    loading = registry.dialect(target).loading
    assert loading is not None
    broken = [
        f"{place.listing.source.path}:{place.listing.source.position(place.start)[0]}: {rule.name}"
        for rule, place in loading().broken([source_from_bytes(file.path, file.data) for file in files])
        if not rule.option and rule.name not in OPEN
    ]
    assert not broken
