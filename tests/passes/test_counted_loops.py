"""Loops that count by hand (URScript has no counting loop): a FOR where nothing else looks at the number."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

PROGRAM = """def job():
  def show(row, column):
    textmsg(to_str(row * 10 + column))
  end
  row = 0
  while row < 2:
    column = 1
    while column <= 3:
      show(row, column)
      {inside}
      column = column + 1
    end
    row = row + 1
  end
  {behind}
end
"""
FORS = {"rapid": "FOR column FROM 1 TO 3 DO", "krl": "FOR column=1 TO 3", "vplus": "FOR column = 1 TO 3"}
STAYS = {
    "read behind": ("sync()", "textmsg(to_str(column))"),
    "set inside": ("if get_standard_digital_in(1):\n        column = 3\n      end", "sync()"),
    "gone on with": ("if column == 2:\n        column = column + 1\n        continue\n      end", "sync()"),
}


@pytest.mark.parametrize("target", FORS)
def test_a_number_of_its_own_is_a_counting_loop(target: str) -> None:
    journey = there_and_back({"job.script": PROGRAM.format(inside="sync()", behind="sync()")}, "urscript", target)
    assert FORS[target] in journey.text, journey.text
    assert journey.prove("job").equal


@pytest.mark.parametrize("target", ["tp", "inform", "val3"])
def test_targets_with_numbers_for_data_count_as_well(target: str) -> None:
    program = PROGRAM.format(inside="sync()", behind="sync()")
    program = program.replace("textmsg(to_str(row * 10 + column))", "set_standard_digital_out(row + column, True)")
    journey = there_and_back({"job.script": program}, "urscript", target)
    assert journey.prove("job").equal


def test_a_loop_may_be_left() -> None:
    inside = "if column == 2:\n        break\n      end"
    journey = there_and_back({"job.script": PROGRAM.format(inside=inside, behind="sync()")}, "urscript", "rapid")
    assert journey.prove("job").equal


@pytest.mark.parametrize("case", STAYS)
def test_a_number_that_is_looked_at_elsewhere_stays_one(case: str) -> None:
    inside, behind = STAYS[case]
    journey = there_and_back({"job.script": PROGRAM.format(inside=inside, behind=behind)}, "urscript", "rapid")
    assert "FOR column" not in journey.text
    assert ("FOR row FROM 0 TO 1 DO" in journey.text) == (case != "gone on with")  # that might mean the outer loop
    assert journey.prove("job").equal


HEAD = """def job():
  def show(which):
    textmsg(to_str(which))
    {elsewhere}
  end
  global row = 0
  row = 1
  while row <= 3:
    show(row)
    row = row + 1
  end
end
"""


@pytest.mark.parametrize(
    ("elsewhere", "counts"),
    [("sync()", True), ("global other = row", False), ("if row == 2:\n      row = 3\n    end", False)],
    ids=["nowhere else", "read elsewhere", "set by what the loop calls"],
)
def test_a_number_that_is_set_at_the_head_as_well(elsewhere: str, counts: bool) -> None:
    journey = there_and_back({"job.script": HEAD.format(elsewhere=elsewhere)}, "urscript", "rapid")
    assert ("FOR row FROM 1 TO 3 DO" in journey.text) is counts, journey.text
    assert "row:=0" not in journey.text or not counts
    assert journey.prove("job").equal
