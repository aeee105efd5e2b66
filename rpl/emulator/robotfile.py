"""Robot descriptions: the small TOML files of `rpl/robots`, and the same form written by a user.

A file names its family (`opw`, `ur`, `scara`, or `chain` with a URDF beside it), the lengths in mm, how the pendant's
joint angles relate to the family's own, and per axis the limits, the speeds and the home position. Numbers that nobody
has verified are listed under `assumed`. This module only reads and checks; `rpl.emulator.model` makes a robot of it.
"""

import difflib
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Literal

from rpl.emulator.mechanismfile import Mechanism, read_mechanisms
from rpl.errors import UsageError
from rpl.motionmodel import NUMBERS, wrong_number
from rpl.source import read_bytes
from rpl.tomlfile import FARTHEST, LARGEST, SMALLEST, Lines, TomlError, key_lines, read_toml

Kind = Literal["opw", "ur", "scara", "chain"]

LENGTHS: dict[Kind, tuple[str, ...]] = {
    "opw": ("a1", "a2", "b", "c1", "c2", "c3", "c4"),
    "ur": ("d1", "a2", "a3", "d4", "d5", "d6"),
    "scara": ("l1", "l2", "height"),
    "chain": (),
}
AXES: dict[Kind, int] = {"opw": 6, "ur": 6, "scara": 4, "chain": 0}
Vector = tuple[float, ...]
TOP_KEYS = ("name", "maker", "title", "kind", "source", "assumed", "notes", "payload_kg",
            "geometry", "axes", "motion", "mechanism", "link", "dynamics", "body")  # fmt: skip
GEOMETRY_KEYS = ("offsets", "signs", "joint_3_follows_joint_2", "origin_at_axis_2", "urdf", "tip")
AXIS_KEYS = ("limits", "speeds", "accelerations", "home", "pulses_per_degree", "counts_pulses", "lag")
LINK_KEYS, DYNAMICS_KEYS = ("mass", "centre", "inertia", "origin", "axes"), ("torques", "rotors", "source")
BODY_KEYS = ("link", "radius", "from", "to")
RAMPS = "joint_ramps_s"


class RobotError(UsageError):
    """A robot that is not known, or a robot file that cannot be used."""


@dataclass(frozen=True, slots=True)
class RobotSummary:
    """What a list of robots shows. `reach_mm`: see `reach_mm`; limits in pendant units (degrees, mm), one pair an axis;
    `payload_kg`: the class that the maker's name of the model says."""

    name: str
    maker: str
    title: str
    axes: int
    kind: Kind
    reach_mm: float | None
    payload_kg: float | None
    limits: tuple[Vector, ...]


@dataclass(frozen=True, slots=True)
class LinkFile:
    """One link as published: mass kg, centre mm and inertia kg m2 about it (xx, yy, zz, xy, xz, yz) in a frame whose
    origin (mm) and axes (x, y, z) are given in the base where all the family's own joint variables are zero."""

    mass: float
    centre: Vector
    inertia: Vector
    origin: Vector
    axes: tuple[Vector, ...]


@dataclass(frozen=True, slots=True)
class WeightFile:
    """The links of an arm, base outwards; torques (N m, N) and inertias of motor and gear (kg m2, kg) at the joints,
    where known; who published it."""

    links: tuple[LinkFile, ...]
    torques: Vector | None
    rotors: Vector | None
    source: str


@dataclass(frozen=True, slots=True)
class BodyFile:
    """A capsule of a link (0: what stands still), between two points in mm in the base where all the family's own joint
    variables are zero; a ball where they are one."""

    link: int
    radius: float
    start: Vector
    end: Vector


