"""What `equal` means: events first, then geometry, then time. Each level is asked only when the ones before it hold.

Events: per task the same outputs, messages, dialogs, blocking waits and end, in the same order with the same values.
Geometry: the tool goes the same way, stops in the same joints (on the same arm), and outputs switch at the same place.
A group of outputs is its bits where one of the two switches them singly (bits.py).
Time: every happening comes at the same moment; asked only of programs in the same language on the same arm, because
two controllers never agree on accelerations.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rpl.proof.bits import in_bits
from rpl.proof.difference import Difference, Side
from rpl.proof.messages import as_lines, same_message
from rpl.proof.paths import gap
from rpl.proof.record import Happening, Record, Stretch, Value

if TYPE_CHECKING:
    from rpl.emulator.rotations import FloatArray

LEVELS = ("none", "events", "geometry", "time")
# Moves of two programs whose goals are that near to each other head for one point.
_SAME_GOAL_MM = 0.1


@dataclass(frozen=True, slots=True)
class Tolerance:
    """What still counts as equal. The printed precision decides: three decimals of a millimetre leave 0.0005 mm per
    coordinate and four of a degree 0.00005 deg, which a reach of 2 m turns into less than 0.002 mm; 0.01 mm is safely
    above and far below anything that a robot repeats.

    place_mm: where on a moving path an output may switch. wait_s: of a timed wait. time_share: of a whole run's time.
    polling_share: of the time since the start, by which two polling loops may differ (other accelerations before them).
    look_s: a single wait up to this long may be one look of a polling loop. step_s: a controller's cycle.
    """

    path_mm: float = 0.01
    turn_deg: float = 0.01
    joint_deg: float = 0.01
    place_mm: float = 1.0
    wait_s: float = 0.002
    time_s: float = 0.01
    time_share: float = 0.01
    polling_share: float = 0.05
    look_s: float = 0.1
    step_s: float = 0.01
    number: float = 1e-6


@dataclass(slots=True)
class Verdict:
    """level: the highest level at which no difference was found. corners: how many corners of joint moves were compared
    by their programmed points only, because two controllers measure such a blend differently; max_corner_mm: how far
    apart the tool went there."""

    level: str = "none"
    difference: Difference | None = None
    max_path_mm: float = 0.0
    max_joint_deg: float = 0.0
    max_time_s: float = 0.0
    corners: int = 0
    max_corner_mm: float = 0.0


def compare(a: Record, b: Record, tolerance: Tolerance) -> Verdict:
    """Compare two runs level by level; stop at the first level that differs."""
    verdict = Verdict()
    a, b = in_bits(a, b)
    verdict.difference = _events(a, b, tolerance)
    if verdict.difference is not None:
        _measure_anyway(a, b, tolerance, verdict)
        return verdict
    verdict.level = "events"
    verdict.difference = _geometry(a, b, tolerance, verdict)
    if verdict.difference is not None:
        return verdict
    verdict.level = "geometry"
    if a.robot == b.robot and a.language == b.language:
        verdict.difference = _time(a, b, tolerance, verdict)
        if verdict.difference is None:
            verdict.level = "time"
    return verdict


def _measure_anyway(a: Record, b: Record, tolerance: Tolerance, verdict: Verdict) -> None:
    _geometry(a, b, tolerance, verdict)


# Events


def _events(a: Record, b: Record, tolerance: Tolerance) -> Difference | None:
    """The first event that differs in any task; tasks are paired by name, a single one with a single one."""
    pairs = _paired(a, b)
    if isinstance(pairs, Difference):
        return pairs
    found = []
    for task, ours, theirs in pairs:
        if a.language != b.language:
            ours, theirs = _without_conditions(ours), _without_conditions(theirs)
        difference = _task_events(task, ours, theirs, tolerance, a.language != b.language)
        if difference is not None:
            found.append(difference)
    return min(found, key=_when) if found else None


def _without_conditions(happenings: tuple[Happening, ...]) -> tuple[Happening, ...]:
    """Whether a condition had to be waited for depends on how fast each controller was before."""
    return tuple(one for one in happenings if not (one.kind == "wait" and one.value is None))


def _when(difference: Difference) -> float:
    times = [side.t for side in (difference.a, difference.b) if side.t is not None]
    return min(times, default=0.0)


Tasks = dict[str, tuple[Happening, ...]]
Pair = tuple[str, tuple[Happening, ...], tuple[Happening, ...]]


def _paired(a: Record, b: Record) -> list[Pair] | Difference:
    if len(a.tasks) == 1 and len(b.tasks) == 1:
        (name, ours), (_, theirs) = next(iter(a.tasks.items())), next(iter(b.tasks.items()))
        return [(name, ours, theirs)]
    left = {name.lower(): happenings for name, happenings in a.tasks.items()}
    right = {name.lower(): happenings for name, happenings in b.tasks.items()}
    if a.language != b.language:
        left, right = _with_helpers(left, right), _with_helpers(right, left)
    if set(left) != set(right):
        lone = sorted(set(left) ^ set(right))[0]
        there = "A" if lone in left else "B"
        return Difference(
            "task",
            "events",
            f"only {there} has a task {lone}",
            Side(f"tasks {', '.join(left)}"),
            Side(f"tasks {', '.join(right)}"),
            lone,
        )
    return [(name, left[name], right[name]) for name in left]


def _with_helpers(tasks: Tasks, others: Tasks) -> Tasks:
    """Tasks that only one language needs, for what the other's controller does by itself, are a part of the first task:
    what they switch and say is, not that they wait and end."""
    first = next((name for name in tasks if name in others), "")
    extra = [name for name in tasks if name not in others]
    if not extra or not first:
        return tasks
    shown = [one for name in extra for one in tasks[name] if one.kind not in ("wait", "end")]
    kept = {name: happenings for name, happenings in tasks.items() if name not in extra}
    every = sorted((*tasks[first], *shown), key=lambda one: (one.kind == "end", one.t, one.number))
    return kept | {first: tuple(every)}


def _task_events(
    task: str, ours: Sequence[Happening], theirs: Sequence[Happening], tolerance: Tolerance, foreign: bool
) -> Difference | None:
    """The first two that differ. `foreign`: where only one language looks again and again for what the other waits for
    (which is no event by itself), its looks count for nothing."""
    for first, second in _matched(ours, theirs, tolerance, foreign):
        if first is None or second is None or not same_event(first, second, tolerance):
            return _event_difference(task, first, second)
    return None


def _matched(
    ours: Sequence[Happening], theirs: Sequence[Happening], tolerance: Tolerance, foreign: bool
) -> Iterator[tuple[Happening | None, Happening | None]]:
    """Happening beside happening, also where they differ, without the looks that only one language has."""
    at, there = 0, 0
    while at < len(ours) or there < len(theirs):
        first = ours[at] if at < len(ours) else None
        second = theirs[there] if there < len(theirs) else None
        same = first is not None and second is not None and same_event(first, second, tolerance)
        split = foreign and (not same or (first is not None and first.kind == "message"))
        lines = as_lines(ours[at:], theirs[there:]) if split else (1, 1)
        if first is not None and second is not None and lines != (1, 1):
            whole = second if lines[0] > 1 else first
            yield replace(first, value=whole.value), replace(second, value=whole.value)
            at, there = at + lines[0], there + lines[1]
        elif not same and foreign and first is not None and _is_looking(first, tolerance):
            at += 1
        elif not same and foreign and second is not None and _is_looking(second, tolerance):
            there += 1
        else:
            yield first, second
            at, there = at + 1, there + 1


def _is_looking(happening: Happening, tolerance: Tolerance) -> bool:
    """Is it a loop of short waits, as programs have that look for a condition, or the only cycle of one?"""
    if happening.kind != "wait" or happening.value is None:
        return False
    longest = tolerance.look_s if happening.times > 1 else tolerance.step_s
    return happening.longest_s <= longest


def same_event(a: Happening, b: Happening, tolerance: Tolerance) -> bool:
    """Do two happenings mean the same, apart from when and where on the path?"""
    if a.kind != b.kind:
        return False
    match a.kind:
        case "output":
            return bool(a.names & b.names) and same_value(a.value, b.value, tolerance.number)
        case "wait":
            return same_value(a.value, b.value, tolerance.wait_s) or _same_polling(a, b, tolerance)
        case "message":
            return same_message(a, b)
        case "dialog":
            return " ".join(str(a.value).split()) == " ".join(str(b.value).split())
        case _:
            return a.value == b.value


def _same_polling(a: Happening, b: Happening, tolerance: Tolerance) -> bool:
    """A polling loop may end as much earlier or later as it began later or earlier; and where one language waits for a
    condition with a time-out, another has to look again and again."""
    if (a.value is None) != (b.value is None):
        polling = b if a.value is None else a
        return polling.times > 1 or polling.longest_s <= tolerance.look_s
    if a.times == b.times or not isinstance(a.value, int | float) or not isinstance(b.value, int | float):
        return False
    slack = max(2.0 * max(a.longest_s, b.longest_s), tolerance.polling_share * max(a.t + a.value, b.t + b.value))
    return abs(a.value - b.value) <= slack


def same_value(a: Value, b: Value, slack: float) -> bool:
    """Numbers within the slack (relative above 1); TRUE is 1 and FALSE is 0."""
    if isinstance(a, int | float) and isinstance(b, int | float):
        return abs(float(a) - float(b)) <= slack * max(1.0, abs(float(a)), abs(float(b)))
    return a == b


def in_words(happening: Happening) -> str:
    """What happened, for people."""
    match happening.kind:
        case "output":
            return f"output {_shown_name(happening.names)} becomes {_shown(happening.value)}"
        case "message" | "dialog":
            return f"{happening.kind} {_shown(happening.value)}"
        case "wait":
            return "waits for a condition" if happening.value is None else f"waits {happening.value:g} s"
        case "fault":
            return f"fault {happening.value}"
        case _:
            return f"ends: {happening.value}"


def _shown_name(names: frozenset[str]) -> str:
    return min(names, key=lambda name: (":" in name, name), default="?")


def _shown(value: Value) -> str:
    return str(value).upper() if isinstance(value, bool) else repr(value)


def side(happening: Happening | None) -> Side:
    if happening is None:
        return Side(None)
    return Side(in_words(happening), happening.place, happening.t, happening.value)


def _event_difference(task: str, a: Happening | None, b: Happening | None) -> Difference:
    some = a if a is not None else b
    assert some is not None
    kind = some.kind if a is None or b is None or a.kind == b.kind else "order"
    if a is None or b is None:
        text = f"{'A' if b is None else 'B'} goes on where the other has ended"
    elif a.kind != b.kind:
        text = f"the order differs: {in_words(a)} in A, {in_words(b)} in B"
    elif a.kind == "output" and not a.names & b.names:
        text = f"different outputs are switched: {_shown_name(a.names)} in A, {_shown_name(b.names)} in B"
    else:
        text = f"{some.kind} differs: {_shown(a.value)} in A, {_shown(b.value)} in B"
    return Difference(kind, "events", text, side(a), side(b), task)


# Geometry


def _geometry(a: Record, b: Record, tolerance: Tolerance, verdict: Verdict) -> Difference | None:
    same_arm, same_language = a.robot == b.robot, a.language == b.language
    for task in a.motion:
        theirs = b.motion.get(task)
        if theirs is None:
            theirs = next(iter(b.motion.values()), ()) if len(a.motion) == 1 else ()
        difference = _motion(task, a.motion[task], theirs, (same_arm, same_language), tolerance, verdict)
        if difference is not None:
            return difference
    if verdict.corners:
        return None  # the ways have other lengths, so a place along them says nothing
    pairs = _paired(a, b)
    if isinstance(pairs, Difference):
        return pairs
    for task, ours, others in pairs:
        if not same_language:
            ours, others = _without_conditions(ours), _without_conditions(others)
        for first, second in _matched(ours, others, tolerance, not same_language):
            if first is None or second is None:
                break
            if not same_language and _in_joint_move(a, task, first) and _in_joint_move(b, task, second):
                verdict.corners += 1
                verdict.max_corner_mm = max(verdict.max_corner_mm, abs(first.along - second.along))
                continue
            slack = tolerance.place_mm if first.moving or second.moving else 10.0 * tolerance.path_mm
            if first.kind == "output" and same_arm and abs(first.along - second.along) > slack:
                text = (
                    f"{in_words(first)} after {first.along:.3f} mm of the path in A, after {second.along:.3f} mm in B"
                )
                return Difference("place", "geometry", text, side(first), side(second), task)
    return None


def _in_joint_move(record: Record, task: str, happening: Happening) -> bool:
    """Did it come while a joint move was on its way? A program goes on there where the controller's own measure of such
    a move's corner lets it."""
    ways = record.motion.get(task) or (next(iter(record.motion.values())) if len(record.motion) == 1 else ())
    return any(stretch.motion == "joint" and stretch.times[0] < happening.t < stretch.times[-1] for stretch in ways)


