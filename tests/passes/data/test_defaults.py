"""Starting values, and what a linked prelude leaves behind."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rpl import ir
from rpl.passes.capabilities import PlaceRule
from rpl.passes.legalise.data.defaults import starting_values
from rpl.passes.legalise.errors.prelude import link_prelude
from rpl.passes.legalise.storage.unused import drop_unused

from .helpers import context, lines, read, show, variable

PROGRAM = """MODULE t
  RECORD size
    num long;
    string name;
  ENDRECORD
  VAR num count;
  VAR size box;
  VAR pos row{2};
  VAR bool big{40};
  VAR robtarget goal;
  PROC t()
    VAR num first;
    VAR num later;
    VAR num many{40};
    VAR num looped;
    first:=1;
    IF first=1 THEN
      later:=2;
    ENDIF
    looped:=later+many{1};
  ENDPROC
ENDMODULE
"""


def test_data_that_starts_at_zero_is_written_out() -> None:
    program = read(PROGRAM, "rapid")
    done = starting_values(program, context(program, "rapid"))
    texts = {name: show(variable(done, name).initial or ir.Name("-")) for name in ("count", "box", "row", "goal")}
    assert texts == {
        "count": "0.0",
        "box": "{long 0.0, name ''}",
        "row": "{{x 0.0, y 0.0, z 0.0}, {x 0.0, y 0.0, z 0.0}}",
        "goal": "{x 0.0, y 0.0, z 0.0, a 0.0, b 0.0, c 0.0}",
    }


def test_a_stop_reads_nothing() -> None:
    """A refused statement is a remark with a stop: no variable gets a value for it."""
    program = read(PROGRAM, "rapid")
    (module,) = program.modules
    (routine,) = module.routines
    refused = replace(routine, body=(ir.Opaque("ask first"), *routine.body))
    program = replace(program, modules=(replace(module, routines=(refused,)),))
    assert variable(starting_values(program, context(program, "rapid")), "first").initial is None


def test_only_what_may_be_read_first_gets_a_value_in_a_routine() -> None:
    program = read(PROGRAM, "rapid")
    done = starting_values(program, context(program, "rapid"))
    given = {name: variable(done, name).initial is not None for name in ("first", "later", "looped")}
    assert given == {"first": False, "later": True, "looped": False}
    assert lines(done)[:2] == ["for element = 1 to 40", "  many[element] := 0.0"]
    assert starting_values(done, context(done, "rapid")) == done or lines(done)[0].startswith("for")


def test_languages_that_agree_need_nothing() -> None:
    program = read("DEF t()\nDECL INT n\nn=n+1\nEND\n", "krl")
    assert starting_values(program, context(program, "krl")) is program


def test_the_unused_part_of_a_prelude_goes() -> None:
    program = read("MODULE t\nVAR speeddata v:=v100;\nPROC t()\nv:=v200;\nENDPROC\nENDMODULE\n", "rapid")
    surroundings = context(program, "rapid")
    linked = link_prelude(program, surroundings)
    body = (ir.Return(),)
    quiet = replace(linked.modules[0], routines=tuple(replace(r, body=body) for r in linked.modules[0].routines))
    done = drop_unused(replace(linked, modules=(quiet, *linked.modules[1:])), surroundings)
    names = [d.name for m in done.modules[1:] for d in m.declarations if isinstance(d, ir.Variable)]
    assert names == ["v100"]


_PARTS = """DEF t()
DECL FRAME own
DECL FRAME whole
DECL POS handed
DECL E6AXIS bent
DECL FRAME asked
own.x = 1
whole = own
whole.y = 2
fill(handed)
bent.a1 = 3
IF VARSTATE("asked") == #INITIALIZED THEN
asked.z = 4
ENDIF
END
DEF fill(place:OUT)
POS place
place.x = 5
END
"""


def _begun(text: str) -> ir.Program:
    """The program for a target that makes new places of old ones."""
    program = read(text, "krl")
    usual = context(program, "krl")
    assert starting_values(program, usual) is program
    whole = replace(
        usual,
        capabilities=replace(
            usual.capabilities,
            places=replace(usual.capabilities.places, rules=usual.capabilities.places.rules | {PlaceRule.WHOLE}),
        ),
    )
    return starting_values(program, whole)


def test_places_that_are_filled_in_parts_begin_somewhere() -> None:
    done = _begun(_PARTS)
    given = {name: variable(done, name).initial is not None for name in ("own", "whole", "handed", "bent", "asked")}
    assert given == {"own": True, "whole": False, "handed": True, "bent": True, "asked": False}


@pytest.mark.parametrize(
    ("numbers", "begun"), [(("2",), ["row[2]"]), (("2", "n"), [f"row[{number}]" for number in range(1, 5)])]
)
def test_elements_that_are_filled_in_parts_begin_somewhere(numbers: tuple[str, ...], begun: list[str]) -> None:
    body = "".join(f"row[{number}].z = 5\n" for number in numbers)
    done = _begun(f"DEF t()\nINT n\nn = 3\n{body}END\n====\nDEFDAT t\nDECL FRAME row[4]\nENDDAT\n")
    declared = [one for module in done.modules for one in module.declarations]
    places = [show(one.assign.target) for one in declared if isinstance(one, ir.Initialise)]
    row = variable(done, "row").initial
    if isinstance(row, ir.Aggregate):
        places = [f"row[{at}]" for at in range(1, len(row.entries) + 1)]
    assert places == begun
