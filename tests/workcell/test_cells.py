"""Programs that run in cells with bodies: the samples, and rules that hold for every cell."""

import copy
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rpl.cell import parse_cell, read_cell
from rpl.cell.layout import Body, Fixture
from rpl.cell.shapes import Box
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import pose_matrix
from rpl.errors import UsageError
from rpl.project import read_program
from rpl.proof.prove import prove_programs
from rpl.proof.wiring import in_words_of
from rpl.runtime.limits import DEFAULTS
from rpl.simulation import Simulation, run_program
from rpl.source import source_from_bytes
from rpl.translation import translate_program
from rpl.workcell.collisions import find_collisions
from rpl.workcell.knocks import run_and_look
from rpl.workcell.loading import robots_of
from rpl.workcell.outcome import outcome_of
from rpl.workcell.repeating import of_mean, of_share, repeat, statistics, student_t
from rpl.workcell.running import Driven, run_cell
from rpl.workcell.stopping import stopped_at

SAMPLES = Path(__file__).parents[2] / "samples" / "cells"


def cell_of(name):
    return read_cell(SAMPLES / name)


def run(cell, limits=DEFAULTS):
    diagnostics = Diagnostics()
    loaded = robots_of(cell, diagnostics)
    assert not diagnostics.has_errors
    return run_cell(cell, [one.driven for one in loaded], limits)


def ends(made):
    return {one.part: (one.state, one.on) for one in outcome_of(made).parts}


@pytest.mark.parametrize(
    ("language", "place"),
    [("krl", (500.0, 200.0, 25.0)), ("rapid", (450.0, 150.0, 25.0)), ("urscript", (-450.0, 100.0, 25.0))],
)
def test_a_box_is_taken_across_in_three_languages_behind_a_misgrip(language, place):
    made = run(cell_of(f"box_pick/{language}.toml"))
    assert made.status == "finished"
    assert [(one.part, one.ok) for one in made.grasps] == [("box", False), ("box", True)]
    (box,) = outcome_of(made).parts
    assert box.state == "rests"
    assert box.pose[:3, 3] == pytest.approx(place, abs=0.01)
    # The jaws have turned it square to them on the way.
    assert np.allclose(np.abs(box.pose[:3, :3]).max(axis=0), 1.0, atol=1e-4)


@pytest.mark.parametrize("language", ["krl", "rapid", "urscript"])
def test_three_misgrips_run_the_error_branch(language):
    cell = cell_of(f"box_pick/{language}.toml")
    gripper = replace(cell.layout.grippers[0], misses=(1, 2, 3))
    made = run(replace(cell, layout=replace(cell.layout, grippers=(gripper,))))
    assert made.status in ("stopped", "finished")
    switched = [name for _, name, value in made.robots[0].result.outputs if value]
    assert len(switched) == 4  # three closings and the alarm
    assert switched[-1] in ("$OUT[2]", "doAlarm", "digital_out[1]")
    assert ends(made) == {"box": ("rests", "table")}


def test_a_program_written_for_no_cell_builds_a_stack():
    made = run(cell_of("palletiser/cell.toml"))
    assert made.status == "finished"
    assert [one.ok for one in made.grasps] == [True] * 9
    found = ends(made)
    assert [found[f"carton#{n}"] for n in (5, 6, 7, 8)] == [("gone", "")] * 4
    assert found["carton#9"] == ("rests", "pallet")
    before = [one for one in made.placed if one.state == "rests" and one.part == "carton#8"]
    assert (before[-1].on, before[-1].pose[2, 3]) == ("carton#4", pytest.approx(80.0, abs=0.01))
    assert made.notes == ()


def test_without_removal_the_ninth_carton_is_let_go_in_the_first():
    cell = cell_of("palletiser/cell.toml")
    made = run(replace(cell, layout=replace(cell.layout, removals=())))
    assert made.notes == ("32.520 s: carton#9 is let go inside carton",)


def test_two_robots_hand_over_three_boxes():
    made = run(cell_of("handover/cell.toml"))
    assert made.status == "finished"
    places = {one.part: one.pose[:3, 3] for one in outcome_of(made).parts}
    for number, name in enumerate(("box", "box#2", "box#3")):
        assert places[name] == pytest.approx((800.0, -250.0 - 100.0 * number, 25.0), abs=0.01)


def test_the_interlock_keeps_them_apart():
    good, bridged = (find_collisions(run(cell_of(f"handover/{name}.toml"))) for name in ("cell", "bridged"))
    assert good.collisions == ()
    first = bridged.collisions[0]
    assert {first.a, first.b} == {"left_jaws", "right_jaws"}
    assert (Path(first.origin.file).name, first.origin.line) == ("right.mod", 21)


