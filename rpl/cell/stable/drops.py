"""Stable states by dropping the part many times in MuJoCo: the slow estimator that knows bounces, friction and spin.

Everything is scaled so that the part's largest side is one metre. Rigid bodies that fall, bounce and rub do the same at
every size (Froude's similarity: only times stretch, with the root of the size), so one set of contact settings serves
all parts. A drop ends as soon as the part has less energy than it takes to leave the state that it is in.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rpl.cell.stable.basins import Basins
from rpl.cell.stable.hull import Hull
from rpl.emulator.rotations import FloatArray, IntArray
from rpl.errors import UsageError

_GRAVITY = 9.81
_STEP_S = 0.002
_BETWEEN = 10  # steps between two looks at the energy
_LONGEST_S = 60.0


@dataclass(frozen=True, slots=True)
class Drop:
    """How a part falls. Lengths in parts of its largest side. With what stands here the counts come within 0.04 of the
    published throws of cuboids, without spin within 0.06; a restitution of 0.6 and more is beyond soft contacts."""

    height: float = 1.0  # of the lowest point above the support
    restitution: float = 0.2
    friction: float = 0.4
    spin: float = 2.0  # deviation of the first angular velocity about each axis, in parts of sqrt(g / largest side)


def dropped(
    hull: Hull,
    basins: Basins,
    inertia: FloatArray,
    times: int,
    seed: int,
    drop: Drop,
    tell: Callable[[int], None] = lambda done: None,
) -> IntArray:
    """How often (s,) the part came to rest in each state.

    inertia: (3, 3) about the centre of mass for a mass of one, in mm2. The first orientations are evenly distributed
    over all rotations. The same seed gives the same counts.
    Raises UsageError where MuJoCo is not installed.
    """
    try:
        import mujoco
    except ImportError:
        raise UsageError("--method dynamic needs the package mujoco: pip install 'robot-rpl[cell]'") from None

    size = hull.largest_mm
    model = mujoco.MjModel.from_xml_string(_model(hull.corners / size, inertia / size**2, drop))
    data = mujoco.MjData(model)
    random = np.random.default_rng(seed)
    counts = np.zeros(len(basins.probabilities), dtype=np.int64)
    leaving = basins.leaving / size
    for done in range(times):
        mujoco.mj_resetData(model, data)
        turn = random.normal(size=4)
        data.qpos[3:] = turn / np.linalg.norm(turn)
        mujoco.mj_kinematics(model, data)
        rotation = data.xmat[1].reshape(3, 3)
        lowest = float((hull.corners @ rotation[2]).min()) / size
        data.qpos[2] = drop.height - lowest
        data.qvel[3:] = random.normal(size=3) * drop.spin * np.sqrt(_GRAVITY)
        counts[_settled(mujoco.mj_step, model, data, hull, basins, leaving)] += 1
        tell(done + 1)
    return counts


def _settled(step: Callable[..., None], model: Any, data: Any, hull: Hull, basins: Basins, leaving: FloatArray) -> int:
    """The state that the part can no longer leave."""
    calm = 0
    while True:
        step(model, data, nstep=_BETWEEN)
        down = -data.xmat[1].reshape(3, 3)[2]
        state = int(basins.state_of[hull.under(down)])
        energy = float(data.energy.sum()) / _GRAVITY
        calm = calm + 1 if energy < leaving[state] else 0
        if calm == 2 or data.time > _LONGEST_S:
            return state


def _model(corners: FloatArray, inertia: FloatArray, drop: Drop) -> str:
    """A body of mass one that is the hull of the corners, above a plane."""
    # Damping of a spring that gives a contact this restitution: e = exp(-pi z / sqrt(1 - z^2)).
    bounce = np.log(max(drop.restitution, 1e-3))
    damping = float(-bounce / np.hypot(np.pi, bounce))
    contact = f'solref="{3.0 * _STEP_S} {damping:.6f}" friction="{drop.friction} 0 0" condim="3"'
    points = " ".join(f"{value:.9f}" for value in corners.ravel())
    full = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    moments = " ".join(f"{value:.12f}" for value in full)
    return f"""
<mujoco>
  <compiler balanceinertia="true" boundmass="1e-9"/>
  <option timestep="{_STEP_S}" gravity="0 0 {-_GRAVITY}" integrator="implicitfast" cone="elliptic">
    <flag energy="enable"/>
  </option>
  <asset><mesh name="part" vertex="{points}" inertia="convex"/></asset>
  <worldbody>
    <geom type="plane" size="50 50 1" {contact}/>
    <body>
      <freejoint/>
      <inertial pos="0 0 0" mass="1" fullinertia="{moments}"/>
      <geom type="mesh" mesh="part" {contact}/>
    </body>
  </worldbody>
</mujoco>
"""
