"""The surroundings of a line that is typed on the screen: where the arm stands, and with which tool."""

from __future__ import annotations

from rpl.emulator.rotations import FloatArray, matrix_to_zyx


def cell_text(joints: FloatArray, tool: FloatArray) -> str:
    """A cell file for joints (n,) and a tool (4, 4) on the flange."""
    numbers = [*tool[:3, 3], *matrix_to_zyx(tool[:3, :3])]
    said = ", ".join(f"{name} = {float(value)!r}" for name, value in zip("xyzabc", numbers, strict=True))
    return f"joints = {[float(value) for value in joints]}\n[system]\ntool = {{ {said} }}\n"