def test_a_collision_can_end_the_run():
    cell = cell_of("handover/bridged.toml")
    first = find_collisions(run(cell)).collisions[0]
    made = stopped_at(run(cell, replace(DEFAULTS, time_s=first.t)), first)
    assert made.status == "fault"
    assert {one.result.fault.code for one in made.robots} == {"collision"}
    assert all(one.result.time_s == pytest.approx(first.t) for one in made.robots)


def test_what_was_taken_away_is_in_nobodys_way():
    found = find_collisions(run(cell_of("palletiser/cell.toml")))
    assert found.collisions == ()


def test_a_deadlock_names_who_waits_for_whom():
    cell = cell_of("handover/cell.toml")
    wires = tuple(one for one in cell.layout.wires if one.robot != "right")
    made = run(replace(cell, layout=replace(cell.layout, wires=wires)))
    assert made.status == "deadlock"
    assert "left: main waits for" in made.fault
    assert "$IN[2]" in made.fault
    assert "right: main waits for" in made.fault
    assert "(driven by left.$OUT[2])" in made.fault


def test_who_waits_for_a_robot_that_a_limit_ended_is_in_no_deadlock():
    made = run(cell_of("handover/cell.toml"), replace(DEFAULTS, time_s=5.0))
    assert made.status == "limit"
    assert [one.result.status for one in made.robots] == ["limit", "limit"]


def test_the_same_seed_gives_the_same_bytes_and_another_one_another_pile():
    cell = cell_of("bin_drop/cell.toml")
    few = replace(cell, layout=replace(cell.layout, parts=cell.layout.parts[:12]))

    def bytes_of(seed):
        return json.dumps(outcome_of(run(replace(few, seed=seed))).as_json())

    assert bytes_of(1) == bytes_of(1)
    assert bytes_of(1) != bytes_of(2)


def test_a_snapshot_of_a_run_goes_on_by_itself():
    cell = cell_of("box_pick/krl.toml")
    (loaded,) = robots_of(cell, Diagnostics())
    first = Simulation(loaded.driven.program, loaded.driven.model, cell)
    first.run_until(4.0)
    second = copy.deepcopy(first)
    first.run()
    second.run()
    assert first.result().outputs == second.result().outputs
    worlds = (first.bodies.world, second.bodies.world)
    assert worlds[0] is not worlds[1]
    assert [len(one.grasps) for one in worlds] == [2, 2]


def test_a_run_without_bodies_has_no_world():
    """What exists keeps working: a cell file of signals alone."""
    read = read_program(
        [source_from_bytes("m.mod", b"MODULE m\nPROC main()\nSet do1;\nWaitDI di1,1;\nENDPROC\nENDMODULE\n")]
    )
    result = run_program(read.program, None, parse_cell('[[reaction]]\nwhen = "do1"\nsignal = "di1"\nvalue = true\n'))
    assert [event.kind for event in result.trace] == ["output", "wait", "input", "end"]


def test_signals_of_several_robots_need_a_name_before_them():
    cell = replace(
        cell_of("handover/bridged.toml"),
        inputs=parse_cell('[[input]]\ntime = 0\nsignal = "di1"\nvalue = true\n').inputs,
    )
    with pytest.raises(UsageError, match=r"the signal di1: say whose it is: left\.di1"):
        run(cell)


def test_bodies_need_an_arm():
    (loaded,) = robots_of(cell_of("box_pick/krl.toml"), Diagnostics())
    with pytest.raises(UsageError, match="bodies need a robot whose moves take time"):
        Simulation(loaded.driven.program, None, cell_of("box_pick/krl.toml"))


def test_a_held_part_passes_a_sensor():
    """The light of a sensor between the two places is broken while the box goes by, and free again behind it."""
    cell = cell_of("box_pick/krl.toml")
    text = '[[sensor]]\nname = "light"\nsignal = "$IN[9]"\nbox = [300, 20, 300]\nat = [500, 0, 180]\n'
    light = parse_cell(text).layout.sensors
    made = run(replace(cell, layout=replace(cell.layout, sensors=light)))
    seen = [
        (event.t, event.data["value"])
        for event in made.robots[0].result.trace
        if event.kind == "input" and event.data["signal"] == "$IN[9]"
    ]
    assert [value for _, value in seen] == [True, False]
    taken, let_go = made.grasps[1].t, made.openings[-1].t
    assert taken < seen[0][0] < seen[1][0] < let_go


