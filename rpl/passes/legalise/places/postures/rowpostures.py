"""The postures that a notation chooses for the moves of a stretch, all at once.

What `configurations` asks of an arm for one place it asks here for thousands: the same rules of the same notations,
over arrays. A row that needs a second question is asked alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, cast

from rpl.ir.columns import LooksInsideError, Stretch, in_each_row, stretch_of, whole_column

if TYPE_CHECKING:
    from rpl.emulator.configuration import BatchNotation, Notation

_AT_ONCE = 4096  # rows; all solutions of each are in memory
_EQUAL = 1e-4  # ways (degrees) that differ by less may be taken otherwise one by one
# Another arm's joints for one flange pose that this arm reaches with such joints, and whether that is told.
OnOtherArm = Callable[[Any, Any], tuple[Any, bool]]


def stretch_of_matrix(matrix: list[list[float]]) -> Stretch | None:
    """The stretch whose rows have these poses (4x4); None for one pose."""
    return stretch_of(number for row in matrix for number in row)


def flanges_in_rows(stretch: Stretch, matrix: list[list[float]]) -> Any:
    """The poses (k, 4, 4) of all rows."""
    import numpy as np

    count = len(stretch.rows)
    poses = np.stack([np.broadcast_to(in_each_row(one), count) for row in matrix for one in row], axis=-1)
    return poses.reshape(-1, 4, 4)


def joints_in_rows(
    stretch: Stretch, notation: Notation, arm: Any, flanges: Any, flags: Mapping[str, int], joint: bool, had: bool
) -> Iterator[Any]:
    """Joints (k, n) for the flange poses of some rows after those of others, by the flags of the source; NaN where the
    arm does not come to. joint: it must be as the flags say; had: there are some. Raises LooksInsideError where a joint
    move has no answer."""
    import numpy as np

    rules = _of_many(stretch, notation)
    given = np.full((len(flanges), len(notation.fields)), np.nan)
    for at, name in enumerate(rules.fields):
        if name in flags:
            given[:, at] = in_each_row(flags[name])
    for first in range(0, len(flanges), _AT_ONCE):
        some = flanges[first : first + _AT_ONCE]
        joints = rules.select_all(arm, some, given[first : first + _AT_ONCE], None if had else arm.home).joints
        left = np.flatnonzero(np.isnan(joints[:, 0]))
        if joint and len(left):
            missing = np.zeros(len(flanges), dtype=np.bool_)
            missing[first + left] = True
            _answered(stretch, missing)
        elif len(left):
            solutions = arm.inverse_batch(some[left], arm.home).joints
            joints[left] = arm.nearest_of(solutions, np.broadcast_to(arm.home, (len(left), arm.axes)))
        yield joints


def _answered(stretch: Stretch, missing: Any) -> None:
    """Raises LooksInsideError where some of the rows have no answer."""
    if moves := stretch.moves_where(missing):
        raise LooksInsideError(stretch, moves)


def all_there(stretch: Stretch, arm: Any, joints: Iterator[Any]) -> Iterator[Any]:
    """Such joints, where each row that is asked for has some. Raises LooksInsideError where one has not."""
    import numpy as np

    whole = np.concatenate(list(joints))
    missing = np.isnan(whole[:, 0])
    _answered(stretch, missing)
    whole[missing] = arm.home  # of rows that nobody asks for
    yield whole


def joints_on_other_arm(
    stretch: Stretch, arm: Any, other: Any, flanges: Any, joints: Iterator[Any], alone: OnOtherArm
) -> Iterator[Any]:
    """The other arm's joints for flange poses that the arm reaches with such joints: what `alone` finds for each.
    Raises LooksInsideError where a row has no answer, or one that is told."""
    import numpy as np

    told, whole, first = np.zeros(len(flanges), dtype=np.bool_), list[Any](), 0
    for some in joints:
        poses = flanges[first : first + len(some)]
        found, sure = nearest_by_name(arm, other, poses, some)
        for at in np.flatnonzero(~sure & stretch.asked[first : first + len(some)]).tolist():
            one, changed = alone(poses[at], None if np.isnan(some[at, 0]) else some[at])
            told[first + at] = one is None or changed
            if one is not None:
                found[at] = one
        whole.append(found)
        first += len(some)
    _answered(stretch, told)
    yield from whole


def nearest_by_name(arm: Any, other: Any, flanges: Any, joints: Any) -> tuple[Any, Any]:
    """Joints (k, m) of the other arm, and (k,) which of them are surely what is found for one pose alone: in a posture
    of the same names where this arm has one, and nothing else is as near but for rounding."""
    import numpy as np

    unknown = np.isnan(joints[:, 0])  # this arm does not come there: any posture of the other one is as good
    near = np.where(unknown[:, None], other.home, arm.same_posture(joints, other))
    found = other.inverse_batch(flanges, near)
    choices = other.nearest_turn(found.joints, near[:, None])
    away = np.abs(choices - near[:, None])
    alike = unknown[:, None] | (other.sides(found.joints) == arm.sides(joints)[:, None]).all(axis=-1)
    slack = 1e-6  # as limits have it
    with np.errstate(invalid="ignore"):
        inside = ((choices >= other.limits[:, 0] - slack) & (choices <= other.limits[:, 1] + slack)).all(axis=-1)
        halfway = (np.abs(away - 180.0) < _EQUAL).any(axis=-1)
    travel = np.where(found.valid & inside & alike, away.sum(axis=-1), np.inf)
    order = np.sort(travel, axis=1)
    best = travel.argmin(axis=1)
    rows = np.arange(len(flanges))
    sure = np.isfinite(order[:, 0]) & ~halfway[rows, best]
    if order.shape[1] > 1:
        with np.errstate(invalid="ignore"):
            sure &= ~(order[:, 1] - order[:, 0] < _EQUAL)
    return np.where(np.isfinite(order[:, :1]), choices[rows, best], np.nan), sure


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
