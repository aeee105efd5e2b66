"""What commands that prove have in common: the options that accept deviations, and the exit status of a verdict."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar, cast

import click

from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.proof.verdict import ProofResult

Decorated = TypeVar("Decorated", bound=Callable[..., Any])
# 3: done, but there is something that you must look at.
_SEED = 1
_STATUS = {"equal": 0, "alike": 3, "different": 1, "undecided": 1}


def accepting(command: Decorated) -> Decorated:
    """The options that say how far measures may deviate; the command gets them checked, as `accepted`."""

    @wraps(command)
    def with_limits(
        path_mm: float | None, corner_mm: float | None, time_share: float | None, accept: tuple[str, ...], **values: Any
    ) -> Any:
        from rpl.proof.tolerance import Accepted

        for name, limit in (("--path-mm", path_mm), ("--corner-mm", corner_mm), ("--time-share", time_share)):
            if limit is not None and not (limit >= 0.0 and math.isfinite(limit)):
                raise UsageError(f"{name}: {limit:g} is no limit; it takes a number from 0 on")
        return command(accepted=Accepted(frozenset(accept), path_mm, corner_mm, time_share), **values)

    options = (
        click.option(
            "--accept", multiple=True, metavar="WORD", help="Accept a measure of the proof or a report's code."
        ),
        click.option(
            "--path-mm",
            "--tolerance",
            type=float,
            metavar="MM",
            help="Accept tool paths that far apart outside of corners (usually 0.01 counts as equal).",
        ),
        click.option("--corner-mm", type=float, metavar="MM", help="Accept tool paths that far apart in corners."),
        click.option(
            "--time-share", type=float, metavar="SHARE", help="Accept moments that differ by this share of the time."
        ),
    )
    decorated: Any = with_limits
    for option in reversed(options):
        decorated = option(decorated)
    return cast(Decorated, decorated)


exploring = click.option(
    "--explore",
    is_flag=True,
    help="Compare in further cells too, found so that both programs go every way that can be gone.",
)


def teaching(command: Decorated) -> Decorated:
    """The options of re-teaching; the command gets `teach`, the seed or None, and `teach_mm`."""

    @wraps(command)
    def with_seed(teaching: bool, seed: int | None, teach_mm: float | None, **values: Any) -> Any:
        if not teaching and (seed is not None or teach_mm is not None):
            raise UsageError("--seed and --teach-mm say how --teach moves taught data: ask for it with --teach")
        if teach_mm is not None and not (teach_mm >= 0.0 and math.isfinite(teach_mm)):
            raise UsageError(f"--teach-mm: {teach_mm:g} is no distance; it takes a number from 0 on")
        return command(teach=(seed if seed is not None else _SEED) if teaching else None, teach_mm=teach_mm, **values)

    options = (
        click.option(
            "--teach",
            "teaching",
            is_flag=True,
            help="Prove again with every taught point, tool, frame and kept number moved alike in both.",
        ),
        click.option("--seed", type=int, metavar="N", help=f"Draw the amounts of --teach anew (usually {_SEED})."),
        click.option(
            "--teach-mm",
            type=float,
            metavar="MM",
            help="How far --teach moves at most; turns in proportion (usually 5).",
        ),
    )
    decorated: Any = with_seed
    for option in reversed(options):
        decorated = option(decorated)
    return cast(Decorated, decorated)


def status_of(result: ProofResult) -> int:
    """Exit status: 0 only for equal programs."""
    return _STATUS[result.verdict]


__all__ = ["accepting", "exploring", "status_of", "teaching"]