def _motion(
    task: str,
    ours: Sequence[Stretch],
    theirs: Sequence[Stretch],
    same: tuple[bool, bool],
    tolerance: Tolerance,
    verdict: Verdict,
) -> Difference | None:
    same_arm, same_language = same
    first = _rejoined([stretch for stretch in ours if not _stands(stretch)])
    second = _rejoined([stretch for stretch in theirs if not _stands(stretch)])
    groups = _aligned(first, second)
    loose = set() if same_language else _at_measured_corners(groups) | _at_cuts(groups)
    entered = set() if same_language else _into_curves(groups)
    found: Difference | None = None
    for number, (a, b) in enumerate(groups):
        if number - 1 in entered:
            a, b = _behind_corner(groups[number - 1], a, b)
        if (number in loose or number in entered) and a and b:
            difference = _goals(task, a[-1], b[-1], tolerance, verdict)
        else:
            difference = _group(task, a, b, same_arm, tolerance, verdict)
        found = found or difference
    return found


def _rejoined(stretches: list[Stretch]) -> list[Stretch]:
    """A move that was stopped on its way and begun again from there to the same point is one move."""
    done: list[Stretch] = []
    for stretch in stretches:
        last = done[-1] if done else None
        if last is not None and last.cut and _goes_on(last, stretch):
            poses, times = np.concatenate((last.poses, stretch.poses)), np.concatenate((last.times, stretch.times))
            done[-1] = replace(stretch, poses=poses, times=times)
        else:
            done.append(stretch)
    return done