@pytest.mark.parametrize("target", ["rapid", "vplus", "urscript", "tp"])
def test_a_translation_meets_the_same_bodies(target):
    """Its gripper is wired to the same output, whatever the target calls it."""
    cell, arm = cell_of("box_pick/krl.toml"), "kuka_kr6r900sixx"
    read = read_program([SAMPLES / "box_pick" / name for name in ("box_pick.src", "box_pick.dat")])
    made = translate_program(read, target, arm, None, Diagnostics())
    theirs = read_program([source_from_bytes(one.path, one.data) for one in made.files], target)
    verdict = prove_programs(read.program, theirs.program, arm, None, cell)
    assert verdict.verdict != "different", verdict.first_difference
    run_of_theirs = run_program(theirs.program, arm, in_words_of(cell, read.program, theirs.program))
    values = [value for _, _, value in run_of_theirs.outputs]
    assert values == [True, False, True, False]


def test_who_has_ended_still_lets_parts_fall_and_feeders_come():
    """The left robot lets a box fall and ends at once; the right one waits for it below, and for the feeder's next."""
    text = """
[[robot]]
name = "left"
[[robot]]
name = "right"
[[gripper]]
name = "hand"
robot = "left"
kind = "jaws"
grip = [0, 0, 150]
close = "do1"
opening = [0, 80]
[[fixture]]
name = "table"
box = [600, 800, 30]
at = [500, 0, -15]
[[part]]
name = "box"
box = [50, 50, 50]
at = [500, -200, 25]
copies = 2
again = 30
[[sensor]]
name = "below"
robot = "right"
signal = "di1"
box = [60, 60, 20]
at = [500, 200, 25]
[[sensor]]
name = "at the feeder"
robot = "right"
signal = "di2"
box = [20, 20, 20]
at = [500, -200, 25]
"""
    left = """DEF left( )
$TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}
$BASE=$NULLFRAME
$VEL.CP=0.5
PTP {X 500,Y -200,Z 100,A 0,B 0,C 180,S 2,T 2}
LIN {X 500,Y -200,Z 30,A 0,B 0,C 180}
$OUT[1]=TRUE
WAIT SEC 0.1
LIN {X 500,Y -200,Z 300,A 0,B 0,C 180}
LIN {X 500,Y 200,Z 300,A 0,B 0,C 180}
$OUT[1]=FALSE
END
"""
    right = "DEF right( )\nWAIT FOR $IN[1]\nWAIT FOR $IN[2]\n$OUT[2]=TRUE\nEND\n"
    cell, arm = parse_cell(text), load_robot("kuka_kr6r900sixx")
    driven = [
        Driven(place, read_program([source_from_bytes(f"{place.name}.src", code.encode())], "krl").program, arm)
        for place, code in zip(cell.layout.robots, (left, right), strict=True)
    ]
    made = run_cell(cell, driven)
    assert made.status == "finished", made.fault
    ends_s = [one.result.time_s for one in made.robots]
    assert ends_s[1] - ends_s[0] > 25.0  # the feeder's half minute began at the grasp
    assert [value for _, _, value in made.robots[1].result.outputs] == [True]


def test_variables_of_several_robots_need_a_name_before_them():
    cell = replace(cell_of("handover/cell.toml"), variables={"count": 3})
    with pytest.raises(UsageError, match=r"the variable count: say whose it is: left\.count"):
        run(cell)


def test_many_runs_count_collisions_and_no_loss_as_a_closing():
    cell = cell_of("box_pick/krl.toml")
    gripper = replace(cell.layout.grippers[0], misses=(), force_n=4.0)
    heavy = replace(cell, layout=replace(cell.layout, grippers=(gripper,)))
    driven = [one.driven for one in robots_of(heavy, Diagnostics())]
    (one,) = repeat(heavy, driven, DEFAULTS, 1, 1, look=True)
    assert (one.grasps, one.missed, one.collisions) == (1, 0, 0)
    bridged = cell_of("handover/bridged.toml")
    (hit,) = repeat(bridged, [each.driven for each in robots_of(bridged, Diagnostics())], DEFAULTS, 1, 1, look=True)
    assert hit.collisions is not None
    assert hit.collisions > 10


