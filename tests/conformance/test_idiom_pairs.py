"""Tasks that samples hold in six languages by hand: the versions do the same, and a translation of one is no longer and
no poorer than recorded beside the version by hand.

That a translation means what its source means is proved for every sample by test_conformance_samples.py; that the
versions by hand do the same stands here. So a translation is compared with the other version by proof, too.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from idiom_pairs import LANGUAGES, TASKS, entry_of, figures, recorded, version, worse

from rpl.emulator.model import load_robot
from rpl.emulator.rotations import FloatArray
from rpl.runtime.moves.chain import matrix_of
from rpl.simulation import run_program

each_task = pytest.mark.parametrize("task", TASKS)
# Millimetres; the numbers of a rotation. URScript rounds its rotation vectors to four places.
_NEAR, _TURNED = 0.2, 0.001


@cache
def deeds(task: str, language: str) -> tuple[tuple[tuple[int, bool], ...], tuple[FloatArray, ...]]:
    """What a version does: its outputs, each signal by the place of its first change, and where the tool stands after
    each move, but for those to the posture that it begins with. Heights count from the first place: some brands put
    their base on the floor, others on axis 2."""
    project, read, cell = version(task, language)
    entry = entry_of(project)
    result = run_program(read.program, project.robot, cell, entry, controller="plain")
    assert result.status == "finished", result.fault
    order: dict[str, int] = {}
    outputs = tuple((order.setdefault(name, len(order)), bool(value)) for _, name, value in result.outputs)
    robot = load_robot(project.robot)
    programmed = [event.programmed for event in result.trace if event.kind == "move" and event.programmed is not None]
    poses = []
    for one in programmed:
        assert one.joints is not None
        assert programmed[0].joints is not None
        if not np.allclose(one.joints, programmed[0].joints, atol=0.01):
            poses.append(robot.forward(one.joints) @ (np.eye(4) if one.tool is None else matrix_of(one.tool)))
    return outputs, tuple(poses)


@each_task
@pytest.mark.parametrize("language", LANGUAGES[1:])
def test_the_versions_by_hand_do_the_same(task: str, language: str) -> None:
    outputs, poses = deeds(task, LANGUAGES[0])
    theirs, other = deeds(task, language)
    assert theirs == outputs
    assert len(other) == len(poses)
    shift = np.array([0.0, 0.0, other[0][2, 3] - poses[0][2, 3]])
    for pose, found in zip(poses, other, strict=True):
        assert found[:3, 3] - shift == pytest.approx(pose[:3, 3], abs=_NEAR)
        assert found[:3, :3] == pytest.approx(pose[:3, :3], abs=_TURNED)


@each_task
@pytest.mark.parametrize("source", LANGUAGES)
def test_translations_are_no_worse_than_recorded_beside_the_versions_by_hand(task: str, source: str) -> None:
    """One that is better: `python tests/conformance/idiom_pairs.py write` records it."""
    known = recorded()[task]
    found = {}
    for target in LANGUAGES:
        if target != source:
            found[target] = worse(known[f"{source} -> {target}"], figures(task, source, target))
    assert not any(found.values()), found


@each_task
def test_translations_are_as_long_as_the_versions_by_hand(task: str) -> None:
    """Give or take 30 %, in lines of text or in lines as the pendant shows them: where one version has inline forms and
    the other expert lines, only one of both is a fair measure."""
    lengths = {pair: (found["length"], found["shown"]) for pair, found in recorded()[task].items()}
    assert len(lengths) == len(LANGUAGES) * (len(LANGUAGES) - 1)
    assert {pair: both for pair, both in lengths.items() if not any(0.7 <= one <= 1.3 for one in both)} == {}
