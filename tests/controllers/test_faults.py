"""A sample of the fault table: whatever goes wrong, the old programs, the new ones, or a journal to be finished."""

from __future__ import annotations

from importlib.util import find_spec

import pytest

from rpl.controllers.vendors import vendors
from tests.controllers.fault_table import KILL, cases, ended
from tests.controllers.transfers import TRANSFERS

# The package that a maker's virtual controller needs.
NEEDS = {"abb": "aiohttp", "fanuc": "pyftpdlib", "ur": "asyncssh"}
EVERY = 16


def test_every_virtual_controller_has_a_transfer() -> None:
    assert {one.name for one in vendors() if one.dialect is not None} <= set(TRANSFERS)


@pytest.mark.parametrize("maker", sorted({one.name for one in vendors()} & set(TRANSFERS)))
def test_no_fault_leaves_a_controller_between_old_and_new(maker: str) -> None:
    needed = NEEDS.get(maker)
    if needed is not None and find_spec(needed) is None:
        pytest.skip(f"{needed} is not installed")
    every = list(cases(maker))
    chosen = [*every[::EVERY], *(case for case in every if case.fault in ("busy", "names", f"{KILL}:2"))]
    wrong = [f"{case.fault}: {found.wrong}" for case in chosen if (found := ended(case)).wrong]
    assert not wrong
