"""Stable states of parts: every way to rest on a level support, with its probability."""

from rpl.cell.stable.drops import Drop
from rpl.cell.stable.states import AS_DRAWN, DROPS, METHODS, StableState, stable_states

__all__ = ["AS_DRAWN", "DROPS", "METHODS", "Drop", "StableState", "stable_states"]
