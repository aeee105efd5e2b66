"""What stands beside the scripts in a controller's folder of programs, and which arm it is of.

PolyScope saves a program as `.urp` (XML, packed with gzip), as `.script` (what it runs) and as `.txt` (for people), and
the installation as `.installation` (XML, packed). No name of the arm is known in them, but saved programs hold the
lengths of the arm that they were saved on, calibrated, in the parameters of Denavit and Hartenberg:

    <kinematics status="LINEARIZED" validChecksum="true">
      <deltaTheta value="..."/> <a value="..."/> <d value="..."/> <alpha value="..."/>

Seen in saved programs of two UR10e in public repositories (pharmbio/robotlab among them). Where two axes are almost
parallel the calibration turns the common normal by deltaTheta, which leaves a2 = L2 cos(dt2) and a3 = L3 cos(dt2 + dt3)
of the lengths; d1, d5 and d6 stay. So worked out, both programs give the lengths of the UR10e within 1 mm.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from pathlib import PurePath

from rpl.registry import Aside
from rpl.source import Source

_KINEMATICS = re.compile(
    r"<kinematics\b[^>]*>\s*<deltaTheta value=\"([^\"]*)\"/>\s*<a value=\"([^\"]*)\"/>\s*<d value=\"([^\"]*)\"/>",
    re.IGNORECASE,
)
_NEAR_MM = 4.0
_LEAST_COSINE = 0.05  # from a normal that is turned further nothing is told
_KINDS = {
    ".installation": "the installation of a robot",
    ".variables": "values that the controller keeps",
}


def arms(sources: Sequence[Source]) -> Iterator[tuple[str, str]]:
    """The arm whose lengths a saved program has, with its path; nothing where none or more than one has them."""
    for source in sources:
        found = _KINEMATICS.search(source.text) if "<URProgram" in source.text[:2000] else None
        lengths = _lengths(*(found.groups())) if found is not None else None
        like = [title for title, own in _known() if lengths and _near(lengths, own)]
        if len(like) == 1:
            yield f"{like[0]} (by its lengths)", source.path


def aside(source: Source) -> Aside | None:
    """A saved program holds the one that its script is of; it is read itself where there is no script."""
    path = PurePath(source.path)
    suffix = path.suffix.lower()
    if suffix == ".urp" and "<URProgram" in source.text[:2000]:
        return Aside("a saved program, read as the script beside it", source.path[:-4] + ".script", readable=True)
    return Aside(_KINDS[suffix]) if suffix in _KINDS else None


def _lengths(*texts: str) -> tuple[float, ...] | None:
    """d1, a2, a3, d5, d6 in mm without their signs; None where the file does not say them."""
    try:
        turned, a, d = ([float(part) for part in text.split(",")] for text in texts)
        cosines = math.cos(turned[1]), math.cos(turned[1] + turned[2])
        if min(map(abs, cosines)) < _LEAST_COSINE:
            return None
        metres = d[0], a[1] / cosines[0], a[2] / cosines[1], d[4], d[5]
    except (ValueError, IndexError):
        return None
    return tuple(abs(length) * 1000.0 for length in metres)


def _known() -> Iterator[tuple[str, tuple[float, ...]]]:
    """Title and the same lengths of each arm of this maker."""
    from rpl.emulator.robotfile import read_robot_file, robot_summaries

    for one in robot_summaries():
        if one.kind == "ur":
            own = read_robot_file(one.name).lengths
            yield one.title, tuple(abs(own[name]) for name in ("d1", "a2", "a3", "d5", "d6"))


def _near(lengths: tuple[float, ...], own: tuple[float, ...]) -> bool:
    return all(abs(one - other) < _NEAR_MM for one, other in zip(lengths, own, strict=True))