def _goes_on(cut: Stretch, stretch: Stretch) -> bool:
    """Does a straight move go on from where another one was cut, in its direction?"""
    if not cut.motion == stretch.motion == "linear" or np.abs(cut.poses[-1] - stretch.poses[0]).max() > 1e-3:
        return False
    before, behind = (one.poses[-1, :3, 3] - one.poses[0, :3, 3] for one in (cut, stretch))
    lengths = float(np.linalg.norm(before) * np.linalg.norm(behind))
    return lengths > 0.0 and float(before @ behind) > (1.0 - 1e-8) * lengths


def _at_measured_corners(groups: Sequence[Group]) -> set[int]:
    """Groups of one move each that begin or end with a corner between moves of which one is a joint move, or whose size
    one of the controllers makes by its own measure."""
    found: set[int] = set()
    for number, (a, b) in enumerate(groups[:-1]):
        later_a, later_b = groups[number + 1]
        if not (len(a) == len(b) == len(later_a) == len(later_b) == 1) or a[0].stops or b[0].stops:
            continue
        measured = "joint" in (a[0].motion, later_a[0].motion) or a[0].own_measure or b[0].own_measure
        if measured and a[0].goal is not None and b[0].goal is not None:
            found |= {number, number + 1}
    return found


def _into_curves(groups: Sequence[Group]) -> set[int]:
    """Groups of one move each whose corner leads into a spline in one program and into its arcs in the other: how large
    that corner may be depends on how long the first segment, or the first arc, is."""
    found: set[int] = set()
    for number, (a, b) in enumerate(groups[:-1]):
        later = groups[number + 1]
        curved = [any(stretch.motion == "spline" for stretch in one) for one in later]
        if len(a) != 1 or len(b) != 1 or not all(later) or curved[0] == curved[1]:
            continue
        if not a[0].stops and not b[0].stops and a[0].goal is not None and b[0].goal is not None:
            found.add(number)
    return found


