"""The numbers of a URDF, looked at before anything is computed with them: each with its file, line and element.

What is no number, or none that a machine has (see rpl.tomlfile), makes an arm whose moves never end.
"""

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from math import isfinite, pi
from pathlib import Path

from rpl.emulator.robotfile import RobotError
from rpl.tomlfile import FARTHEST, LARGEST, SMALLEST

_MM, _DEG = 1000.0, 180.0 / pi
# Numbers of masses are SI units; none of an arm is larger.
_HEAVIEST = 1e6
_VECTORS = {("origin", "xyz"): _MM, ("origin", "rpy"): _DEG, ("axis", "xyz"): 1.0}
_LONGEST_WORD = 40


def check_numbers(path: Path, written: str, tree: ET.Element) -> None:
    """Raises RobotError with file, line and element for a number that is none or that no machine has, for axes of no
    direction, and for joints in a circle."""
    for joint in tree.findall("joint"):
        sliding = joint.get("type") == "prismatic"
        for tag, key, number in _numbers(joint, ("origin", "axis", "limit")):
            reason = _of_joint(tag, key, number, sliding)
            if reason:
                raise RobotError(_said(path, written, "joint", joint, tag, reason))
        axis = joint.find("axis")
        if axis is not None and not any(number for _, _, number in _numbers(joint, ("axis",))):
            raise RobotError(_said(path, written, "joint", joint, "axis", "the axis has no direction"))
    for link in tree.findall("link"):
        for inertial in link.findall("inertial"):
            for tag, key, number in _numbers(inertial, ("origin", "mass", "inertia")):
                reason = _of_mass(tag, key, number)
                if reason:
                    raise RobotError(_said(path, written, "link", link, tag, reason))
    _no_circles(path, written, tree)


def _numbers(element: ET.Element, tags: tuple[str, ...]) -> Iterator[tuple[str, str, float | str]]:
    """Tag, attribute and each number of it; the text of what is none."""
    for tag in tags:
        for child in element.findall(tag):
            for key, text in child.attrib.items():
                words = text.split()
                if (tag, key) in _VECTORS and len(words) != 3:
                    yield tag, key, text
                for word in words or [""]:
                    try:
                        yield tag, key, float(word)
                    except ValueError:
                        yield tag, key, word


def _of_joint(tag: str, key: str, number: float | str, sliding: bool) -> str:
    """What is wrong with a number of a joint, if anything is."""
    what = f"the limit's '{key}'" if tag == "limit" else f"the {tag}'s '{key}'"
    if isinstance(number, str) or not isfinite(number):
        needed = "which is no number" if tag == "limit" else "where three numbers are needed"
        return f"{what} is '{_short(str(number))}', {needed}"
    if tag != "limit":
        far = abs(number) * _VECTORS.get((tag, key), 1.0) > FARTHEST
        return f"{what} is {number:g}, and no arm is so large" if far else ""
    size = number * (_MM if sliding else _DEG)
    if key == "velocity" and (size > LARGEST or 0.0 < size < SMALLEST):
        return f"{what} is {number:g}, and no joint is so {'fast' if size > LARGEST else 'slow'}"
    far = key in ("lower", "upper") and abs(size) > FARTHEST
    return f"{what} is {number:g}, and no joint goes so far" if far else ""


def _of_mass(tag: str, key: str, number: float | str) -> str:
    """What is wrong with a number of a link's mass, if anything is."""
    what = f"the {tag}'s '{key}'"
    if isinstance(number, str) or not isfinite(number):
        return f"{what} is '{_short(str(number))}', which is no number"
    if tag == "mass" and number < 0.0:
        return f"{what} is {number:g}, below zero"
    return f"{what} is {number:g}, and no link is so heavy or large" if abs(number) > _HEAVIEST else ""


def _short(word: str) -> str:
    return word if len(word) <= _LONGEST_WORD else f"{word[:_LONGEST_WORD]}.."


def _said(path: Path, written: str, kind: str, element: ET.Element, tag: str, reason: str) -> str:
    name = element.get("name", "")
    return f"{path.name}:{line_of_part(written, kind, name, tag)}: {kind} '{name}': {reason}"


def line_of_part(written: str, kind: str, name: str, tag: str) -> int:
    """The line of a part (`limit`, `mass`) of a joint or link, else of that itself (the parser keeps no places)."""
    found = re.search(rf"<{kind}\b[^>]*\bname\s*=\s*[\"']{re.escape(name)}[\"']", written)
    if found is None:
        return 1
    part = re.compile(rf"<{tag}\b|</{kind}\b").search(written, found.end())
    place = part.start() if part is not None and part[0] == f"<{tag}" else found.start()
    return written.count("\n", 0, place) + 1


def _no_circles(path: Path, written: str, tree: ET.Element) -> None:
    """Each link hangs on one joint, and following them ends at the root."""
    leading: dict[str, ET.Element] = {}
    for joint in tree.findall("joint"):
        child = joint.find("child")
        name = "" if child is None else child.get("link", "")
        if name in leading:
            raise RobotError(_said(path, written, "joint", joint, "child", f"the link '{name}' hangs on two joints"))
        leading[name] = joint
    for joint in tree.findall("joint"):
        at, steps = joint, 0
        while steps <= len(leading):
            parent = at.find("parent")
            name = "" if parent is None else parent.get("link", "")
            if name not in leading:
                break
            at, steps = leading[name], steps + 1
        else:
            raise RobotError(_said(path, written, "joint", joint, "parent", "its links hang on each other in a circle"))
