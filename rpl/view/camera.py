"""The camera of a picture: the same as that of the page (`player/camera.js`), z up, around a target."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np

from rpl.emulator.rotations import FloatArray

SIGHT_DEG = 30.0
MARGIN = 1.08
# Azimuth of the eye about z from +x, and its elevation, in degrees.
VIEWS = {"isometric": (-55.0, 26.0), "front": (-90.0, 0.0), "side": (0.0, 0.0), "top": (-90.0, 89.9)}


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """Looks from `distance` mm at the target (3,), from an azimuth and an elevation in degrees."""

    target: FloatArray
    distance: float
    azimuth: float
    elevation: float

    @classmethod
    def around(cls, bounds: FloatArray, view: str, aspect: float = 1.5) -> Camera:
        """From one of the `VIEWS`, so far away that a box (2, 3) just fits into a picture of that width by height."""
        found = cls(bounds.mean(axis=0), 1.0, *VIEWS[view])
        corners = np.array(list(itertools.product(*bounds.T))) - found.target
        local = np.abs(corners @ found.axes.T)
        room = math.tan(math.radians(SIGHT_DEG / 2.0)) / min(aspect, 1.0)
        depth = corners @ found.axes[2]
        far = depth + np.maximum(local[:, 0] / (room * aspect), local[:, 1] / room)
        return replace(found, distance=MARGIN * max(float(far.max()), 100.0))

    @property
    def axes(self) -> FloatArray:
        """Right, up and backwards (3, 3) as rows."""
        turn, lift = math.radians(self.azimuth), math.radians(self.elevation)
        back = np.array([math.cos(lift) * math.cos(turn), math.cos(lift) * math.sin(turn), math.sin(lift)])
        right = np.array([-math.sin(turn), math.cos(turn), 0.0])
        return np.stack([right, np.cross(back, right), back])

    @property
    def eye(self) -> FloatArray:
        """Where it is (3,)."""
        return np.asarray(self.target + self.axes[2] * self.distance)

    def seen(self, points: FloatArray, width: int, height: int) -> FloatArray:
        """Points (..., 3) of the cell on a picture (..., 3): x and y in pixels, and a depth that is linear there (minus
        one by the distance); NaN behind the camera."""
        local = (points - self.eye) @ self.axes.T
        away = -local[..., 2]
        away = np.where(away > self.distance / 100.0, away, np.nan)
        scale = min(width, height) / 2.0 / math.tan(math.radians(SIGHT_DEG / 2.0))
        x, y = width / 2.0 + scale * local[..., 0] / away, height / 2.0 - scale * local[..., 1] / away
        return np.stack([x, y, -1.0 / away], axis=-1)
