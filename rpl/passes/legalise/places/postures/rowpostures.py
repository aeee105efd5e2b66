"""The postures that a notation chooses for the moves of a stretch, all at once.

What `configurations` asks of an arm for one place it asks here for thousands: the same rules of the same notations,
over arrays. A row that needs a second question is asked alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, cast

from rpl.ir.columns import LooksInsideError, Stretch, in_each_row, stretch_of, whole_column

if TYPE_CHECKING:
    from rpl.emulator.configuration import BatchNotation, Notation

_AT_ONCE = 4096  # rows; all solutions of each are in memory


def stretch_of_matrix(matrix: list[list[float]]) -> Stretch | None:
    """The stretch whose rows have these poses (4x4); None for one pose."""
    return stretch_of(number for row in matrix for number in row)


def joints_in_rows(
    stretch: Stretch, notation: Notation, arm: Any, matrix: list[list[float]], flags: Mapping[str, int], joint: bool
) -> Iterator[Any]:
    """Joints (k, n) for the flange poses of some rows after those of others, by the flags of the source. joint: it must
    be as the flags say. Raises LooksInsideError where a row has no answer."""
    import numpy as np

    rules = _of_many(stretch, notation)
    count = len(stretch.rows)
    poses = np.stack([np.broadcast_to(in_each_row(one), count) for row in matrix for one in row], axis=-1)
    given = np.full((count, len(notation.fields)), np.nan)
    for at, name in enumerate(rules.fields):
        if name in flags:
            given[:, at] = in_each_row(flags[name])
    for first in range(0, count, _AT_ONCE):
        some = poses[first : first + _AT_ONCE].reshape(-1, 4, 4)
        joints = rules.select_all(arm, some, given[first : first + _AT_ONCE], None).joints
        for at in np.flatnonzero(np.isnan(joints[:, 0])).tolist():
            nearest = None if joint else arm.nearest(some[at], arm.home)
            if nearest is None:
                raise LooksInsideError(stretch)
            joints[at] = nearest
        yield joints


def flags_in_rows(stretch: Stretch, notation: Notation, arm: Any, joints: Iterator[Any]) -> dict[str, int]:
    """The flags that a notation has for such joints."""
    import numpy as np

    rules = _of_many(stretch, notation)
    found = np.concatenate([rules.encode_all(arm, some) for some in joints])
    return {name: whole_column(stretch, found[:, at]) for at, name in enumerate(rules.fields)}


def _of_many(stretch: Stretch, notation: Notation) -> BatchNotation:
    """The notation as one that answers for many places at once; those of a language's own may not."""
    if not hasattr(notation, "select_all"):
        raise LooksInsideError(stretch)
    return cast("BatchNotation", notation)


def degrees_in_rows(stretch: Stretch, names: tuple[str, ...], joints: Iterator[Any]) -> dict[str, int]:
    """Such joints to the degree."""
    import numpy as np

    found = np.concatenate([np.round(np.round(some, 6)) for some in joints])
    return {name: whole_column(stretch, values) for name, values in zip(names, found.T, strict=False)}
