"""The self-checking projects on their own arms, and what is left of their expectations in every other language.

`pairs.json` says what was found last (`python tests/selfcheck/pairs.py` writes it): a pair that loses or gains one is
seen. An expectation that is missed although nothing was refused is a mistranslation, whatever the file says. The
newest project of each language goes to every target, of the others one target in three (`make test-long`: all).
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from pairs import PROJECTS, TARGETS, own_run, pair_of, recorded


@pytest.mark.parametrize("name", PROJECTS)
def test_every_expectation_is_met_on_the_own_arm(name: str) -> None:
    end, on = own_run(name)
    assert (end, set(range(1, PROJECTS[name].count + 1)) - on) == ("finished", set())


def pairs_in_turn() -> Iterator[object]:
    newest = {name.partition("_")[0]: name for name in PROJECTS}.values()
    for number, name in enumerate(PROJECTS):
        for place, target in enumerate(TARGETS):
            quick = name in newest or (number + place) % 3 == 0
            yield pytest.param(name, target, marks=() if quick else pytest.mark.slow)


@pytest.mark.parametrize(("name", "target"), list(pairs_in_turn()))
def test_what_is_left_after_translation(name: str, target: str) -> None:
    pair = pair_of(name, target)
    assert pair.losses or not pair.missed, f"missed {pair.missed} although nothing was refused: {pair.end}"
    assert not [loss for loss in pair.losses if loss.startswith("0:")], "a loss without a place in the source"
    known = recorded().get(name, {}).get(target)
    assert known is None or list(pair.missed) == known["missed"], pair.losses
