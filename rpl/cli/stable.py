"""`rpl stable`: how a part can rest on a level surface, and how likely each way is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from rpl.cli.output import counting, json_option, numbers, print_json, say, waiting
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.cell.defaultgrasps import DefaultGrasp
    from rpl.cell.layout import Gripper
    from rpl.cell.shapes import Shape
    from rpl.cell.stable import StableState
    from rpl.emulator.rotations import FloatArray

_LARGEST_SEED = 2**63 - 1


@click.command("stable")
@click.argument("file", required=False, metavar="[FILE]")
@click.option("--box", metavar="X,Y,Z", help="A box of these sides in mm instead of a file.")
@click.option("--cylinder", metavar="D,H", help="A cylinder about z: diameter and height in mm.")
@click.option("--sphere", metavar="D", help="A sphere: diameter in mm.")
@click.option(
    "--capsule", metavar="D,L", help="A cylinder about z between half spheres: diameter, length between them."
)
@click.option("--scale", type=float, metavar="K", help="Factor on the lengths of FILE; its size is believed then.")
@click.option("--repair", is_flag=True, help="Close small holes of FILE and turn turned triangles.")
@click.option("--com", metavar="X,Y,Z", help="Centre of mass in mm; else that of an even density.")
@click.option("--method", default="fast", metavar="fast|dynamic", help="Estimate, or drop it in MuJoCo and count.")
@click.option("--drops", type=int, metavar="N", help="How often --method dynamic drops it (1,000).")
@click.option("--seed", type=click.IntRange(0, _LARGEST_SEED), default=1, metavar="N", help="Of the drops (1).")
@click.option("--drop-height", type=float, metavar="MM", help="How far it falls; else far enough to turn over.")
@click.option("--down", metavar="X,Y,Z", help="Direction of the part held downwards before it falls (0,0,-1).")
@click.option("--jaws", metavar="LOW,HIGH", help="Default grasps of parallel jaws that open from LOW to HIGH mm.")
@click.option("--cup", is_flag=True, help="Default grasps of a vacuum cup.")
@json_option
def command(
    file: str | None,
    box: str | None,
    cylinder: str | None,
    sphere: str | None,
    capsule: str | None,
    scale: float | None,
    repair: bool,
    com: str | None,
    method: str,
    drops: int | None,
    seed: int,
    drop_height: float | None,
    down: str | None,
    jaws: str | None,
    cup: bool,
    as_json: bool,
) -> int:
    """Every way in which a part can rest on a level surface, the likeliest first, with its probability.

    FILE is a mesh: STL, OBJ, PLY (in mm), GLB (in metres) or STEP.

    JSON: `states` with `normal` (direction of the part that points down), `rotation` (quaternion w, x, y, z from the
    part's frame to the world's), `probability`, and `height_mm` (of the part's origin above the surface). With --jaws
    or --cup also `grasps`: the number of the state, and `grip`, `approach` and `depart` in the part's frame.
    """
    from rpl.cell.defaultgrasps import default_grasps
    from rpl.cell.layout import Part
    from rpl.cell.stable import AS_DRAWN, DROPS, stable_states

    if down is not None and drop_height is None:
        raise UsageError("--down says how the part is held before it falls: it needs --drop-height")
    if drops is not None and (drops < 1 or method != "dynamic"):
        raise UsageError("--drops is a number above 0 for --method dynamic")
    shape = _shape(file, {"box": box, "cylinder": cylinder, "sphere": sphere, "capsule": capsule}, scale, repair)
    times = drops or DROPS
    centre = numbers(com, "--com", 3) if com is not None else None
    held = numbers(down, "--down", 3) if down is not None else AS_DRAWN
    with counting("dropping", times) as tell:
        states = stable_states(
            shape,
            method=method,
            com=centre,
            drop_height_mm=drop_height,
            down=held,
            seed=seed,
            drops=times,
            tell=lambda done: tell(done, ""),
        )
    gripper = _gripper(jaws, cup)
    grasps = default_grasps(Part("part", shape), gripper, states) if gripper is not None else ()
    if as_json:
        named = {"grasps": [_grasp_document(one) for one in grasps]} if gripper is not None else {}
        print_json({"states": [_document(state) for state in states], **named})
    else:
        _show(states)
        if gripper is not None:
            _show_grasps(states, grasps)
    return 0


def _gripper(jaws: str | None, cup: bool) -> Gripper | None:
    """The one that is asked for."""
    from rpl.cell.layout import Gripper

    if jaws is not None and cup:
        raise UsageError("--jaws and --cup: one gripper at a time")
    if jaws is None:
        return Gripper("cup", "suction") if cup else None
    low, high = numbers(jaws, "--jaws", 2)
    if not 0.0 <= low < high:
        raise UsageError(f"--jaws {jaws}: the least and the greatest distance of the jaws in mm")
    return Gripper("jaws", "jaws", opening=(low, high))


def _shape(file: str | None, forms: dict[str, str | None], scale: float | None, repair: bool) -> Shape:
    """The one form that is asked for. Raises UsageError for none, for several, and for sides that are not above 0."""
    from rpl.cell.meshes import load_mesh
    from rpl.cell.shapes import Box, Capsule, Cylinder, Sphere

    given = {name: text for name, text in forms.items() if text is not None}
    if len(given) + (file is not None) != 1:
        raise UsageError("one part is needed: a FILE, or one of --box, --cylinder, --sphere and --capsule")
    if file is not None:
        with waiting("reading"):
            return load_mesh(file, scale, repair)
    if scale is not None or repair:
        raise UsageError("--scale and --repair are for a FILE")
    ((name, text),) = given.items()
    sides = numbers(text, f"--{name}", {"box": 3, "sphere": 1}.get(name, 2))
    if not all(side > 0.0 for side in sides):
        raise UsageError(f"--{name} {text}: a side is not above 0")
    match name, sides:
        case "box", [x, y, z]:
            return Box((x, y, z))
        case "cylinder", [diameter, height]:
            return Cylinder(diameter, height)
        case "sphere", [diameter]:
            return Sphere(diameter)
        case _:
            return Capsule(sides[0], sides[1])


def _document(state: StableState) -> dict[str, object]:
    return {
        "normal": [round(one, 9) for one in state.normal],
        "rotation": [round(one, 9) for one in state.rotation],
        "probability": round(state.probability, 12),
        "height_mm": round(state.height_mm, 6),
    }


def _show(states: Sequence[StableState]) -> None:
    say("probability                  height mm  down in the part        rotation w, x, y, z")
    for state in states:
        between = f" ({state.interval[0]:.3f} to {state.interval[1]:.3f})" if state.interval else ""
        normal = " ".join(f"{one:7.3f}" for one in state.normal)
        rotation = " ".join(f"{one:7.4f}" for one in state.rotation)
        say(f"{state.probability:.4f}{between:19} {state.height_mm:12.3f}  {normal}  {rotation}")


def _pose_document(pose: FloatArray) -> dict[str, object]:
    from rpl.emulator.rotations import matrix_to_quaternion

    quaternion = matrix_to_quaternion(pose[:3, :3])
    return {
        "xyz_mm": [round(float(one), 6) + 0.0 for one in pose[:3, 3]],
        "quat_wxyz": [round(float(one), 9) + 0.0 for one in quaternion],
    }


def _grasp_document(one: DefaultGrasp) -> dict[str, object]:
    ways = {"grip": one.grip, "approach": one.approach, "depart": one.depart}
    return {
        "state": one.state,
        **{name: _pose_document(pose) for name, pose in ways.items()},
        "width_mm": round(one.width_mm, 6),
    }


def _show_grasps(states: Sequence[StableState], grasps: Sequence[DefaultGrasp]) -> None:
    """Where each state is taken, in the part's frame; z of the grip away from the gripper."""
    from rpl.emulator.rotations import matrix_to_zyx

    say("")
    say("grasp of       grip x y z mm               a b c degrees             jaws mm  approach x y z mm")
    by_state = {one.state: one for one in grasps}
    for number in range(len(states)):
        one = by_state.get(number)
        if one is None:
            say(f"state {number + 1:<3}      this gripper cannot take it so")
            continue
        place, turn, before = (
            " ".join(f"{float(each) + 0.0:8.2f}" for each in row)
            for row in (one.grip[:3, 3], matrix_to_zyx(one.grip[:3, :3]), one.approach[:3, 3])
        )
        say(f"state {number + 1:<3} {place}  {turn}  {one.width_mm:8.2f}  {before}")
