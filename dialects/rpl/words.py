"""Words of RPL that are needed before anything heavy is loaded."""

from __future__ import annotations

POSTURE_FLAGS = ("shoulder", "elbow", "wrist", "t1", "t4", "t6")
