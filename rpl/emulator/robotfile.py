"""Robot descriptions: the small TOML files of `rpl/robots`, and the same form written by a user.

A file names its family (`opw`, `ur`, `scara`, or `chain` with a URDF beside it), the lengths in mm, how the pendant's
joint angles relate to the family's own, and per axis the limits, the speeds and the home position. Numbers that nobody
has verified are listed under `assumed`. This module only reads and checks; `rpl.emulator.model` makes a robot of it.
"""

import difflib
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Literal

from rpl.emulator.controller import NUMBERS
from rpl.emulator.mechanismfile import Mechanism, read_mechanisms
from rpl.errors import UsageError

Kind = Literal["opw", "ur", "scara", "chain"]

LENGTHS: dict[Kind, tuple[str, ...]] = {
    "opw": ("a1", "a2", "b", "c1", "c2", "c3", "c4"),
    "ur": ("d1", "a2", "a3", "d4", "d5", "d6"),
    "scara": ("l1", "l2", "height"),
    "chain": (),
}
AXES: dict[Kind, int] = {"opw": 6, "ur": 6, "scara": 4, "chain": 0}
Vector = tuple[float, ...]


class RobotError(UsageError):
    """A robot that is not known, or a robot file that cannot be used."""


@dataclass(frozen=True, slots=True)
class RobotSummary:
    """What a list of robots shows."""

    name: str
    maker: str
    title: str
    axes: int
    kind: Kind


@dataclass(frozen=True, slots=True)
class RobotFile:
    """One description, checked: lengths in mm, angles in degrees (mm for a sliding joint), speeds per second.

    `motion`: parameters of rpl.emulator.controller.MotionModel measured on this arm under the controller `motion_of`.
    """

    name: str
    maker: str
    title: str
    kind: Kind
    source: str
    assumed: tuple[str, ...]
    notes: tuple[str, ...]
    lengths: dict[str, float]
    offsets: Vector
    signs: Vector
    joint_3_follows_joint_2: bool
    origin_at_axis_2: bool
    limits: tuple[Vector, ...]
    speeds: Vector
    accelerations: Vector | None
    home: Vector
    urdf: Path | None
    tip: str | None
    pulses_per_degree: Vector | None = None
    counts_pulses: bool = True
    motion: Mapping[str, float] = field(default_factory=dict)
    motion_of: str = ""
    mechanisms: tuple[Mechanism, ...] = ()


