"""Path moves to poses: their posture is not checked where the source's controller does not check it."""

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SCRIPT = """def main():
  movej([-0.35, -1.5708, 1.5708, -1.5708, -1.5708, 0.0])
  row = 0
  while row < 2:
    movel(pose_trans(p[-0.45, -0.25, 0.25, 0, 0, 0.5236], p[0, 0.08 * row, 0, 0, 3.14159265, 0]), v=0.4)
    row = row + 1
  end
  set_standard_digital_out(0, True)
end
"""


def test_path_moves_to_computed_poses_arrive_with_any_posture() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", SCRIPT)], "urscript", diagnostics)
    translation = translate_program(read, "rapid", "ur5e", None, diagnostics)
    sources = [source_from_bytes(file.path, file.data) for file in translation.files]
    text = "".join(source.text for source in sources)
    assert "ConfL\\Off" in text and "ConfJ\\Off" not in text
    result = run_program(read_sources(sources, "rapid", diagnostics).program, "ur5e")
    assert (result.status, [value for _, _, value in result.outputs]) == ("finished", [True])
