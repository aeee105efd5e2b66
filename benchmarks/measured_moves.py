"""Moves that others timed on virtual controllers, driven here by programs in the vendors' languages.

python benchmarks/measured_moves.py          prints the tables of docs/fidelity.md
python benchmarks/measured_moves.py --write  puts them into it

Source of the measured numbers: the public probe results of the project CrossArm by LeroyDu56 (ROBOGUIDE with three
FANUC arms; RobotStudio, RobotWare 8.1, with an IRB 6700-140/2.85): zero tool, tool straight down, clocks of the
controllers. Times in s, distances in mm, speeds in percent or mm/s.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rpl.diagnostics import Diagnostics
from rpl.project import read_program
from rpl.runtime.trace import Event
from rpl.simulation import run_program

Point = tuple[float, float, float]
PERCENTS = (5, 10, 15, 20, 25, 30, 40, 50, 70, 100)
LINEAR_SPEEDS = (100, 200, 500, 1000, 1500, 2000)
CORNER_A, CORNER_B, CORNER_C = (1100.0, -200.0, 800.0), (1400.0, -200.0, 800.0), (1400.0, 200.0, 800.0)
LINE = ((1100.0, -300.0, 800.0), (1100.0, 300.0, 800.0))
WAYS: dict[str, tuple[Point, Point]] = {
    "swing": ((1100.0, -500.0, 800.0), (1100.0, 500.0, 800.0)),
    "rise": ((1250.0, 0.0, 500.0), (1250.0, 0.0, 1100.0)),
    "joint": ((1100.0, -400.0, 600.0), (1400.0, 300.0, 1000.0)),
}
JOINT_TIMES: dict[str, dict[str, tuple[float, ...]]] = {
    "fanuc_m20id25": {
        "swing": (4.816, 2.488, 1.712, 1.324, 1.092, 0.936, 0.742, 0.626, 0.529, 0.591),
        "rise": (3.324, 1.772, 1.255, 0.996, 0.841, 0.738, 0.608, 0.548, 0.561, 0.517),
        "joint": (3.333, 1.805, 1.296, 1.041, 0.888, 0.788, 0.745, 0.823, 0.767, 0.769),
    },
    "fanuc_r1000ia80f": {
        "swing": (5.994, 3.118, 2.160, 1.680, 1.393, 1.201, 0.961, 0.818, 0.687, 0.657),
        "rise": (4.502, 2.409, 1.711, 1.362, 1.153, 1.013, 0.839, 0.734, 0.603, 0.557),
        "joint": (4.089, 2.202, 1.573, 1.259, 1.070, 0.944, 0.787, 0.693, 0.601, 0.601),
    },
    "fanuc_r2000ic190s": {
        "swing": (9.651, 4.995, 3.443, 2.667, 2.202, 1.891, 1.503, 1.288, 1.097, 1.019),
        "rise": (7.247, 3.804, 2.656, 2.082, 1.738, 1.508, 1.221, 1.066, 0.953, 0.977),
        "joint": (7.273, 3.821, 2.669, 2.094, 1.748, 1.518, 1.231, 1.097, 0.991, 0.975),
    },
}
LINEAR_TIMES: dict[str, tuple[float, ...]] = {
    "fanuc_m20id25": (6.148, 3.148, 1.348, 0.748, 0.548, 0.463),
    "fanuc_r1000ia80f": (6.205, 3.205, 1.405, 0.806, 0.658, 0.601),
    "fanuc_r2000ic190s": (6.232, 3.232, 1.432, 0.943, 0.891, 0.891),
    "abb_irb6700_140_285": (6.092, 3.116, 1.352, 0.784, 0.620, 0.556),
}
# Per speed: of the corner with a stop, then with CNT 0, 10 ... 100: times and cuts.
CNT = (0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100)
CNT_CORNERS: dict[str, dict[int, tuple[float, tuple[float, ...], tuple[float, ...]]]] = {
    "fanuc_m20id25": {
        200: (
            3.900,
            (3.899, 3.814, 3.788, 3.768, 3.751, 3.736, 3.722, 3.710, 3.701, 3.701, 3.703),
            (0, 0.182, 0.500, 0.909, 1.393, 1.943, 2.569, 3.205, 3.876, 4.368, 4.753),
        ),
        500: (
            1.800,
            (1.799, 1.714, 1.688, 1.668, 1.651, 1.636, 1.622, 1.610, 1.601, 1.601, 1.603),
            (0, 0.456, 1.251, 2.271, 3.482, 4.855, 6.425, 8.012, 9.686, 10.920, 11.885),
        ),
        1000: (
            1.100,
            (1.099, 1.024, 0.996, 0.974, 0.956, 0.940, 0.925, 0.915, 0.916, 0.915, 0.917),
            (0, 1.016, 2.821, 5.208, 7.945, 11.069, 14.653, 18.052, 20.491, 23.359, 25.572),
        ),
    },
    "fanuc_r1000ia80f": {
        200: (
            4.033,
            (4.032, 3.832, 3.804, 3.783, 3.765, 3.750, 3.735, 3.722, 3.710, 3.711, 3.712),
            (0, 0.180, 0.514, 0.936, 1.441, 1.982, 2.640, 3.320, 4.042, 4.521, 4.953),
        ),
        500: (
            1.933,
            (1.932, 1.732, 1.704, 1.683, 1.665, 1.650, 1.635, 1.622, 1.610, 1.611, 1.612),
            (0, 0.461, 1.284, 2.337, 3.601, 4.951, 6.602, 8.300, 10.114, 11.280, 12.374),
        ),
        1000: (
            1.252,
            (1.251, 1.090, 1.052, 1.024, 1.000, 0.983, 0.983, 0.983, 0.984, 0.984, 0.985),
            (0, 1.515, 4.374, 7.890, 12.117, 16.584, 20.069, 23.636, 26.913, 30.313, 33.558),
        ),
    },
    "fanuc_r2000ic190s": {
        200: (
            4.081,
            (4.080, 3.972, 3.929, 3.895, 3.867, 3.842, 3.834, 3.835, 3.834, 3.834, 3.836),
            (0, 0.348, 0.960, 1.773, 2.712, 3.789, 4.753, 5.562, 6.470, 7.333, 8.099),
        ),
        500: (
            1.982,
            (1.981, 1.938, 1.887, 1.848, 1.816, 1.789, 1.788, 1.788, 1.788, 1.789, 1.790),
            (0, 1.055, 2.965, 5.421, 8.235, 11.446, 14.127, 16.734, 19.294, 21.829, 24.213),
        ),
        1000: (
            1.557,
            (1.556, 1.546, 1.479, 1.428, 1.385, 1.347, 1.313, 1.282, 1.283, 1.282, 1.284),
            (0, 2.385, 6.736, 12.314, 18.881, 26.193, 33.937, 42.202, 48.501, 55.003, 58.296),
        ),
    },
}
ZONES = (1, 5, 10, 20, 30, 50, 100, 150, 200)
ZONE_CORNERS: dict[int, tuple[float, tuple[float, ...], tuple[float, ...]]] = {
    200: (
        3.732,
        (3.656, 3.632, 3.616, 3.600, 3.580, 3.548, 3.464, 3.384, 3.300),
        (1.976, 3.281, 4.617, 7.144, 9.917, 15.760, 30.807, 45.992, 61.206),
    ),
    500: (
        1.724,
        (1.640, 1.636, 1.624, 1.592, 1.576, 1.552, 1.520, 1.488, 1.448),
        (2.544, 3.727, 5.349, 8.555, 11.488, 17.350, 31.853, 46.715, 61.773),
    ),
    1000: (
        1.140,
        (1.056, 1.068, 1.060, 1.028, 1.020, 1.000, 0.952, 0.916, 0.892),
        (2.544, 3.746, 5.360, 8.564, 11.534, 17.712, 32.967, 48.221, 63.340),
    ),
}
# A MoveJ at v100 ... v3000 and vmax, by the same three ways.
MOVEJ_SPEEDS = (100, 200, 300, 500, 800, 1000, 1500, 2000, 3000, 5000)
MOVEJ_TIMES: dict[str, tuple[float, ...]] = {
    "swing": (10.416, 5.280, 3.576, 2.216, 1.464, 1.220, 0.904, 0.776, 0.720, 0.720),
    "rise": (6.184, 3.168, 2.168, 1.384, 0.964, 0.836, 0.696, 0.656, 0.652, 0.652),
    "joint": (8.852, 4.500, 3.056, 1.900, 1.268, 1.052, 0.792, 0.676, 0.584, 0.588),
}
ABB = "abb_irb6700_140_285"


@dataclass(frozen=True, slots=True)
class Probe:
    """Moves from the first point to the others, one after the other: `kind` J or L, `speed` in percent or mm/s, the
    corner at all but the last point (None: a stop)."""

    kind: str
    speed: int
    points: tuple[Point, ...]
    corner: int | None = None


@dataclass(frozen=True, slots=True)
class Timed:
    """What a probe came to: its time, and how close its path passes the second point."""

    time_s: float
    cut_mm: float


def corner(kind: str, speed: int, size: int | None) -> Probe:
    """The right angle with legs of 300 and 400 mm."""
    return Probe(kind, speed, (CORNER_A, CORNER_B, CORNER_C), size)


def tp_program(probes: Sequence[Probe]) -> str:
    """The probes as a TP program, each reached by a joint move at 30 percent."""
    places = list(dict.fromkeys(point for probe in probes for point in probe.points))
    lines = [" UFRAME_NUM=0 ;", " UTOOL_NUM=1 ;"]
    for probe in probes:
        lines.append(f"J P[{places.index(probe.points[0]) + 1}] 30% FINE ;")
        for point in probe.points[1:]:
            speed = f"{probe.speed}%" if probe.kind == "J" else f"{probe.speed}mm/sec"
            stop = probe.corner is None or point is probe.points[-1]
            lines.append(
                f"{probe.kind} P[{places.index(point) + 1}] {speed} {'FINE' if stop else f'CNT{probe.corner}'} ;"
            )
    numbered = "".join(f"{number:4d}:{line}\n" for number, line in enumerate(lines, 1))
    data = "".join(
        f"P[{number}]{{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n"
        f"\tX = {x:9.3f}  mm,\tY = {y:9.3f}  mm,\tZ = {z:9.3f}  mm,\n"
        "\tW =   180.000 deg,\tP =     0.000 deg,\tR =   135.000 deg\n};\n"
        for number, (x, y, z) in enumerate(places, 1)
    )
    return f"/PROG  PROBES\n/ATTR\n/MN\n{numbered}/POS\n{data}/END\n"


def rapid_program(probes: Sequence[Probe]) -> str:
    """The probes as a RAPID module, each reached by a joint move at v1000."""
    places = list(dict.fromkeys(point for probe in probes for point in probe.points))
    nowhere = ",".join(["9E9"] * 6)
    lines = ["MODULE Probes"]
    for number, (x, y, z) in enumerate(places, 1):
        turns = f"[{-1 if y < 0 else 0},0,0,0]"
        pose = f"[{x:g},{y:g},{z:g}],[0,0.3826834,0.9238795,0]"
        lines.append(f"  CONST robtarget p{number}:=[{pose},{turns},[{nowhere}]];")
    lines += ["  PROC main()", "    ConfL\\Off;", "    ConfJ\\Off;"]
    for probe in probes:
        lines.append(f"    MoveJ p{places.index(probe.points[0]) + 1},v1000,fine,tool0;")
        for point in probe.points[1:]:
            stop = probe.corner is None or point is probe.points[-1]
            zone = "fine" if stop else f"z{probe.corner}"
            lines.append(f"    Move{probe.kind} p{places.index(point) + 1},v{probe.speed},{zone},tool0;")
    return "\n".join([*lines, "  ENDPROC", "ENDMODULE", ""])


def timed(robot: str, probes: Sequence[Probe], controller: str | None = None) -> list[Timed]:
    """Run the probes as one program in the language of the robot's maker."""
    rapid = robot.startswith("abb")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / ("Probes.mod" if rapid else "probes.ls")
        path.write_text(rapid_program(probes) if rapid else tp_program(probes), encoding="utf-8")
        diagnostics = Diagnostics()
        program = read_program([path], None, diagnostics).program
    if diagnostics.has_errors:
        raise SystemExit(f"the probes are no program: {diagnostics.found[0].message}")
    result = run_program(program, robot, controller=controller)
    if result.fault is not None:
        raise SystemExit(f"{robot}: {result.fault.message}")
    moves = iter(event for event in result.trace if event.kind == "move")
    found = []
    for probe in probes:
        next(moves)
        found.append(_timed(probe, [next(moves) for _ in probe.points[1:]]))
    return found