def _behind_corner(corner: Group, a: Sequence[Stretch], b: Sequence[Stretch]) -> Group:
    """Both groups without their beginnings, as far from the corner's point as the longer of its two ways leads."""
    goal = corner[0][0].goal
    assert goal is not None  # `_into_curves` has seen to it
    far = max(float(np.linalg.norm(one[0].poses[0, :3, 3] - goal[:3])) for one in (a, b))
    return _beyond(a, goal[:3], far), _beyond(b, goal[:3], far)


def _beyond(group: Sequence[Stretch], point: FloatArray, far: float) -> Sequence[Stretch]:
    """A group from where it is that far (mm) from a point for the first time."""
    whole = [*group]
    while whole:
        poses = whole[0].poses
        away = np.linalg.norm(poses[:, :3, 3] - point, axis=1)
        outside = np.flatnonzero(away >= far)
        if len(outside):
            at = int(outside[0])
            if at > 0:
                share = (far - away[at - 1]) / max(float(away[at] - away[at - 1]), 1e-9)
                first = poses[at - 1] + share * (poses[at] - poses[at - 1])
                poses = np.concatenate([first[None], poses[at:]])
            return [replace(whole[0], poses=poses), *whole[1:]]
        if len(whole) == 1:
            break
        whole = whole[1:]
    return group


