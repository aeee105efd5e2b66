"""Noise of one unit in the last place on the functions in which mathematical libraries really differ, and what samples
show under it: translated texts, outcomes of proofs, events of runs with their places, and where the arm stands.

A library's sine may be off by one unit in the last place, and another library's is off elsewhere: no verdict, posture,
choice or order may hang on that. `python tests/conformance/noise.py SEED SAMPLE:TARGET,TARGET...` runs samples in a
process of its own, so that the noise is there before any module of the product takes a function; seed 0 is no noise.
Square roots, sums and products of two numbers are the same on all machines (IEEE 754 asks for it) and stay as they are.
"""

from __future__ import annotations

import json
import math
import sys
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).parent
# Names in `math`, and in NumPy where that has another one.
NAMES = (
    *("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "hypot", "pow"),
    *("exp", "expm1", "log", "log10", "log1p", "sinh", "cosh", "tanh"),
)
IN_NUMPY = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2", "pow": "float_power"}
WITHIN_ONE = frozenset(("sin", "cos", "tanh"))


def make_noise(seed: int) -> None:
    """From here on the functions are off by up to one unit in the last place, always alike for the same arguments. For
    a process of its own, before it imports the product."""
    for name in NAMES:
        in_numpy = IN_NUMPY.get(name, name)
        setattr(np, in_numpy, _noisy_array(getattr(np, in_numpy), name, _salt(seed, f"numpy {name}")))
        setattr(math, name, _noisy(getattr(math, name), name, _salt(seed, name)))
    # A length is a sum of squares, which machines add in another order or with a rounding less.
    math.dist = _noisy_length(math.dist, _salt(seed, "dist"))
    np.linalg.norm = _noisy_length(np.linalg.norm, _salt(seed, "norm"))


def _salt(seed: int, name: str) -> int:
    return zlib.crc32(f"{seed} {name}".encode())


def _noisy(exact: Callable[..., float], name: str, salt: int) -> Callable[..., float]:
    def found(*values: float) -> float:
        result = exact(*values)
        # Every library gives sin(0), asin(1), atan2(1, 0) and kin as they are.
        if not result or not math.isfinite(result) or 0.0 in values or (len(values) == 1 and abs(values[0]) == 1.0):
            return result
        step = hash((salt, *values)) % 3 - 1
        near = math.nextafter(result, math.copysign(math.inf, step)) if step else result
        return max(-1.0, min(1.0, near)) if name in WITHIN_ONE else near

    return found


def _noisy_array(exact: Callable[..., Any], name: str, salt: int) -> Callable[..., Any]:
    def found(*values: Any, **options: Any) -> Any:
        result = exact(*values, **options)
        if options or getattr(result, "dtype", None) != np.float64:
            return result
        kept = np.zeros(np.shape(result), dtype=bool)
        for value in values:
            part = np.asarray(value, dtype=np.float64)
            kept |= (part == 0.0) | ((len(values) == 1) & (np.abs(part) == 1.0))
        near = _beside(result, salt, values, kept)
        if name in WITHIN_ONE:
            near = np.clip(near, -1.0, 1.0)
        return near if isinstance(result, np.ndarray) else np.float64(near)

    return found


def _noisy_length(exact: Callable[..., Any], salt: int) -> Callable[..., Any]:
    def found(*values: Any, **options: Any) -> Any:
        result = exact(*values, **options)
        near = _beside(result, salt, (result,), np.zeros(np.shape(result), dtype=bool))
        return near if isinstance(result, np.ndarray) else type(result)(near)

    return found


def _beside(result: Any, salt: int, values: tuple[Any, ...], kept: Any) -> Any:
    """The results, each a unit in the last place higher or lower or as it is, by the bits of its arguments."""
    whole = np.asarray(result, dtype=np.float64)
    steps = (_mixed(salt, values, whole.shape) % np.uint64(3)).astype(np.int64) - 1
    with np.errstate(all="ignore"):
        near = np.nextafter(whole, np.where(steps > 0, np.inf, -np.inf))
    return np.where((steps == 0) | kept | (whole == 0.0) | ~np.isfinite(whole), whole, near)


def _mixed(salt: int, values: tuple[Any, ...], shape: tuple[int, ...]) -> Any:
    """A number of 64 bits for each element, made of the bits of its arguments (splitmix64)."""
    found = np.full((*shape, 1), salt, dtype=np.uint64)
    for value in values:
        part = np.broadcast_to(np.asarray(value, dtype=np.float64) + 0.0, shape)
        found = (found ^ part.copy().view(np.uint64).reshape(found.shape)) * np.uint64(0x9E3779B97F4A7C15)
        found = (found ^ (found >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        found ^= found >> np.uint64(27)
    return found[..., 0]


# ---- what a sample shows


def shown_by(name: str, targets: list[str]) -> dict[str, Any]:
    """Of each target the outcome of the proof, the texts, and the runs: the sample's own, where it is made for the
    first time, and that of what was written."""
    sys.path.insert(0, str(HERE))
    import outcomes

    from rpl import simulation

    runs: list[Any] = []
    texts: dict[str, str] = {}
    run_program, translate_program = simulation.run_program, outcomes.translate_program

    def run(*args: Any, **options: Any) -> Any:
        runs.append(run_program(*args, **options))
        return runs[-1]

    def translate(*args: Any, **options: Any) -> Any:
        found = translate_program(*args, **options)
        texts.update({file.path: file.data.decode("latin-1") for file in found.files})
        return found

    simulation.run_program, outcomes.translate_program = run, translate
    found: dict[str, Any] = {}
    try:
        for target in targets:
            outcome = outcomes.results(name, [target])[target]
            found[target] = {"outcome": outcome.as_json(), "texts": dict(texts)}
            found[target]["runs"] = [[one.status, list(one.messages), _events(one)] for one in runs]
            found[target]["why"] = outcome.why
            runs.clear()
            texts.clear()
    finally:
        simulation.run_program, outcomes.translate_program = run_program, translate_program
    return found


def _events(result: Any) -> list[list[Any]]:
    """Task, kind, place, time and what it shows of each event in order; of a move also where the arm stands behind it
    and whether it stops there."""
    found = []
    for event in result.trace:
        shown = {key: value for key, value in event.data.items() if isinstance(value, str | int | float | bool | list)}
        leg = event.legs[-1] if event.legs else None
        ends = [] if leg is None else [float(one) for one in leg.plan.joints_at(leg.offset_s + leg.duration_s)]
        file = Path(event.origin.file).name
        found.append([event.task, event.kind, file, event.origin.line, event.stops, event.t, ends, shown])
    return found


def difference(one: Any, other: Any, where: str = "", slack: float = 1e-5) -> str:
    """Where two such records differ first, empty for nowhere; numbers that are computed may be `slack` apart."""
    if isinstance(one, float) and isinstance(other, float):
        near = abs(one - other) <= slack * max(1.0, abs(one), abs(other))
        return "" if near else f"{where}: {one!r} is {other!r}"
    if type(one) is not type(other):
        return f"{where}: {one!r} is {other!r}"
    if isinstance(one, dict):
        if one.keys() != other.keys():
            return f"{where}: {sorted(one)} is {sorted(other)}"
        pairs = [(f"{where} {key}", value, other[key]) for key, value in one.items() if key != "why"]
    elif isinstance(one, list):
        if len(one) != len(other):
            return f"{where}: {len(one)} is {len(other)}"
        pairs = [(f"{where}[{number}]", *both) for number, both in enumerate(zip(one, other, strict=True))]
    elif isinstance(one, str) and "\n" in one and one != other:
        return difference(one.splitlines(), other.splitlines(), where, slack)
    else:
        return "" if one == other else f"{where}: {one!r} is {other!r}"
    return next((found for found in (difference(a, b, name, slack) for name, a, b in pairs) if found), "")


def main(words: list[str]) -> None:
    if int(words[0]):
        make_noise(int(words[0]))
    for word in words[1:]:
        name, _, targets = word.partition(":")
        print(json.dumps([name, shown_by(name, targets.split(","))]), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
