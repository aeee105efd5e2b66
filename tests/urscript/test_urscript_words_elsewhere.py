"""Single words and their combinations, after translation: the expectation of each program holds there too."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

START = "movej([0.0, -1.5708, 1.5708, -1.5708, -1.5708, 0.0], a=3, v=2)\nstart = p[-0.4, -0.15, 0.35, 0, 3.1416, 0]\n"
CASES = {
    "a corner that may be none": (
        START + "def go(pt, r=0):\nmovel(pt, v=0.2, r=r)\nend\n"
        "movej(start)\ngo(pose_add(start, p[0, 0.05, 0, 0, 0, 0]), 0.01)\n"
        "go(pose_add(start, p[0.05, 0.05, 0, 0, 0, 0]))",
        "point_dist(get_actual_tcp_pose(), pose_add(start, p[0.05, 0.05, 0, 0, 0, 0])) < 0.001",
    ),
    "joints of a list of lists": (
        START + "ways = [[0.0, -1.57, 1.57, -1.57, -1.57, 0.0], [0.2, -1.5708, 1.5708, -1.5708, -1.5708, 0.0]]\n"
        "i = 0\nwhile i < 2:\nmovej(ways[i], a=3, v=2)\ni = i + 1\nend",
        "norm(get_actual_joint_positions()[0] - 0.2) < 0.001",
    ),
    "bits": ("b = integer_to_binary_list(12)\nb[0] = True", "binary_list_to_integer(b) == 13"),
    "parts of texts": ('s = "abcde"\nn = 3', 'str_sub(s, 2, 50) == "cde" and str_sub(s, n, n) == "de"'),
    "a value that a thread gives": ("n = 0\nthread t():\nn = n + 1\nreturn False\nend\nh = run t()\njoin h", "n == 1"),
}


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "vplus", "inform", "urscript"])
@pytest.mark.parametrize("name", CASES)
def test_words(name: str, target: str) -> None:
    lines, expectation = CASES[name]
    text = f"def prog():\n{lines}\nif {expectation}:\nset_standard_digital_out(0, True)\nend\nend\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.script", text)], "urscript", diagnostics)
    translation = translate_program(read, target, "ur5e", None, diagnostics)
    losses = [item.code.name for item in diagnostics.of(Severity.LOSS)]
    assert losses in ([], ["tp-text-case"])
    files = [source_from_bytes(one.path, one.data) for one in translation.files]
    result = run_program(read_sources(files, target, Diagnostics()).program, "ur5e")
    assert result.fault is None and [state for _, _, state in result.outputs] == [True]