def _timed(probe: Probe, events: Sequence[Event]) -> Timed:
    legs = [leg for event in events for leg in event.legs]
    start = min(leg.start_s for leg in legs)
    end = max(leg.start_s + leg.duration_s for leg in legs)
    if len(probe.points) < 3:
        return Timed(end - start, 0.0)
    near = np.inf
    for leg in legs:
        times = leg.offset_s + np.linspace(0.0, leg.duration_s, 801)
        points = leg.plan.tcp_at(times)[:, :3, 3]
        near = min(near, float(np.linalg.norm(points - np.array(probe.points[1]), axis=1).min()))
    return Timed(end - start, near)


# ---- tables


def table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A Markdown table."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join([*lines, *("| " + " | ".join(str(cell) for cell in row) + " |" for row in rows)])


def _pairs(measured: Sequence[float], emulated: Sequence[float], digits: int) -> list[str]:
    return [f"{a:.{digits}f} / {b:.{digits}f}" for a, b in zip(measured, emulated, strict=True)]


def joint_tables() -> Iterator[str]:
    """FANUC joint moves: measured / emulated."""
    rows = []
    for robot, ways in JOINT_TIMES.items():
        probes = [Probe("J", percent, WAYS[way]) for way in ways for percent in PERCENTS]
        times = [one.time_s for one in timed(robot, probes)]
        for place, (way, measured) in enumerate(ways.items()):
            emulated = times[place * len(PERCENTS) : (place + 1) * len(PERCENTS)]
            rows.append([f"{robot} {way}", *_pairs(measured, emulated, 3)])
    yield table(["joint moves, s", *(f"{percent} %" for percent in PERCENTS)], rows)
    rows = []
    probes = [Probe("J", speed, WAYS[way]) for way in MOVEJ_TIMES for speed in MOVEJ_SPEEDS]
    times = [one.time_s for one in timed(ABB, probes)]
    for place, (way, measured) in enumerate(MOVEJ_TIMES.items()):
        emulated = times[place * len(MOVEJ_SPEEDS) : (place + 1) * len(MOVEJ_SPEEDS)]
        rows.append([f"{ABB} {way}", *_pairs(measured, emulated, 3)])
    yield table(["MoveJ, s", *(f"v{speed}" for speed in MOVEJ_SPEEDS)], rows)


