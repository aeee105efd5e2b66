"""Reads the bodies of a cell file; every error names the file, the line and the key.

    [[robot]]     name = "left"  arm = "kuka_kr6r900sixx"  programs = ["left.src"]  [entry]  [base]  [joints]
    [[gripper]]   name = "jaws"  kind = "jaws|suction"  close = "do1"  [robot]  [open]  [grip]  [bodies]  [gripped]
                  [opened]  [closed]  [time]  [opening = [0, 80]]  [reach]  [misses = [2]]  [chance_of_miss]  [force]
    [[fixture]]   name = "table"  FORM  [at]  [restitution]      or bodies = [{ FORM, at = [...] }, ...]
    [[bin]]       name = "bin"  inside = [300, 200, 120]  [wall]  [at]  [restitution]
    [[part]]      name = "cube"  FORM  [at]  [mass]  [restitution]  [copies = 12] with one of
                  [step = [0, 0, 40]]  [every = 1.0]  [again = 0.5];  [grasps = [{ grip = [...] }]]
    [[sensor]]    name = "seat"  signal = "di4"  FORM  [at]  [robot]  [parts = ["cube"]]
    [[wire]]      from = "left.do5"  to = "right.di2"
    [[removal]]   when = "do6"  fixture = "pallet"  [after = 1.0]  [robot]
    [bodies]      [allow = [["jaws", "table"]]]  [near]  [lost_beyond]  [scatter]  [tangle]

FORM is one of box = [x, y, z], cylinder = [diameter, height], sphere = diameter, capsule = [diameter, length],
extrusion = { outline = [[x, y], ...], height = h } and mesh = "file.stl" (with [scale]). Poses (`at`, `base`, `grip`)
are x y z in mm, and a b c in degrees behind them where it is turned.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rpl.cell.layout import (
    ONLY_ROBOT,
    Body,
    Fixture,
    Gripper,
    Layout,
    OwnGrasp,
    Part,
    Removal,
    RobotPlace,
    Sensor,
    Switch,
    Wire,
)
from rpl.cell.rows import RowReader, Value
from rpl.cell.shapes import Box, Capsule, Cylinder, Extrusion, Shape, Sphere
from rpl.emulator.rotations import FloatArray, pose_matrix, zyx_to_matrix
from rpl.errors import UsageError
from rpl.tomlfile import FARTHEST

TABLES = ("robot", "gripper", "fixture", "bin", "part", "sensor", "wire", "removal", "bodies")
_FORMS = ("box", "cylinder", "sphere", "capsule", "extrusion", "mesh")
_FORM_KEYS = (*_FORMS, "scale")
_PART_KEYS = ("at", "mass", "restitution", "copies", "step", "again", "every", "grasps")
_LARGEST_MM, _SMALLEST_MM = 50_000.0, 0.05  # of a body: beyond these a unit was mistaken
_MOST_COPIES = 10_000


class LayoutReader(RowReader):
    """Reads the tables of bodies."""

    def layout(self, table: dict[str, Value]) -> Layout:
        """Raises UsageError with file and key where they are wrong or do not fit together."""
        robots = tuple(self.robot(key, row) for key, row in self.rows(table, "robot"))
        fixtures = (
            *(self.fixture(key, row) for key, row in self.rows(table, "fixture")),
            *(self.bin(key, row) for key, row in self.rows(table, "bin")),
        )
        more = self.bodies(table.get("bodies", {}))
        made = Layout(
            robots,
            tuple(self.gripper(key, row) for key, row in self.rows(table, "gripper")),
            fixtures,
            tuple(part for key, row in self.rows(table, "part") for part in self.part(key, row)),
            tuple(self.sensor(key, row) for key, row in self.rows(table, "sensor")),
            tuple(self.wire(key, row) for key, row in self.rows(table, "wire")),
            tuple(self.removal(key, row) for key, row in self.rows(table, "removal")),
            path=self.path,
            **more,
        )
        self.together(made)
        return made

    # ---- what is in a row

    def form(self, key: str, row: dict[str, Value]) -> Shape:
        """The one form of a row."""
        given = [name for name in _FORMS if name in row]
        if len(given) != 1:
            raise self.wrong(key, f"needs one of {', '.join(_FORMS)}" + (f", not {len(given)}" if given else ""))
        kind = given[0]
        if "scale" in row and kind != "mesh":
            raise self.wrong(f"{key}.scale", "is for a mesh")
        where = f"{key}.{kind}"
        match kind:
            case "box":
                x, y, z = self.sizes(where, row[kind], 3)
                return Box((x, y, z))
            case "cylinder":
                return Cylinder(*self.sizes(where, row[kind], 2))
            case "capsule":
                return Capsule(*self.sizes(where, row[kind], 2))
            case "sphere":
                return Sphere(*self.sizes(where, [row[kind]], 1))
            case "extrusion":
                return self.extrusion(where, row[kind])
        return self.mesh(key, row)

    def extrusion(self, key: str, given: Value) -> Shape:
        if not isinstance(given, dict):
            raise self.wrong(key, "must be { outline = [[x, y], ...], height = h }")
        self.known(key, given, ("outline", "height"))
        outline = given["outline"]
        if not isinstance(outline, list) or len(outline) < 3:
            raise self.wrong(f"{key}.outline", "must be a list of three or more corners [x, y]")
        corners = [self.numbers(f"{key}.outline", corner, 2) for corner in outline]
        (height,) = self.sizes(f"{key}.height", [given["height"]], 1)
        made = Extrusion(tuple((x, y) for x, y in corners), height)
        try:
            flat = abs(made.facets.volume) < 1e-6
        except ValueError as error:
            raise self.wrong(f"{key}.outline", f"{error}") from None
        if flat:
            raise self.wrong(f"{key}.outline", "encloses nothing")
        return made

    def mesh(self, key: str, row: dict[str, Value]) -> Shape:
        """The form of a file beside the cell file."""
        from rpl.cell.meshes import load_mesh

        name = self.text(key, row, "mesh")
        scale = self.number(key, row, "scale", 1.0, above=0.0) if "scale" in row else None
        try:
            return load_mesh(Path(self.path).parent / name, scale)
        except UsageError as error:
            raise self.wrong(f"{key}.mesh", str(error)) from None

    def sizes(self, key: str, given: Value, count: int) -> tuple[float, ...]:
        """Lengths of a body in mm."""
        found = self.numbers(key, given, count)
        for one in found:
            if not _SMALLEST_MM <= one <= _LARGEST_MM:
                raise self.wrong(key, f"{one:g} is no length of a body in mm (is it in m, or in inches?)")
        return found

    def numbers(self, key: str, given: Value, *counts: int) -> tuple[float, ...]:
        plain = isinstance(given, list) and all(
            isinstance(one, int | float) and not isinstance(one, bool) and abs(one) <= FARTHEST for one in given
        )
        if not plain or len(given) not in counts:
            raise self.wrong(key, f"must be {' or '.join(map(str, counts))} numbers, not {given!r}")
        return tuple(float(one) for one in given)

    def number(
        self, key: str, row: dict[str, Value], name: str, default: float, above: float | None = None, most: float = 1e9
    ) -> float:
        given = row.get(name, default)
        (found,) = self.numbers(f"{key}.{name}", [given], 1)
        if found < 0.0 or (above is not None and found <= above) or found > most:
            allowed = f"above {above:g}" if above is not None else "at least 0"
            raise self.wrong(f"{key}.{name}", f"must be {allowed}{f' and at most {most:g}' if most < 1e9 else ''}")
        return found

    def pose(self, key: str, row: dict[str, Value], name: str = "at") -> FloatArray:
        """(4, 4); the origin where nothing is said."""
        if name not in row:
            return np.eye(4)
        found = self.numbers(f"{key}.{name}", row[name], 3, 6)
        return pose_matrix(found[:3], zyx_to_matrix(found[3:]) if len(found) == 6 else None)

    def name(self, key: str, row: dict[str, Value]) -> str:
        name = self.text(key, row, "name")
        if not name.strip():
            raise self.wrong(f"{key}.name", "is empty")
        return name

    # ---- rows

    def robot(self, key: str, row: dict[str, Value]) -> RobotPlace:
        self.known(key, row, ("name",), ("arm", "programs", "entry", "base", "joints"))
        programs = row.get("programs", [])
        if not isinstance(programs, list) or not all(isinstance(one, str) for one in programs):
            raise self.wrong(f"{key}.programs", "must be a list of paths")
        joints = row.get("joints")
        given = self.numbers(f"{key}.joints", joints, *range(1, 8)) if joints is not None else None
        home = Path(self.path).parent
        arm = self.text(key, row, "arm")
        beside = arm.endswith((".toml", ".urdf"))
        return RobotPlace(
            self.name(key, row),
            str(home / arm) if beside else arm,
            tuple(str(home / one) for one in programs),
            self.text(key, row, "entry"),
            self.pose(key, row, "base"),
            given,
            key,
        )

    def switch(self, key: str, given: Value) -> Switch:
        """`"do1"`, or { signal = "do1", value = FALSE }."""
        if isinstance(given, str) and given:
            return Switch(given)
        if not isinstance(given, dict):
            raise self.wrong(key, 'must be the name of an output, or { signal = "do1", value = true }')
        self.known(key, given, ("signal",), ("value",))
        return Switch(self.text(key, given, "signal"), self.signal(key, given, "value") if "value" in given else True)

    def gripper(self, key: str, row: dict[str, Value]) -> Gripper:
        more = ("robot", "open", "grip", "bodies", "gripped", "opened", "closed", "time", "opening", "reach")
        self.known(key, row, ("name", "kind", "close"), (*more, "misses", "chance_of_miss", "force"))
        kind = row["kind"]
        if kind not in ("jaws", "suction"):
            raise self.wrong(f"{key}.kind", f"must be jaws or suction, not {kind!r}")
        low, high = self.numbers(f"{key}.opening", row.get("opening", [0.0, 1000.0]), 2)
        if not 0.0 <= low < high:
            raise self.wrong(f"{key}.opening", "must be the least and the greatest distance of the jaws in mm")
        return Gripper(
            self.name(key, row),
            kind,
            self.text(key, row, "robot"),
            self.pose(key, row, "grip"),
            tuple(self.several(key, row)),
            self.switch(f"{key}.close", row["close"]),
            self.switch(f"{key}.open", row["open"]) if "open" in row else None,
            self.text(key, row, "gripped"),
            self.text(key, row, "opened"),
            self.text(key, row, "closed"),
            self.seconds(key, row, "time"),
            (low, high),
            self.number(key, row, "reach", 20.0),
            self.times(key, row, "misses"),
            self.number(key, row, "chance_of_miss", 0.0, most=1.0),
            self.number(key, row, "force", 0.0, above=0.0) if "force" in row else None,
            key,
        )

    def several(self, key: str, row: dict[str, Value]) -> Iterator[Body]:
        """`bodies = [{ FORM, at }, ...]`."""
        given = row.get("bodies", [])
        if not isinstance(given, list) or not all(isinstance(one, dict) for one in given):
            raise self.wrong(f"{key}.bodies", "must be a list of { box = [x, y, z], at = [x, y, z] }")
        for number, one in enumerate(given, 1):
            where = f"{key}.bodies[{number}]"
            self.known(where, one, (), (*_FORM_KEYS, "at"))
            yield Body(self.form(where, one), self.pose(where, one))

    def fixture(self, key: str, row: dict[str, Value]) -> Fixture:
        self.known(key, row, ("name",), (*_FORM_KEYS, "bodies", "at", "restitution"))
        at = self.pose(key, row)
        given = tuple(self.several(key, row))
        if given and any(name in row for name in _FORMS):
            raise self.wrong(key, "has a form and bodies: one of them is enough")
        bodies = given or (Body(self.form(key, row)),)
        placed = tuple(Body(one.shape, at @ one.at) for one in bodies)
        return Fixture(self.name(key, row), placed, self.restitution(key, row), key=key)

    def bin(self, key: str, row: dict[str, Value]) -> Fixture:
        """A floor and four walls; `at` is the middle of the floor's upper side."""
        self.known(key, row, ("name", "inside"), ("wall", "at", "restitution"))
        x, y, z = self.sizes(f"{key}.inside", row["inside"], 3)
        wall, at = self.number(key, row, "wall", 5.0, above=0.0), self.pose(key, row)
        sides = [
            (Box((x + 2 * wall, y + 2 * wall, wall)), (0.0, 0.0, -wall / 2)),
            (Box((wall, y + 2 * wall, z)), ((x + wall) / 2, 0.0, z / 2)),
            (Box((wall, y + 2 * wall, z)), (-(x + wall) / 2, 0.0, z / 2)),
            (Box((x, wall, z)), (0.0, (y + wall) / 2, z / 2)),
            (Box((x, wall, z)), (0.0, -(y + wall) / 2, z / 2)),
        ]
        bodies = tuple(Body(shape, at @ pose_matrix(place)) for shape, place in sides)
        return Fixture(self.name(key, row), bodies, self.restitution(key, row), (x, y, z), at, key)

    def restitution(self, key: str, row: dict[str, Value]) -> float:
        return self.number(key, row, "restitution", 0.3, most=1.0)

    def part(self, key: str, row: dict[str, Value]) -> Iterator[Part]:
        """The part and its copies: `cube`, `cube#2`, ..."""
        self.known(
            key,
            row,
            ("name",),
            (*_FORM_KEYS, "at", "mass", "restitution", "copies", "step", "again", "every", "grasps"),
        )
        shape, at, name = self.form(key, row), self.pose(key, row), self.name(key, row)
        copies = row.get("copies", 1)
        if type(copies) is not int or not 1 <= copies <= _MOST_COPIES:
            raise self.wrong(f"{key}.copies", f"must be a whole number from 1 to {_MOST_COPIES:,}")
        again = self.seconds(key, row, "again") if "again" in row else None
        step = np.array(self.numbers(f"{key}.step", row.get("step", [0.0, 0.0, 0.0]), 3))
        every = self.seconds(key, row, "every") if "every" in row else None
        ways = [name for name in ("step", "again", "every") if name in row]
        if len(ways) > 1:
            raise self.wrong(f"{key}.{ways[1]}", "copies stand apart (step), come one after the other (every) or again")
        if copies > 1 and not ways:
            raise self.wrong(f"{key}.copies", "stand in each other: give step = [x, y, z], every = s or again = s")
        mass = self.number(key, row, "mass", 0.0) if "mass" in row else None
        grasps = tuple(self.grasps(key, row))
        for number in range(copies):
            place = at.copy()
            place[:3, 3] += number * step
            called = name if number == 0 else f"{name}#{number + 1}"
            comes = number * every if every is not None else 0.0
            yield Part(called, shape, place, self.restitution(key, row), mass, again, comes, grasps, name, key)

    def grasps(self, key: str, row: dict[str, Value]) -> Iterator[OwnGrasp]:
        """`grasps = [{ grip = [x, y, z, a, b, c], approach = 80, depart = 80 }]`."""
        given = row.get("grasps", [])
        if not isinstance(given, list) or not all(isinstance(one, dict) for one in given):
            raise self.wrong(f"{key}.grasps", "must be a list of { grip = [x, y, z, a, b, c] }")
        for number, one in enumerate(given, 1):
            where = f"{key}.grasps[{number}]"
            self.known(where, one, ("grip",), ("approach", "depart"))
            ways = [
                self.number(where, one, name, 0.0, above=0.0) if name in one else None
                for name in ("approach", "depart")
            ]
            yield OwnGrasp(self.pose(where, one, "grip"), ways[0], ways[1])

    def sensor(self, key: str, row: dict[str, Value]) -> Sensor:
        self.known(key, row, ("name", "signal"), (*_FORM_KEYS, "at", "robot", "parts"))
        parts = row.get("parts", [])
        if not isinstance(parts, list) or not all(isinstance(one, str) for one in parts):
            raise self.wrong(f"{key}.parts", "must be a list of names of parts")
        body = Body(self.form(key, row), self.pose(key, row))
        signal, robot = self.text(key, row, "signal"), self.text(key, row, "robot")
        return Sensor(self.name(key, row), signal, body, robot, tuple(parts), key)

    def wire(self, key: str, row: dict[str, Value]) -> Wire:
        self.known(key, row, ("from", "to"))
        ends = []
        for name in ("from", "to"):
            robot, dot, signal = self.text(key, row, name).partition(".")
            if not dot or not signal:
                raise self.wrong(f"{key}.{name}", 'must be "robot.signal"')
            ends += [robot, signal]
        return Wire(ends[0], ends[1], ends[2], ends[3], key)

    def removal(self, key: str, row: dict[str, Value]) -> Removal:
        self.known(key, row, ("when", "fixture"), ("after", "robot"))
        when, fixture = self.switch(f"{key}.when", row["when"]), self.text(key, row, "fixture")
        return Removal(when, fixture, self.seconds(key, row, "after"), self.text(key, row, "robot"), key)

    def bodies(self, given: Value) -> dict[str, Value]:
        if not isinstance(given, dict):
            raise self.wrong("bodies", "must be a table")
        self.known("bodies", given, (), ("allow", "near", "scatter", "tangle", "lost_beyond"))
        allow = given.get("allow", [])
        if not isinstance(allow, list) or not all(
            isinstance(pair, list) and len(pair) == 2 and all(isinstance(one, str) for one in pair) for pair in allow
        ):
            raise self.wrong("bodies.allow", "must be a list of pairs of names")
        return {
            "allowed": tuple((str(a), str(b)) for a, b in allow),
            "lost_beyond_mm": self.number("bodies", given, "lost_beyond", 0.0) if "lost_beyond" in given else None,
            "near_mm": self.number("bodies", given, "near", 20.0),
            "scatter": self.number("bodies", given, "scatter", 0.0, most=10.0),
            "tangle": self.number("bodies", given, "tangle", 0.0, most=1.0),
        }

    # ---- whether they fit together

    def together(self, layout: Layout) -> None:
        """Names are there, and each once; no two robots drive one input or gripper."""
        rows: tuple[RobotPlace | Gripper | Fixture | Part | Sensor, ...]
        rows = (*layout.robots, *layout.grippers, *layout.fixtures, *layout.parts, *layout.sensors)
        seen: dict[str, str] = {}
        for one in rows:
            if one.name in seen:
                raise self.wrong(f"{one.key}.name", f"{one.name} is {seen[one.name]} already")
            seen[one.name] = one.key
        robots = {one.name for one in layout.robots}
        owned: tuple[Gripper | Sensor | Removal, ...] = (*layout.grippers, *layout.sensors, *layout.removals)
        for each in owned:
            self._its_robot(each.key, "robot", each.robot, robots)
        for wire in layout.wires:
            self._its_robot(wire.key, "from", wire.robot, robots)
            self._its_robot(wire.key, "to", wire.to_robot, robots)
        fixtures = {one.name for one in layout.fixtures}
        for removal in layout.removals:
            if removal.fixture not in fixtures:
                raise self.wrong(f"{removal.key}.fixture", f"there is no fixture or bin {removal.fixture}")
        kinds = {one.kind for one in layout.parts}
        for sensor in layout.sensors:
            for name in sensor.parts:
                if name not in kinds and name not in seen:
                    raise self.wrong(f"{sensor.key}.parts", f"there is no part {name}")
        self._one_source(layout)

    def _its_robot(self, key: str, name: str, robot: str, robots: set[str]) -> None:
        if robot in robots or (robot == ONLY_ROBOT and len(robots) < 2):
            return
        there = f"there are {', '.join(sorted(robots))}" if robots else "the cell names none"
        raise self.wrong(f"{key}.{name}", f"{f'no robot {robot}' if robot else 'say which robot'}: {there}")

    def _one_source(self, layout: Layout) -> None:
        """An input is driven by one thing."""
        driven: dict[tuple[str, str], str] = {}
        found = [(wire.to_robot, wire.input, f"{wire.key}.to") for wire in layout.wires]
        found += [(sensor.robot, sensor.signal, f"{sensor.key}.signal") for sensor in layout.sensors]
        for one in layout.grippers:
            named = (("gripped", one.gripped), ("opened", one.opened), ("closed", one.closed))
            found += [(one.robot, signal, f"{one.key}.{name}") for name, signal in named if signal]
        for robot, signal, key in found:
            name = layout.robot(robot).name
            if (name, signal.lower()) in driven:
                raise self.wrong(key, f"{signal} is driven by {driven[name, signal.lower()]} already")
            driven[name, signal.lower()] = key