def _at_cuts(groups: Sequence[Group]) -> set[int]:
    """Moves that both programs leave on the way, when a sensor answers, and the moves from there: where that was
    depends on how fast each controller accelerates."""
    found: set[int] = set()
    for number, (a, b) in enumerate(groups):
        if a and b and a[-1].cut and b[-1].cut:
            found |= {number, number + 1}
    return found


def _goals(task: str, a: Stretch, b: Stretch, tolerance: Tolerance, verdict: Verdict) -> Difference | None:
    """Moves at such a corner: both must head for the same point. (The move behind it may come to rest there.)"""
    worst = gap(a.poses, b.poses)
    verdict.corners += 1
    verdict.max_corner_mm = max(verdict.max_corner_mm, worst.mm)
    if a.stops != b.stops:
        text = f"{'A' if a.stops else 'B'} comes to rest where the other goes on"
        return Difference("stop", "geometry", text, _move_side([a]), _move_side([b]), task)
    if a.goal is None or b.goal is None or (a.cut and b.cut):
        return None
    apart = float(np.linalg.norm(a.goal[:3] - b.goal[:3]))
    turn = 2.0 * np.degrees(np.arccos(min(1.0, abs(float(a.goal[3:] @ b.goal[3:])))))
    verdict.max_path_mm = max(verdict.max_path_mm, apart)
    if apart > tolerance.path_mm or turn > tolerance.turn_deg:
        text = f"the moves head for points that are {apart:.3f} mm and {turn:.3f} deg apart"
        return Difference("path", "geometry", text, _move_side([a]), _move_side([b]), task)
    return None


def _stands(stretch: Stretch) -> bool:
    """A move to where the robot already is."""
    apart = np.abs(stretch.poses[:, :3, :] - stretch.poses[:1, :3, :]).max(initial=0.0)
    return bool(apart < 1e-6)


Group = tuple[Sequence[Stretch], Sequence[Stretch]]


def _aligned(a: Sequence[Stretch], b: Sequence[Stretch]) -> list[Group]:
    """Move against move where both have the same; else, from the first two that differ in kind or goal, up to the next
    stop, because one language says with several moves what another says with one (splines, relative moves)."""
    if [stretch.motion for stretch in a] == [stretch.motion for stretch in b]:
        return [([one], [other]) for one, other in zip(a, b, strict=True)]
    groups: list[Group] = []
    at, there = 0, 0
    while at < len(a) or there < len(b):
        end, other = _behind_stop(a, at), _behind_stop(b, there)
        if end > at and other > there and _alike(a[at], b[there]):
            end, other = at + 1, there + 1
        groups.append((a[at:end], b[there:other]))
        at, there = end, other
    return groups