def robot_names() -> list[str]:
    """Names of the robots that come with the package, sorted."""
    folder = resources.files("rpl.robots")
    return sorted(entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml"))


def robot_summaries() -> list[RobotSummary]:
    """Name, maker, title, number of axes and family of every robot that comes with the package."""
    summaries = []
    for name in robot_names():
        file = read_robot_file(name)
        summaries.append(RobotSummary(file.name, file.maker, file.title, len(file.home), file.kind))
    return summaries


def read_robot_file(name_or_path: str) -> RobotFile:
    """Read a robot by the name of a packaged one or by the path of a `.toml`; `RobotError` when that fails."""
    if name_or_path.endswith(".toml"):
        path = Path(name_or_path)
        try:
            text = path.read_text(encoding="utf-8")
        except OSError as error:
            raise RobotError(f"robot file {name_or_path} cannot be read: {error.strerror}") from error
        return _parse(text, name_or_path, path.parent)
    packaged = resources.files("rpl.robots") / f"{name_or_path}.toml"
    if name_or_path not in robot_names():
        raise RobotError(_unknown(name_or_path))
    return _parse(packaged.read_text(encoding="utf-8"), f"{name_or_path}.toml", None)


def _unknown(name: str) -> str:
    names = robot_names()
    wanted = "".join(c for c in name.lower() if c.isalnum())
    contained = [n for n in names if wanted and wanted in n.replace("_", "")]
    close = list(dict.fromkeys(contained + difflib.get_close_matches(name.lower(), names, n=5, cutoff=0.5)))[:5]
    hint = f"; did you mean {', '.join(close)}?" if close else ""
    return f"no robot named '{name}'{hint} (a path must end in .toml or .urdf)"


def _parse(text: str, place: str, folder: Path | None) -> RobotFile:
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise RobotError(f"robot file {place}: {error}") from error
    reader = _Reader(data, place)
    kind = reader.text("kind")
    if kind not in LENGTHS:
        raise RobotError(f"robot file {place}: kind is '{kind}', but must be one of {', '.join(LENGTHS)}")
    family = kind
    axes = reader.table("axes")
    geometry = reader.table("geometry")
    count = AXES[family] or len(axes.numbers("home", None))
    urdf = geometry.text("urdf", "")
    if family == "chain" and (not urdf or folder is None):
        raise RobotError(f"robot file {place}: a chain needs 'urdf', a path relative to the file, under [geometry]")
    return RobotFile(
        name=reader.text("name"),
        maker=reader.text("maker", ""),
        title=reader.text("title", reader.text("name")),
        kind=family,
        source=reader.text("source", ""),
        assumed=reader.texts("assumed"),
        notes=reader.texts("notes"),
        lengths={key: geometry.number(key) for key in LENGTHS[family]},
        offsets=geometry.numbers("offsets", count, (0.0,) * count),
        signs=geometry.numbers("signs", count, (1.0,) * count),
        joint_3_follows_joint_2=geometry.flag("joint_3_follows_joint_2"),
        origin_at_axis_2=geometry.flag("origin_at_axis_2"),
        limits=axes.pairs("limits", count),
        speeds=axes.numbers("speeds", count),
        accelerations=axes.numbers("accelerations", count) if "accelerations" in axes.data else None,
        home=axes.numbers("home", count),
        urdf=(folder / urdf) if urdf and folder is not None else None,
        tip=geometry.text("tip", "") or None,
        pulses_per_degree=_pulses(axes, count),
        counts_pulses=axes.flag("counts_pulses", True),
        motion=_motion(reader),
        motion_of=reader.table("motion").text("controller") if "motion" in data else "",
        mechanisms=read_mechanisms(data.get("mechanism", []), f"robot file {place}"),
    )


def _motion(reader: "_Reader") -> dict[str, float]:
    """What was measured of the time laws on this arm."""
    if "motion" not in reader.data:
        return {}
    table = reader.table("motion")
    wrong = next((key for key in table.data if key not in (*NUMBERS, "controller")), None)
    if wrong is not None:
        raise table.fail(wrong, f"left out: [motion] has {', '.join(NUMBERS)}")
    return {key: table.number(key) for key in NUMBERS if key in table.data}


def _pulses(axes: "_Reader", count: int) -> Vector | None:
    """Motor pulses per degree of each axis, where somebody has published them."""
    if "pulses_per_degree" not in axes.data:
        return None
    numbers = axes.numbers("pulses_per_degree", count)
    if min(numbers) <= 0.0:
        raise axes.fail("pulses_per_degree", "a list of numbers above 0")
    return numbers


@dataclass(frozen=True, slots=True)
class _Reader:
    """Typed look-ups in a TOML table, each failing with the name of the file and of the key."""

    data: dict[str, object]
    place: str

    def fail(self, key: str, wanted: str) -> RobotError:
        found = repr(self.data[key]) if key in self.data else "nothing"
        return RobotError(f"robot file {self.place}: '{key}' must be {wanted}, found {found}")

    def table(self, key: str) -> "_Reader":
        value = self.data.get(key)
        if not isinstance(value, dict):
            raise self.fail(key, "a table")
        return _Reader(value, self.place)

    def text(self, key: str, default: str | None = None) -> str:
        value = self.data.get(key, default)
        if not isinstance(value, str):
            raise self.fail(key, "a text")
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        value = self.data.get(key, [])
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            raise self.fail(key, "a list of texts")
        return tuple(value)

    def flag(self, key: str, default: bool = False) -> bool:
        value = self.data.get(key, default)
        if not isinstance(value, bool):
            raise self.fail(key, "true or false")
        return value

    def number(self, key: str) -> float:
        value = self.data.get(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.fail(key, "a number")
        return float(value)

    def numbers(self, key: str, count: int | None, default: Vector | None = None) -> Vector:
        value = self.data.get(key)
        if value is None and default is not None:
            return default
        numbers = _numbers(value)
        if numbers is None or (count is not None and len(numbers) != count):
            raise self.fail(key, "a list of numbers" if count is None else f"a list of {count} numbers")
        return numbers

    def pairs(self, key: str, count: int) -> tuple[Vector, ...]:
        value = self.data.get(key)
        rows = [_numbers(row) for row in value] if isinstance(value, list) else []
        pairs = tuple(row for row in rows if row is not None and len(row) == 2 and row[0] <= row[1])
        if len(pairs) != count or len(rows) != count:
            raise self.fail(key, f"a list of {count} pairs [lower, upper]")
        return pairs


def _numbers(value: object) -> Vector | None:
    if not isinstance(value, list):
        return None
    if not all(isinstance(item, int | float) and not isinstance(item, bool) for item in value):
        return None
    return tuple(float(item) for item in value)
