"""Postures that are found for all places of a program at once are those that are found one by one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from rpl.dialects.rapid.configuration import RapidNotation

from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.passes.legalise.places.postures import together
from rpl.passes.legalise.places.postures.together import Asked, Found
from rpl.project import read_program
from rpl.source import source_from_text
from rpl.translation import translate_program

ARM = "abb_irb120_3_58"
_NONE = "[9E9,9E9,9E9,9E9,9E9,9E9]"


def taught(count: int) -> str:
    """Places in any posture, some of which cannot be as their flags say, or not be reached at all."""
    arm, notation, chance = load_robot(ARM), RapidNotation(), np.random.default_rng(5)
    data, moves = ["MODULE taught"], ["PROC main()"]
    for number in range(count):
        joints = chance.uniform(-0.8, 0.8, arm.axes) * np.array([100, 60, 60, 90, 90, 170])
        joints[4] += 10.0 if number % 7 else -joints[4]  # some with a straight wrist
        values = [f"{one:.6f}" for one in notation.values_of(arm.forward(joints)[None])[0]]
        flags = [str(one) for one in notation.encode(arm, joints).values()]
        flags[2] = "3" if number % 9 == 4 else flags[2]
        values[0] = "2500.5" if number % 11 == 6 else values[0]
        place = f"[[{','.join(values[:3])}],[{','.join(values[3:])}],[{','.join(flags)}],{_NONE}]"
        data.append(f"CONST robtarget p{number}:={place};")
        moves.append(f"Move{'JL'[number % 2]} p{number},v200,fine,tool0;")
    return "\n".join([*data, *moves, "ENDPROC", "ENDMODULE", ""])


@pytest.mark.parametrize(("target", "to_robot"), [("krl", "kuka_kr6r900sixx"), ("krl", ARM), ("tp", "fanuc_m20ia")])
def test_found_together_as_one_by_one(monkeypatch: pytest.MonkeyPatch, target: str, to_robot: str) -> None:
    def written() -> object:
        diagnostics = Diagnostics()
        read = read_program([source_from_text("taught.mod", taught(40))])
        done = translate_program(read, target, ARM, to_robot, diagnostics)
        told = [(item.code.name, item.origin.start, item.message) for item in diagnostics]
        return [(file.path, file.data) for file in done.files], told

    asked: list[int] = []
    found = together._found

    def counted(rules: Any, wanted: list[Asked], had: bool, arm: Any, other: Any) -> dict[Asked, Found]:
        answers = found(rules, wanted, had, arm, other)
        asked.append(len(answers))
        return answers

    monkeypatch.setattr(together, "_found", counted)
    at_once = written()
    assert sum(asked) > 25
    monkeypatch.setattr(together, "_FEWEST", 10**6)
    asked.clear()
    assert written() == at_once
    assert not asked
