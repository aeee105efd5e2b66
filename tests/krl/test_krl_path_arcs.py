"""Arcs that keep the tool as it is to the arc: the rule is a word of the controller, whatever names there are."""

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

SCRIPT = """def main():
  global path = 3
  movej([0.0, -1.5708, 1.5708, -1.5708, -1.5708, 0.0])
  here = get_actual_tcp_pose()
  movec(pose_trans(here, p[0.05, 0, -0.05, 0, 0, 0]), pose_trans(here, p[0.1, 0, 0, 0, 0, 0]), mode=1)
  path = path + 1
end
"""


def test_the_rule_keeps_its_word() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", SCRIPT)], "urscript", diagnostics)
    translation = translate_program(read, "krl", "ur5e", None, diagnostics)
    text = "".join(file.data.decode("ascii", "replace") for file in translation.files).upper()
    assert "$CIRC_TYPE=#PATH\r\n" in text.replace("\n", "\r\n").replace("\r\r", "\r")
    assert "#PATH_2" not in text
