"""The indices of an array of arrays stand in one pair of braces, as its declaration has them."""

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """def grid():
  matrix = [[1, 2, 3], [4, 5, 6]]
  i = 1
  matrix[i, 2] = matrix[0, 1] + 7
  set_standard_digital_out(0, matrix[i, 2] == 9)
end
"""


def test_an_element_of_an_array_of_arrays() -> None:
    read = read_sources([source_from_text("grid.script", PROGRAM)], "urscript", Diagnostics())
    written = translate_program(read, "rapid", "ur5e", None, Diagnostics())
    text = "".join(file.data.decode() for file in written.files)
    assert "matrix{2,3}" in text and "matrix{1,2}" in text
    assert "}{" not in text
