"""Structs with the same members are one type in all files of a project, and are written as one."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

RECIPES = """# recipes of the cell
def select_recipe(number):
  if number == 1:
    return struct(name="PCB-17", rows=2, cols=3, pitch=0.06, retests=2, low=4.75, high=5.25)
  end
  return struct(name="none", rows=0, cols=0, pitch=0.0, retests=0, low=0.0, high=0.0)
end
"""
CELL = """def cell():
  def slots(r):
    return r.rows * r.cols
  end
  def limits_hold(value, first, second, third, fourth, fifth, r):
    value = value + first + second + third + fourth + fifth
    return value >= r.low and value <= r.high and r.retests > 1 and r.pitch < 0.1
  end
  recipe = select_recipe(1)
  count = slots(recipe)
  set_standard_digital_out(0, count == 6)
  holds = limits_hold(4.5, 0.1, 0.1, 0.1, 0.1, 0.1, recipe)
  set_standard_digital_out(1, holds)
  set_standard_digital_out(2, recipe.high > 5.2 and recipe.pitch > 0.05)
end
"""
TARGETS = ["krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl"]


def project() -> ReadProgram:
    sources = [source_from_text("recipes.script", RECIPES), source_from_text("cell.script", CELL)]
    return read_sources(sources, "urscript", Diagnostics())


def test_one_type_beside_the_first_variable_of_it() -> None:
    modules = project().program.modules
    found = [(m.name, d.name) for m in modules for d in m.declarations if isinstance(d, ir.RecordDeclaration)]
    assert found == [("cell", "recipe_struct")]
    returned = next(r.returns for m in modules for r in m.routines if r.name == "select_recipe")
    assert returned == ir.NamedType("recipe_struct")


@pytest.mark.parametrize("target", TARGETS)
def test_the_members_keep_their_types(target: str) -> None:
    diagnostics = Diagnostics()
    read = project()
    translation = translate_program(read, target, "ur5e", None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, again)
    assert not again.has_errors
    result = run_program(back.program, "ur5e", None, translation.renamed.get("cell", "cell"), 30.0)
    assert result.status == "finished", result.fault
    assert [value for _, _, value in result.outputs] == [True, True, True]
