"""Joint torques of an arm along its motion, by Pinocchio's recursive Newton-Euler algorithm.

The rigid-body model is built from the joint axes of the kinematics and the bodies of the robot file, so that it moves
exactly as the kinematics do. Friction is not part of it. Pinocchio is imported inside the functions: kinematics and
programs load without it.
"""

from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.inertias import ArmInertias, Body, together
from rpl.emulator.model import RobotModel
from rpl.emulator.robotfile import RobotError
from rpl.emulator.rotations import FloatArray

if TYPE_CHECKING:
    import pinocchio as pin  # ships no type information

__all__ = ["ArmDynamics"]

GRAVITY_M_S2 = 9.81


class ArmDynamics:
    """The rigid-body model of one arm, with what it carries at the flange. Raises RobotError without inertias."""

    def __init__(self, model: RobotModel, payload: Body | None = None) -> None:
        inertias = model.inertias
        if inertias is None:
            raise RobotError(f"{model.name}: no inertias in the robot file, so no torques")
        try:
            import pinocchio as pin
        except ImportError as error:
            raise RobotError("torques need Pinocchio (pip install 'robot-rpl[kinematics]')") from error
        self._pin = pin
        self._model = model
        self._rotors = inertias.rotors if inertias.rotors is not None else np.zeros(model.axes)
        # Metres of a sliding joint; its torque is a force then.
        self._scale = np.where(model.revolute, 1.0, 1e-3)
        self._chain = _chain(model, inertias)
        self._data = self._chain.createData()
        self._last = self._chain.inertias[model.axes].copy()
        zero = np.zeros(model.axes)
        points, _ = model.arm.axes(zero)
        self._flange = model.arm.forward(zero)
        self._flange[:3, 3] -= points[-1]
        self.carry(payload)

    def carry(self, payload: Body | None) -> None:
        """From now on this body hangs at the flange, given in the flange's frame; None: nothing."""
        body = None if payload is None else payload.seen_from(self._flange)
        carried = self._last if body is None else self._last + _inertia(self._pin, body)
        self._chain.inertias[self._model.axes] = carried

    def torques(self, joints: FloatArray, speeds: FloatArray, accelerations: FloatArray) -> FloatArray:
        """Torques (k, n) in N m (N of a sliding joint) of the drives at the joints, in the signs of the pendant, for
        joints (k, n) in pendant units, speeds and accelerations in those per s and s2."""
        rnea, chain, data = self._pin.rnea, self._chain, self._data
        to_arm = self._model.pendant_to_arm
        theta = self._model.theta(joints) * self._scale
        rate, change = ((values @ to_arm.T) * self._model.unit * self._scale for values in (speeds, accelerations))
        found = np.empty_like(theta)
        for row in range(len(theta)):
            found[row] = rnea(chain, data, theta[row], rate[row], change[row])
        # What the joints do to the arm, they do through the coupling: equal work in either coordinates.
        torques: FloatArray = found @ to_arm + self._rotors * (accelerations * self._model.unit * self._scale)
        return torques

    def energy(self, joints: FloatArray, speeds: FloatArray) -> FloatArray:
        """Kinetic and potential energy (k,) in J of links, load and rotors, potential energy 0 in the base plane."""
        pin, chain, data = self._pin, self._chain, self._data
        theta = self._model.theta(joints) * self._scale
        rate = (speeds @ self._model.pendant_to_arm.T) * self._model.unit * self._scale
        rotors = 0.5 * (self._rotors * (speeds * self._model.unit * self._scale) ** 2).sum(axis=1)
        rows = zip(theta, rate, strict=True)
        found: FloatArray = rotors + [float(pin.computeMechanicalEnergy(chain, data, q, v)) for q, v in rows]
        return found


def _chain(model: RobotModel, inertias: ArmInertias) -> "pin.Model":
    """Joint frames stand on their axes, turned like the base when theta is zero."""
    import pinocchio as pin

    chain = pin.Model()
    chain.gravity.linear = np.array([0.0, 0.0, -GRAVITY_M_S2])
    zero = np.zeros(model.axes)
    points, directions = model.arm.axes(zero)
    before, parent = np.zeros(3), 0
    for number, (point, direction, body) in enumerate(zip(points, directions, inertias.links, strict=True)):
        turning = model.revolute[number]
        joint = pin.JointModelRevoluteUnaligned if turning else pin.JointModelPrismaticUnaligned
        placement = pin.SE3(np.eye(3), (point - before) / 1000.0)
        axis = direction / np.linalg.norm(direction)
        parent = chain.addJoint(parent, joint(axis), placement, f"j{number + 1}")
        away = np.eye(4)
        away[:3, 3] = -point
        chain.inertias[parent] = _inertia(pin, together((body.seen_from(away),)))
        before = point
    return chain


def _inertia(pin: "pin", body: Body) -> "pin.Inertia":
    return pin.Inertia(body.mass, body.centre / 1000.0, body.inertia)
