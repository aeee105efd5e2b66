"""An arm with its bodies, its tool and its load as a geometry model of Pinocchio.

For what Pinocchio and coal do by themselves: distances and collisions of pairs at single postures. It tells which pairs
of an arm always touch; the sweep over a whole run has its own way through the same solids (`sweep`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.model import RobotModel
from rpl.emulator.rotations import FloatArray
from rpl.errors import UsageError
from rpl.workcell.sweeping.tracks import Piece

if TYPE_CHECKING:
    import pinocchio as pin  # ships no type information


@dataclass(frozen=True, slots=True, eq=False)
class ArmGeometry:
    """Pinocchio's model (joints in radians and mm), its bodies, and their work spaces."""

    model: pin.Model
    data: pin.Data
    bodies: pin.GeometryModel
    work: pin.GeometryData

    def collisions(self, theta: FloatArray) -> list[bool]:
        """For each pair of `bodies.collisionPairs` whether it touches with the joints (n,) at theta."""
        import pinocchio as pin

        pin.computeCollisions(self.model, self.data, self.bodies, self.work, theta, False)
        return [bool(found.isCollision()) for found in self.work.collisionResults]

    def distances(self, theta: FloatArray) -> list[float]:
        """For each pair the signed distance in mm."""
        import pinocchio as pin

        pin.computeDistances(self.model, self.data, self.bodies, self.work, theta)
        return [float(found.min_distance) for found in self.work.distanceResults]


def geometry_model(
    model: RobotModel, pieces: Sequence[Piece], pairs: Sequence[tuple[int, int]], base: FloatArray | None = None
) -> ArmGeometry:
    """The arm with pieces that go with its links, or stand (in the frame of its base, or of the cell where `base` is
    its place in it), and the pairs of them that are looked at.

    Raises UsageError where Pinocchio is not installed.
    """
    try:
        import pinocchio as pin
    except ImportError as error:
        raise UsageError("looking for collisions needs Pinocchio (pip install 'robot-rpl[kinematics]')") from error
    points, directions = model.arm.axes(np.zeros(model.axes))
    made = pin.Model()
    place = pin.SE3(np.eye(4) if base is None else base)
    parent, before = 0, np.zeros(3)
    joints = [0]
    for number, (point, direction, turning) in enumerate(zip(points, directions, model.revolute, strict=True)):
        kind = pin.JointModelRevoluteUnaligned if turning else pin.JointModelPrismaticUnaligned
        shifted = pin.SE3(np.eye(3), point - before)
        parent = made.addJoint(
            parent, kind(direction), place * shifted if number == 0 else shifted, f"joint{number + 1}"
        )
        joints.append(parent)
        before = point
    bodies = pin.GeometryModel()
    for number, piece in enumerate(pieces):
        moves = piece.way >= 0 and piece.link > 0
        at = pin.SE3(piece.at)
        if moves:
            at = pin.SE3(np.eye(3), -points[piece.link - 1]) * at
        elif piece.way >= 0:
            at = place * at
        body = pin.GeometryObject(f"body{number}", joints[piece.link] if moves else 0, at, piece.solid.geometry)
        bodies.addGeometryObject(body)
    for first, second in pairs:
        bodies.addCollisionPair(pin.CollisionPair(first, second))
    work = pin.GeometryData(bodies)
    for request in work.distanceRequests:
        request.enable_signed_distance = True
    return ArmGeometry(made, made.createData(), bodies, work)
