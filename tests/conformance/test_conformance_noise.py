"""The same answer on every machine: texts, verdicts, order of events and postures do not hang on the last bit that some
mathematical library or processor gives. See noise.py for the noise; each seed is a process of its own."""

import json
import os
import subprocess
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from noise import HERE, difference

SEEDS = (2, 3, 7)
# Corners of all kinds, a move to where the arm stands, stations computed in the run, half turns of the tool, splines,
# arcs and paths with actions on them, searches, several tasks, tracks and turntables.
CHOSEN = (
    "rapid-project:krl,tp",
    "krl-dispensing:rapid,tp",
    "krl-palletiser:urscript",
    "rapid-machine_tending:inform",
    "rapid-bin_search:rapid",
    "krl-turntable:inform",
    "vplus-reactions:rapid",
    "rpl-pick_and_place:inform",
)
# What NumPy and its linear algebra would do on a processor without AVX-512: other code, not only other bits.
OTHER_PROCESSOR = {"OPENBLAS_CORETYPE": "Haswell", "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL AVX512_SPR"}


@cache
def shown(seed: int, other_processor: bool = False) -> dict[str, object]:
    """What the chosen samples show with this noise."""
    added = OTHER_PROCESSOR if other_processor else {}
    command = [sys.executable, "-W", "ignore", str(HERE / "noise.py"), str(seed), *CHOSEN]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | added, check=False)
    assert done.returncode == 0, done.stderr
    return dict(json.loads(line) for line in done.stdout.splitlines())


@pytest.mark.parametrize(
    "seed", [pytest.param(seed, marks=[pytest.mark.slow] if number else []) for number, seed in enumerate(SEEDS)]
)
def test_nothing_hangs_on_the_last_bit(seed: int) -> None:
    assert difference(shown(0), shown(seed)) == ""


def test_nothing_hangs_on_the_processor() -> None:
    assert difference(shown(0), shown(0, other_processor=True)) == ""


def test_there_is_noise_of_one_unit() -> None:
    """The noise is what it says: off by at most one unit, the same for the same argument, and nothing where the value
    is known."""
    program = (
        "import math, sys; sys.path.insert(0, sys.argv[1]); import numpy as np; exact = math.sin; import noise;"
        "noise.make_noise(1); import json; points = [each / 7 for each in range(100)];"
        "print(json.dumps([[exact(x) for x in points], [math.sin(x) for x in points],"
        " np.sin(points).tolist(), [float(np.sin(x)) for x in points]]))"
    )
    done = subprocess.run([sys.executable, "-c", program, str(HERE)], capture_output=True, text=True, check=True)
    exact, one, many, single = (np.array(row) for row in json.loads(done.stdout))
    for noisy in (one, many):
        apart = np.abs(noisy - exact) / np.spacing(np.abs(exact))
        assert apart.max() <= 2.0, "more than a unit of the noise and one of the libraries"
        assert 0 < np.count_nonzero(apart) < 100
    assert many.tolist() == single.tolist()
    assert one[0] == many[0] == 0.0


def test_what_differs_is_seen() -> None:
    assert difference({"a": [1, 2.0]}, {"a": [1, 2.0 + 1e-9]}) == ""
    assert difference({"a": [1, 2.0]}, {"a": [1, 2.1]}) == " a[1]: 2.0 is 2.1"
    assert difference({"a": "x\ny\n"}, {"a": "x\nz\n"}) == " a[1]: 'y' is 'z'"
    assert difference([True], [1]) != ""


def test_the_chosen_samples_exist() -> None:
    for word in CHOSEN:
        language, _, sample = word.partition(":")[0].partition("-")
        assert (Path(HERE).parents[1] / "samples" / language / sample / "expected.toml").is_file(), word