def linear_table() -> str:
    """600 mm along y: measured / emulated."""
    rows = []
    for robot, measured in LINEAR_TIMES.items():
        emulated = [one.time_s for one in timed(robot, [Probe("L", speed, LINE) for speed in LINEAR_SPEEDS])]
        rows.append([robot, *_pairs(measured, emulated, 3)])
    return table(["600 mm, s", *(f"{speed} mm/s" for speed in LINEAR_SPEEDS)], rows)


def corner_tables() -> Iterator[str]:
    """Right angles: cut and time, measured / emulated."""
    for robot, speeds in CNT_CORNERS.items():
        yield _corner_table(robot, "CNT", CNT, speeds)
    yield _corner_table(ABB, "z", ZONES, ZONE_CORNERS)


def _corner_table(
    robot: str,
    word: str,
    sizes: Sequence[int],
    speeds: Mapping[int, tuple[float, tuple[float, ...], tuple[float, ...]]],
) -> str:
    probes = [corner("L", speed, size) for speed in speeds for size in (None, *sizes)]
    found = iter(timed(robot, probes))
    rows = []
    for speed, (stop_s, times, cuts) in speeds.items():
        stop, *here = [next(found) for _ in range(len(sizes) + 1)]
        rows.append([f"{speed} mm/s, cut mm", "", *_pairs(cuts, [one.cut_mm for one in here], 2)])
        both = _pairs((stop_s, *times), [stop.time_s, *(one.time_s for one in here)], 3)
        rows.append([f"{speed} mm/s, time s", *both])
    return table([robot, "stop", *(f"{word}{size}" for size in sizes)], rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true")
    text = "\n\n".join([*joint_tables(), linear_table(), *corner_tables()])
    if parser.parse_args().write:
        put("measured moves", text)
    else:
        print(text)


def put(name: str, text: str) -> None:
    """Replace what stands in docs/fidelity.md between the two marks of that name."""
    path = Path(__file__).parents[1] / "docs" / "fidelity.md"
    page = path.read_text(encoding="utf-8")
    begin, end = f"<!-- {name}: generated -->", f"<!-- {name}: end -->"
    before, found, rest = page.partition(begin)
    _, ended, after = rest.partition(end)
    if not found or not ended:
        raise SystemExit(f"{path.name} has no place marked {begin} ... {end}")
    path.write_text(f"{before}{begin}\n\n{text}\n\n{end}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