def _alike(one: Stretch, other: Stretch) -> bool:
    """Two moves of one kind that head for the same point and both stop there, or both do not."""
    if one.motion != other.motion or one.stops != other.stops or one.goal is None or other.goal is None:
        return False
    return float(np.linalg.norm(one.goal[:3] - other.goal[:3])) < _SAME_GOAL_MM


def _behind_stop(stretches: Sequence[Stretch], begin: int) -> int:
    """Where the next move begins at rest, from a place of the row on."""
    for number in range(begin, len(stretches)):
        if stretches[number].stops:
            return number + 1
    return len(stretches)


def _group(
    task: str, a: Sequence[Stretch], b: Sequence[Stretch], same_arm: bool, tolerance: Tolerance, verdict: Verdict
) -> Difference | None:
    if not a or not b:
        who = "A" if a else "B"
        text = f"only {who} moves here"
        return Difference("move", "geometry", text, _move_side(a), _move_side(b), task)
    ours = np.concatenate([stretch.poses for stretch in a])
    theirs = np.concatenate([stretch.poses for stretch in b])
    joint_way = any(stretch.motion == "joint" for stretch in (*a, *b))
    if joint_way and not same_arm:  # two arms bend differently between the same points
        ours, theirs = ours[-1:], theirs[-1:]
    worst = gap(ours, theirs)
    verdict.max_path_mm = max(verdict.max_path_mm, worst.mm)
    if worst.mm > tolerance.path_mm or worst.deg > tolerance.turn_deg:
        text = (
            f"the tool goes another way: {worst.mm:.3f} mm and {worst.deg:.3f} deg apart"
            f" at ({_xyz(worst.a)}) in A, ({_xyz(worst.b)}) in B"
        )
        return Difference("path", "geometry", text, _move_side(a), _move_side(b), task)
    if same_arm and len(a[-1].joints) == len(b[-1].joints) and a[-1].stops and b[-1].stops:
        apart = np.abs(a[-1].joints - b[-1].joints)
        verdict.max_joint_deg = max(verdict.max_joint_deg, float(apart.max(initial=0.0)))
        if apart.max(initial=0.0) > tolerance.joint_deg:
            axis = int(np.argmax(apart))
            text = (
                f"the arm stands differently: axis {axis + 1} at {a[-1].joints[axis]:.3f} in A,"
                f" {b[-1].joints[axis]:.3f} in B"
            )
            return Difference("joints", "geometry", text, _move_side(a), _move_side(b), task)
    return None


def _xyz(point: tuple[float, float, float]) -> str:
    return ", ".join(f"{value:.3f}" for value in point)


def _move_side(group: Sequence[Stretch]) -> Side:
    if not group:
        return Side(None)
    last = group[-1]
    x, y, z = (float(value) for value in last.poses[-1, :3, 3])
    return Side(f"{last.motion} move to ({x:.3f}, {y:.3f}, {z:.3f})", last.place, float(last.times[0]))


# Time


def _time(a: Record, b: Record, tolerance: Tolerance, verdict: Verdict) -> Difference | None:
    pairs = _paired(a, b)
    if isinstance(pairs, Difference):
        return pairs
    for task, ours, theirs in pairs:
        for first, second in zip(ours, theirs, strict=False):
            apart = abs(first.t - second.t)
            verdict.max_time_s = max(verdict.max_time_s, apart)
            if apart > max(tolerance.time_s, tolerance.time_share * max(first.t, second.t)):
                text = f"{in_words(first)} at {first.t:.3f} s in A, at {second.t:.3f} s in B"
                return Difference("time", "time", text, side(first), side(second), task)
    return None


__all__ = ["LEVELS", "Tolerance", "Verdict", "compare", "in_words", "same_event"]
