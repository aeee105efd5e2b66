"""Noise of one unit in the last place on the functions in which mathematical libraries really differ, and what samples
show under it: translated texts, outcomes of proofs, events of runs with their places, and where the arm stands.

A library's sine may be off by one unit in the last place, and another one is off elsewhere: no verdict, posture, choice
or order may hang on that. `python tests/conformance/noise.py SEED SAMPLE:TARGET,TARGET...` runs samples in a process of
its own, so that the noise is there before any module of the product takes a function; seed 0 is no noise.
Square roots are exact everywhere (IEEE 754 asks for it) and so are sums and products of single numbers.
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
_ONE = ("sin", "cos", "tan", "asin", "acos", "atan", "exp", "log", "log10", "sinh", "cosh", "tanh", "expm1", "log1p")
_MORE = ("atan2", "hypot", "pow")
_IN_NUMPY = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2", "pow": "float_power"}
_WITHIN_ONE = frozenset(("sin", "cos", "tanh"))


def _step(salt: int, *values: float) -> int:
    """-1, 0 or 1, always the same for the same function and arguments."""
    return hash((salt, *values)) % 3 - 1


def _noisy(name: str, seed: int) -> Callable[..., float]:
    exact, salt = getattr(math, name), zlib.crc32(f"{seed} {name}".encode())

    def found(*values: float) -> float:
        result: float = exact(*values)
        # Every library gives sin(0), atan2(1, 0), asin(1) and kin without an error.
        if not result or not math.isfinite(result) or (0.0 in values) or (len(values) == 1 and abs(values[0]) == 1.0):
            return result
        near = math.nextafter(result, math.copysign(math.inf, _step(salt, *values))) if _step(salt, *values) else result
        return max(-1.0, min(1.0, near)) if name in _WITHIN_ONE else near

    return found


def _mixed(salt: int, values: list[Any], shape: tuple[int, ...]) -> Any:
    """A number of 64 bits for each element, made of the bits of its arguments (splitmix64)."""
    found = np.full(shape, np.uint64(salt))
    for value in values:
        bits = np.broadcast_to(np.asarray(value, dtype=np.float64) + 0.0, shape).copy().view(np.uint64)
        found = (found ^ bits) * np.uint64(0x9E3779B97F4A7C15)
        found = (found ^ (found >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        found = (found ^ (found >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        found ^= found >> np.uint64(31)
    return found


def _beside(result: Any, salt: int, values: list[Any], kept: Any, name: str) -> Any:
    whole = np.asarray(result, dtype=np.float64)
    steps = (_mixed(salt, values, whole.shape) % np.uint64(3)).astype(np.int64) - 1
    steps = np.where(kept | (whole == 0.0) | ~np.isfinite(whole), 0, steps)
    near = np.where(steps == 0, whole, np.nextafter(whole, np.where(steps > 0, np.inf, -np.inf)))
    if name in _WITHIN_ONE:
        near = np.clip(near, -1.0, 1.0)
    return near if isinstance(result, np.ndarray) else np.float64(near)


def _noisy_array(exact: Callable[..., Any], name: str, seed: int) -> Callable[..., Any]:
    salt = zlib.crc32(f"{seed} numpy {name}".encode())

    def found(*values: Any, **options: Any) -> Any:
        result = exact(*values, **options)
        if options or getattr(result, "dtype", None) != np.float64:
            return result
        with np.errstate(all="ignore"):
            parts = [np.broadcast_to(np.asarray(value, dtype=np.float64), np.shape(result)) for value in values]
            kept = np.zeros(np.shape(result), dtype=bool)
            for part in parts:
                kept |= (part == 0.0) | ((len(parts) == 1) & (np.abs(part) == 1.0))
            return _beside(result, salt, list(values), kept, name)

    return found


def _noisy_length(exact: Callable[..., Any], name: str, seed: int) -> Callable[..., Any]:
    """A length is a sum of squares, which machines add in another order or with one rounding less."""
    salt = zlib.crc32(f"{seed} length {name}".encode())

    def found(*values: Any, **options: Any) -> Any:
        result = exact(*values, **options)
        if name == "norm" and (len(values) > 1 or "ord" in options):
            return result
        whole = np.asarray(result, dtype=np.float64)
        near = _beside(np.asarray(whole), salt, [whole], np.zeros(whole.shape, dtype=bool), name)
        return near if isinstance(result, np.ndarray) else type(result)(near)

    return found


def make_noise(seed: int) -> None:
    """From here on the functions are off by up to one unit in the last place. For a process of its own."""
    for name in (*_ONE, *_MORE):
        in_numpy = _IN_NUMPY.get(name, name)
        setattr(np, in_numpy, _noisy_array(getattr(np, in_numpy), name, seed))
    for name in (*_ONE, *_MORE):
        setattr(math, name, _noisy(name, seed))
    math.dist = _noisy_length(math.dist, "dist", seed)
    np.linalg.norm = _noisy_length(np.linalg.norm, "norm", seed)


def _events(result: Any) -> list[list[Any]]:
    """Kind, what it shows, task and place of each event, in order; positions in numbers that are compared with a slack."""
    found = []
    for event in result.trace:
        shown = {key: value for key, value in event.data.items() if isinstance(value, str | int | float | bool | list)}
        leg = event.legs[-1] if event.legs else None
        ends = [] if leg is None else [float(one) for one in leg.plan.joints_at(leg.offset_s + leg.duration_s)]
        found.append([event.kind, event.task, event.origin.file, event.origin.line, event.t, shown, event.stops, ends])
    return found


def shown_by(name: str, targets: list[str]) -> dict[str, Any]:
    """What a sample shows: its own run and, of each target, the texts, the outcome and the run of what was written."""
    sys.path.insert(0, str(HERE))
    import outcomes

    from rpl import simulation

    runs: list[Any] = []
    texts: dict[str, dict[str, str]] = {}
    run_program, translate_program = simulation.run_program, outcomes.translate_program

    def run(*args: Any, **options: Any) -> Any:
        runs.append(run_program(*args, **options))
        return runs[-1]

    def translate(read: Any, target: str, *args: Any, **options: Any) -> Any:
        found = translate_program(read, target, *args, **options)
        texts[target] = {file.path: file.data.decode("latin-1") for file in found.files}
        return found

    simulation.run_program, outcomes.translate_program = run, translate
    try:
        found: dict[str, Any] = {}
        for target in targets:
            outcome = outcomes.results(name, [target])[target]
            found[target] = outcome.as_json() | {"why": outcome.why, "texts": texts.get(target)}
            found[target]["runs"] = [[one.status, one.messages, _events(one)] for one in runs]
            runs.clear()
        return found
    finally:
        simulation.run_program, outcomes.translate_program = run_program, translate_program


def main(words: list[str]) -> None:
    seed = int(words[0])
    if seed:
        make_noise(seed)
    for word in words[1:]:
        name, _, targets = word.partition(":")
        print(json.dumps([name, shown_by(name, targets.split(","))]), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