@dataclass(frozen=True, slots=True)
class RobotFile:
    """One description, checked: lengths in mm, angles in degrees (mm for a sliding joint), speeds per second.

    `motion`: parameters of rpl.motionmodel.MotionModel measured on this arm under the controller `motion_of`.
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
    motion: Mapping[str, float | Vector] = field(default_factory=dict)
    motion_of: str = ""
    mechanisms: tuple[Mechanism, ...] = ()
    weights: WeightFile | None = None
    lag: Vector | None = None  # time constants of the axes' following behind their command, s
    payload_kg: float | None = None
    bodies: tuple[BodyFile, ...] = ()


def robot_names() -> list[str]:
    """Names of the robots that come with the package, sorted."""
    folder = resources.files("rpl.robots")
    return sorted(entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml"))


def robot_summaries() -> list[RobotSummary]:
    """Name, maker, title, number of axes and family of every robot that comes with the package."""
    summaries = []
    for name in robot_names():
        file = read_robot_file(name)
        about = (file.name, file.maker, file.title, len(file.home), file.kind)
        summaries.append(RobotSummary(*about, reach_mm(file), file.payload_kg, file.limits))
    return summaries


def reach_mm(file: RobotFile) -> float | None:
    """How far from axis 1 the stretched arm brings its wrist, mm: the wrist centre of a spherical wrist, the end of the
    forearm of a `ur`, the tool axis of a SCARA. From the lengths alone, whatever the limits of joints say. None of
    an arm from a URDF."""
    of = file.lengths
    match file.kind:
        case "opw":
            return math.hypot(of["a1"] + of["c2"] + math.hypot(of["a2"], of["c3"]), of["b"])
        case "ur":
            return math.hypot(of["a2"] + of["a3"], of["d4"])
        case "scara":
            return of["l1"] + of["l2"]
        case _:
            return None


def read_robot_file(name_or_path: str) -> RobotFile:
    """Read a robot by the name of a packaged one or by the path of a `.toml`; `RobotError` when that fails."""
    if name_or_path.endswith(".toml"):
        path = Path(name_or_path)
        try:
            text = read_bytes(path).decode("utf-8")
        except OSError as error:
            raise RobotError(f"robot file {name_or_path} cannot be read: {error.strerror}") from error
        except UnicodeDecodeError as error:
            raise RobotError(f"robot file {name_or_path} is no text in UTF-8") from error
        return _parse(text, name_or_path, path.parent)
    packaged = resources.files("rpl.robots") / f"{name_or_path}.toml"
    if name_or_path not in robot_names():
        raise RobotError(_unknown(name_or_path))
    return _parse(packaged.read_text(encoding="utf-8"), f"{name_or_path}.toml", None)


def robot_bytes(name_or_path: str) -> bytes:
    """The bytes of the file that describes a robot: a packaged one by its name, or a file. `RobotError` when there is
    none."""
    if name_or_path.endswith((".toml", ".urdf")):
        try:
            return read_bytes(name_or_path)
        except OSError as error:
            raise RobotError(f"robot file {name_or_path} cannot be read: {error.strerror}") from error
    if name_or_path not in robot_names():
        raise RobotError(_unknown(name_or_path))
    return (resources.files("rpl.robots") / f"{name_or_path}.toml").read_bytes()


def _unknown(name: str) -> str:
    names = robot_names()
    wanted = "".join(c for c in name.lower() if c.isalnum())
    contained = [n for n in names if wanted and wanted in n.replace("_", "")]
    close = list(dict.fromkeys(contained + difflib.get_close_matches(name.lower(), names, n=5, cutoff=0.5)))[:5]
    hint = f"; did you mean {', '.join(close)}?" if close else ""
    return f"no robot named '{name}'{hint} (a path must end in .toml or .urdf)"


def _parse(text: str, place: str, folder: Path | None) -> RobotFile:
    try:
        data = read_toml(text)
    except TomlError as error:
        raise RobotError(error.at(f"robot file {place}")) from error
    reader = _Reader(data, place, key_lines(text))
    reader.known(TOP_KEYS)
    kind = reader.text("kind")
    if kind not in LENGTHS:
        raise reader.fail("kind", f"one of {', '.join(LENGTHS)}")
    family = kind
    axes = reader.table("axes")
    geometry = reader.table("geometry")
    axes.known(AXIS_KEYS)
    geometry.known((*GEOMETRY_KEYS, *LENGTHS[family]))
    count = AXES[family] or len(axes.numbers("home", None))
    if count == 0:
        raise axes.fail("home", "a list of one number an axis")
    urdf = geometry.text("urdf", "")
    if family == "chain" and (not urdf or folder is None):
        raise geometry.wrong("urdf", "a chain needs 'urdf', a path relative to the file, under [geometry]")
    lengths = {key: geometry.number(key, FARTHEST) for key in LENGTHS[family]}
    _check_lengths(geometry, family, lengths)
    limits, home = axes.pairs("limits", count), axes.numbers("home", count)
    for axis, (value, (low, high)) in enumerate(zip(home, limits, strict=True), start=1):
        if not low <= value <= high:
            raise axes.wrong("home", f"'home' of axis {axis} is {value:g}, outside its limits {low:g}..{high:g}")
    return RobotFile(
        name=reader.text("name"),
        maker=reader.text("maker", ""),
        title=reader.text("title", reader.text("name")),
        kind=family,
        source=reader.text("source", ""),
        assumed=reader.texts("assumed"),
        notes=reader.texts("notes"),
        lengths=lengths,
        offsets=geometry.numbers("offsets", count, (0.0,) * count),
        signs=_signs(geometry, count),
        joint_3_follows_joint_2=geometry.flag("joint_3_follows_joint_2"),
        origin_at_axis_2=geometry.flag("origin_at_axis_2"),
        limits=limits,
        speeds=axes.above_zero("speeds", count),
        accelerations=axes.above_zero("accelerations", count) if "accelerations" in axes.data else None,
        home=home,
        urdf=(folder / urdf) if urdf and folder is not None else None,
        tip=geometry.text("tip", "") or None,
        pulses_per_degree=axes.above_zero("pulses_per_degree", count) if "pulses_per_degree" in axes.data else None,
        counts_pulses=axes.flag("counts_pulses", True),
        motion=_motion(reader, count),
        motion_of=reader.table("motion").text("controller") if "motion" in data else "",
        mechanisms=read_mechanisms(data.get("mechanism", []), f"robot file {place}", reader.lines),
        weights=_weights(reader, count),
        lag=_lag(axes, count),
        payload_kg=_payload(reader),
        bodies=_bodies(reader, count),
    )


def _motion(reader: "_Reader", count: int) -> dict[str, float | Vector]:
    """What was measured of the time laws on this arm."""
    if "motion" not in reader.data:
        return {}
    table = reader.table("motion")
    wrong = next((key for key in table.data if key not in (*NUMBERS, RAMPS, "controller")), None)
    if wrong is not None:
        raise table.fail(wrong, f"left out: [motion] has {', '.join((*NUMBERS, RAMPS))}")
    found: dict[str, float | Vector] = {key: table.number(key) for key in NUMBERS if key in table.data}
    if RAMPS in table.data:
        found[RAMPS] = table.numbers(RAMPS, count)
    for key, value in found.items():
        for one in value if isinstance(value, tuple) else (value,):
            if wrong := wrong_number(one, key):
                raise table.wrong(key, wrong)
    return found


def _signs(geometry: "_Reader", count: int) -> Vector:
    signs = geometry.numbers("signs", count, (1.0,) * count)
    if any(sign not in (1.0, -1.0) for sign in signs):
        raise geometry.fail("signs", f"a list of {count} numbers, each 1 or -1")
    return signs


# Lengths without which two links are none; of the Universal Robots build both are negative.
LINKS: dict[Kind, tuple[str, ...]] = {"opw": ("c2",), "ur": ("a2", "a3", "d5"), "scara": ("l1", "l2"), "chain": ()}


def _check_lengths(geometry: "_Reader", family: Kind, lengths: dict[str, float]) -> None:
    """A link of no length makes no arm of its family: there the closed form would divide by zero."""
    for key in LINKS[family]:
        if lengths[key] == 0.0:
            raise geometry.fail(key, "a length that is not zero")
    if family in ("opw", "scara"):
        for key in LINKS[family]:
            if lengths[key] < 0.0:
                raise geometry.fail(key, "a length above zero")
    if family == "opw" and math.hypot(lengths["a2"], lengths["c3"]) == 0.0:
        raise geometry.wrong("c3", "'a2' and 'c3' are both zero: the forearm has no length")
    if family == "ur" and lengths["a2"] * lengths["a3"] < 0.0:
        raise geometry.wrong("a3", "'a2' and 'a3' must have the same sign")


def _weights(reader: "_Reader", count: int) -> WeightFile | None:
    """What the arm weighs, where the file says it: one [[link]] for each joint, and [dynamics]."""
    if "link" not in reader.data:
        return None
    entries = reader.data["link"]
    if not isinstance(entries, list) or len(entries) != count:
        raise reader.table_of("link", {}).wrong("", f"there must be one [[link]] for each of the {count} joints")
    names = ["link", *(f"link {number}" for number in range(2, count + 1))]
    links = [reader.table_of(name, entry) for name, entry in zip(names, entries, strict=True)]
    dynamics = reader.table("dynamics")
    dynamics.known(DYNAMICS_KEYS)
    for key in ("torques", "rotors"):
        if key in dynamics.data and min(dynamics.numbers(key, count)) < 0.0:
            raise dynamics.fail(key, "a list of numbers of at least 0")
    return WeightFile(
        tuple(_link(link) for link in links),
        dynamics.numbers("torques", count) if "torques" in dynamics.data else None,
        dynamics.numbers("rotors", count) if "rotors" in dynamics.data else None,
        dynamics.text("source"),
    )


def _link(link: "_Reader") -> LinkFile:
    link.known(LINK_KEYS)
    mass, inertia = link.number("mass"), link.numbers("inertia", 6, (0.0,) * 6)
    if mass < 0.0:
        raise link.fail("mass", "a number of at least 0")
    if min(inertia[:3]) < 0.0:
        raise link.fail("inertia", "six numbers xx, yy, zz, xy, xz, yz, the first three at least 0")
    axes = link.data.get("axes", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    rows = [_numbers(row) for row in axes] if isinstance(axes, list) else []
    turned = tuple(row for row in rows if row is not None and len(row) == 3)
    if len(turned) != 3 or not _is_rotation(turned):
        raise link.fail("axes", "three unit vectors x, y, z at right angles, right-handed")
    return LinkFile(mass, link.numbers("centre", 3), inertia, link.numbers("origin", 3, (0.0,) * 3), turned)


def _bodies(reader: "_Reader", count: int) -> tuple[BodyFile, ...]:
    """The capsules of the links, where the file gives any."""
    entries = reader.data.get("body", [])
    if not isinstance(entries, list):
        raise reader.table_of("body", {}).wrong("", "bodies are tables with the header [[body]]")
    found = []
    for number, entry in enumerate(entries, start=1):
        body = reader.table_of("body" if number == 1 else f"body {number}", entry)
        body.known(BODY_KEYS)
        link = body.data.get("link")
        if not isinstance(link, int) or isinstance(link, bool) or not 0 <= link <= count:
            raise body.fail("link", f"the number of a joint that moves it, 1 to {count}, or 0 for the base")
        radius = body.number("radius", FARTHEST)
        if radius < SMALLEST:
            raise body.fail("radius", "a number of mm above 0")
        start = body.numbers("from", 3)
        end = body.numbers("to", 3, start)
        for key, point in (("from", start), ("to", end)):
            if max(abs(number) for number in point) > FARTHEST:
                raise body.fail(key, f"three numbers of at most {FARTHEST:,.0f}")
        found.append(BodyFile(link, radius, start, end))
    return tuple(found)


def _is_rotation(axes: tuple[Vector, ...]) -> bool:
    """Are these three vectors a right-handed frame?"""
    x, y, z = axes
    across = (x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0])
    units = (sum(a * a for a in axis) for axis in axes)
    apart = max(abs(a - b) for a, b in zip(across, z, strict=True))
    return max(abs(unit - 1.0) for unit in units) < 1e-6 and apart < 1e-6


def _payload(reader: "_Reader") -> float | None:
    if "payload_kg" not in reader.data:
        return None
    mass = reader.number("payload_kg")
    if mass <= 0.0:
        raise reader.fail("payload_kg", "a number above 0")
    return mass


def _lag(axes: "_Reader", count: int) -> Vector | None:
    """Time constants of following, s, where somebody has measured them."""
    if "lag" not in axes.data:
        return None
    numbers = axes.numbers("lag", count)
    if min(numbers) < 0.0:
        raise axes.fail("lag", "a list of numbers of at least 0")
    return numbers


@dataclass(frozen=True, slots=True)
class _Reader:
    """Typed look-ups in a TOML table, each failing with the name of the file, the line and the key."""

    data: dict[str, object]
    place: str
    lines: Lines
    name: str = ""

    def wrong(self, key: str, message: str) -> RobotError:
        """An error at the line of a key; of a key that is missing, at its table's."""
        line = self.lines.get((self.name, key), self.lines.get((self.name, ""), 1))
        return RobotError(f"robot file {self.place}:{line}: {message}")

    def fail(self, key: str, wanted: str) -> RobotError:
        found = repr(self.data[key]) if key in self.data else "nothing"
        return self.wrong(key, f"'{key}' must be {wanted}, found {found}")

    def known(self, keys: tuple[str, ...]) -> None:
        for key in self.data:
            if key not in keys:
                close = difflib.get_close_matches(key, keys, 1)
                hint = f"did you mean '{close[0]}'?" if close else f"there are {', '.join(keys)}"
                raise self.wrong(key, f"'{key}' is not known here: {hint}")

    def table(self, key: str) -> "_Reader":
        value = self.data.get(key)
        if not isinstance(value, dict):
            raise self.fail(key, "a table")
        return _Reader(value, self.place, self.lines, key)

    def table_of(self, name: str, entry: object) -> "_Reader":
        """One table of a list of them, by the name that `_lines` gives it."""
        return _Reader(entry if isinstance(entry, dict) else {}, self.place, self.lines, name)

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

    def number(self, key: str, most: float = LARGEST) -> float:
        numbers = _numbers([self.data.get(key)])
        if numbers is None:
            raise self.fail(key, "a number")
        if abs(numbers[0]) > most:
            raise self.fail(key, f"a number of at most {most:,.0f}")
        return numbers[0]

    def numbers(self, key: str, count: int | None, default: Vector | None = None) -> Vector:
        value = self.data.get(key)
        if value is None and default is not None:
            return default
        numbers = _numbers(value)
        if numbers is None or (count is not None and len(numbers) != count):
            raise self.fail(key, "a list of numbers" if count is None else f"a list of {count} numbers")
        return numbers

    def above_zero(self, key: str, count: int) -> Vector:
        numbers = self.numbers(key, count)
        if min(numbers) <= 0.0:
            raise self.fail(key, f"a list of {count} numbers above 0")
        if min(numbers) < SMALLEST:
            raise self.fail(key, f"a list of {count} numbers of at least {SMALLEST:f}")
        return numbers

    def pairs(self, key: str, count: int) -> tuple[Vector, ...]:
        value = self.data.get(key)
        rows = [_numbers(row) for row in value] if isinstance(value, list) else []
        pairs = tuple(row for row in rows if row is not None and len(row) == 2)
        if len(pairs) != count or len(rows) != count:
            raise self.fail(key, f"a list of {count} pairs [lower, upper]")
        for axis, (low, high) in enumerate(pairs, start=1):
            if max(abs(low), abs(high)) > FARTHEST:
                raise self.wrong(key, f"'{key}' of axis {axis}: no axis goes farther than {FARTHEST:,.0f}")
            if low > high:
                raise self.wrong(
                    key, f"'{key}' of axis {axis}: the lower one, {low:g}, is above the upper one, {high:g}"
                )
        return pairs


def _numbers(value: object) -> Vector | None:
    """The numbers of a list; None for anything else, TOML's nan and inf and whole numbers too long for any use too."""
    if not isinstance(value, list):
        return None
    if not all(isinstance(item, int | float) and not isinstance(item, bool) for item in value):
        return None
    return tuple(float(item) for item in value) if all(abs(item) <= LARGEST for item in value) else None
