"""Masses of an arm and of what it carries: the optional data behind motor torques.

A robot file gives each link's mass, centre and inertia as they were published, in a frame that the file states in the
arm's base at the posture where all the family's own joint variables are zero; here they are brought into the base.
"""

from dataclasses import dataclass

import numpy as np

from rpl.emulator.robotfile import WeightFile
from rpl.emulator.rotations import FloatArray

# M: how far the joints of an arm follow behind their command where its file says nothing: the time constant of a
# position loop with a gain of 50 1/s. Drives are tuned between 20 and 100 1/s (10 to 50 ms).
LAG_S = 0.02


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A rigid body: mass kg, centre (3,) mm, and inertia (3, 3) kg m2 about the centre, axes of the frame it is in."""

    mass: float
    centre: FloatArray
    inertia: FloatArray

    def seen_from(self, pose: FloatArray) -> "Body":
        """The same body, its frame standing at `pose` (4, 4) in the frame of the result."""
        turn = pose[:3, :3]
        return Body(self.mass, turn @ self.centre + pose[:3, 3], turn @ self.inertia @ turn.T)


@dataclass(frozen=True, slots=True, eq=False)
class ArmInertias:
    """What an arm weighs. `links`: one body a joint, in the base frame at theta = 0. Per axis, None where not known:
    `torques` that the drives can give at the joint, N m (N of a sliding one); `rotors`: inertia of motor and gear at
    the joint, kg m2 (kg). `source`: who published it."""

    links: tuple[Body, ...]
    torques: FloatArray | None
    rotors: FloatArray | None
    source: str


def arm_inertias(file: WeightFile) -> ArmInertias:
    """The published numbers, brought into the base frame."""
    links = []
    for link in file.links:
        frame = np.eye(4)
        frame[:3, :3] = np.array(link.axes).T
        frame[:3, 3] = link.origin
        links.append(Body(link.mass, np.array(link.centre), inertia_matrix(link.inertia)).seen_from(frame))
    torques, rotors = (None if values is None else np.array(values) for values in (file.torques, file.rotors))
    return ArmInertias(tuple(links), torques, rotors, file.source)


def inertia_matrix(values: tuple[float, ...]) -> FloatArray:
    """xx, yy, zz and, if given, xy, xz, yz as a symmetric matrix."""
    xx, yy, zz, xy, xz, yz = (*values, 0.0, 0.0, 0.0)[:6]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def together(bodies: tuple[Body, ...]) -> Body:
    """Several bodies in one frame as one, by Steiner's theorem; a body without mass where there are none."""
    mass = sum(body.mass for body in bodies)
    if mass <= 0.0:
        return Body(0.0, np.zeros(3), sum((body.inertia for body in bodies), np.zeros((3, 3))))
    centre = np.asarray(sum((body.mass * body.centre for body in bodies), np.zeros(3)) / mass)
    inertia = np.zeros((3, 3))
    for body in bodies:
        off = (body.centre - centre) / 1000.0
        inertia = inertia + body.inertia + body.mass * (off @ off * np.eye(3) - np.outer(off, off))
    return Body(mass, centre, inertia)
