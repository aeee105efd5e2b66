"""Integer registers whose number a program works out: all of that program's are numbered, and each is one signal."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import Simulation
from rpl.source import source_from_text

COUNTED = """def counted():
  offset = 20
  def put(index, value):
    write_output_integer_register(index + offset, value)
  end
  put(4, read_input_integer_register(offset + 1) + 1)
  write_output_integer_register(25, read_output_integer_register(24) * 2)
end
"""


def test_a_register_by_number_and_by_a_worked_out_number_are_one() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("counted.script", COUNTED)], "urscript", diagnostics)
    assert not list(diagnostics)
    simulation = Simulation(read.program, max_time_s=10.0)
    simulation.set_input("gi22", 6)
    simulation.run()
    assert simulation.result().status == "finished"
    assert (simulation.signals["group_out", 25], simulation.signals["group_out", 26]) == (7, 14)


def test_registers_by_plain_numbers_keep_their_names() -> None:
    text = "def plain():\n  write_output_integer_register(24, read_input_integer_register(25))\nend\n"
    read = read_sources([source_from_text("plain.script", text)], "urscript", Diagnostics())
    simulation = Simulation(read.program, max_time_s=10.0)
    simulation.set_input("input_integer_register_25", 9)
    simulation.run()
    assert simulation.signals["output_integer_register_24"] == 9