def test_what_is_too_heavy_for_its_acceleration_is_lost():
    """0.4 kg at rest need 3.9 N. The arm accelerates with several m/s2 on its way: 4.0 N are too few, 20 N enough."""
    cell = cell_of("box_pick/krl.toml")
    ok = {}
    for force in (4.0, 20.0):
        gripper = replace(cell.layout.grippers[0], misses=(), force_n=force)
        made = run(replace(cell, layout=replace(cell.layout, grippers=(gripper,))))
        ok[force] = [one.ok for one in made.grasps]
        if force == 4.0:
            assert made.grasps[-1].why.startswith("lost on the way: ")
            assert ends(made) == {"box": ("rests", "table")}
    assert ok == {4.0: [True, False], 20.0: [True]}


def test_a_collision_knocks_a_part_out_of_its_gripper():
    """A post stands in the way of the box, not of the gripper; where it stands the box falls, and the hand goes on."""
    cell = cell_of("box_pick/krl.toml")
    post = Fixture("post", (Body(Box((60.0, 20.0, 180.0)), pose_matrix((530.0, 0.0, 90.0))),))
    gripper = replace(cell.layout.grippers[0], misses=())
    layout = replace(cell.layout, grippers=(gripper,), fixtures=(*cell.layout.fixtures, post))
    driven = [one.driven for one in robots_of(cell, Diagnostics())]
    keeps, found, knocks = run_and_look(replace(cell, layout=layout), driven)
    assert knocks == ()
    assert {("box", "post"), ("post", "box")} & {(one.a, one.b) for one in found.collisions}
    assert keeps.grasps[-1].ok
    loses, _, (knock,) = run_and_look(replace(cell, layout=replace(layout, lost_beyond_mm=1.0)), driven)
    assert knock.by == "post"
    assert (loses.grasps[-1].part, loses.grasps[-1].ok, loses.grasps[-1].why) == ("box", False, "knocked out by post")
    assert abs(outcome_of(loses).parts[0].pose[1, 3]) < 100.0


def test_two_parts_between_the_jaws_are_a_double_pick():
    cell = cell_of("box_pick/krl.toml")
    one = cell.layout.parts[0]
    thin = Box((60.0, 30.0, 50.0))
    parts = tuple(
        replace(one, name=name, shape=thin, at=pose_matrix((500.0, y, 25.0)))
        for name, y in (("a", -185.0), ("b", -216.0))
    )
    gripper = replace(cell.layout.grippers[0], misses=())
    made = run(replace(cell, layout=replace(cell.layout, grippers=(gripper,), parts=parts)))
    assert [(each.part, each.ok, each.why) for each in made.grasps] == [("a", True, "double pick: with b")]
    assert ends(made) == {"a": ("rests", "table"), "b": ("rests", "table")}


def test_repeated_runs_are_the_same_over_processes():
    cell = cell_of("box_pick/krl.toml")
    gripper = replace(cell.layout.grippers[0], misses=(), chance_of_miss=0.5)
    chancy = replace(cell, layout=replace(cell.layout, grippers=(gripper,)))
    driven = [one.driven for one in robots_of(chancy, Diagnostics())]
    alone, shared = (repeat(chancy, driven, DEFAULTS, 6, jobs) for jobs in (1, 2))
    assert alone == shared
    made = statistics(alone)
    assert made.held is not None
    assert 0.0 < made.held.low < made.held.mean < made.held.high < 1.0
    assert len({one.time_s for one in alone}) > 1


@pytest.mark.parametrize(("freedom", "quantile"), [(1, 12.706), (2, 4.303), (3, 3.182), (5, 2.571), (30, 2.042)])
def test_students_quantiles_are_those_of_the_tables(freedom, quantile):
    assert student_t(freedom) == pytest.approx(quantile, rel=0.008)


def test_intervals_of_means_and_shares():
    """The mean of 1..5 is 3 with a standard error of sqrt(2.5 / 5); Wilson's interval of 8 of 10 is 0.490 to 0.943."""
    mean = of_mean([1.0, 2.0, 3.0, 4.0, 5.0])
    assert (mean.low, mean.high) == pytest.approx((3.0 - 2.776 * 0.5**0.5, 3.0 + 2.776 * 0.5**0.5), rel=2e-3)
    share = of_share(8, 10)
    assert (share.low, share.high) == pytest.approx((0.490, 0.943), abs=1e-3)


def test_the_arm_of_a_cell_file_may_be_a_file_beside_it(tmp_path):
    assert load_robot("kuka_kr6r900sixx").axes == 6
    text = '[[robot]]\nname = "a"\narm = "mine.toml"\nprograms = ["p.src"]\n'
    (tmp_path / "cell.toml").write_text(text)
    place = read_cell(tmp_path / "cell.toml").layout.robots[0]
    assert (place.arm, place.programs) == (str(tmp_path / "mine.toml"), (str(tmp_path / "p.src"),))
