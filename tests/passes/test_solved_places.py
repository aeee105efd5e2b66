"""Inverse and forward kinematics that a translated program brings along."""

import numpy as np
import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import matrix_to_zyx
from rpl.passes.legalise.postures.solvertexts import solver_texts
from rpl.project import read_sources
from rpl.simulation import Simulation, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARMS = ["ur5e", "ur10e", "kuka_kr6r900sixx", "fanuc_lrmate200id", "motoman_gp7", "abb_irb1200_5_90", "adept_viper_s650"]


def solved(robot: str, calls: list[str]) -> Simulation:
    """The routines of an arm, run with these lines."""
    form = load_robot(robot).closed_form()
    assert form is not None
    body = "\n".join(f"    {line}" for line in calls)
    data = "\n".join(f"GLOBAL VAR q{n}: JOINTS\nGLOBAL VAR f{n}: POSE" for n in range(12))
    routines = "".join(solver_texts(form).values())
    text = f"ENTRY main\nMODULE m\n{data}\nPROCEDURE main()\n{body}\nEND PROCEDURE\n{routines}END MODULE\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.rpl", text)], "rpl", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    simulation = Simulation(read.program, robot)
    simulation.run()
    return simulation


@pytest.mark.parametrize("robot", ARMS)
def test_the_routines_find_what_the_model_finds(robot: str) -> None:
    model, random = load_robot(robot), np.random.default_rng(7)
    middle, half = model.limits.mean(axis=1), np.minimum(np.ptp(model.limits, axis=1) / 2, 170)
    joints = middle + half * random.uniform(-0.9, 0.9, (6, 6))
    near = middle + half * random.uniform(-0.9, 0.9, (6, 6))
    calls = []
    for n, (one, other) in enumerate(zip(joints, near, strict=True)):
        flange = model.forward(one)
        numbers = [*flange[:3, 3], *matrix_to_zyx(flange[:3, :3])]
        pose = ", ".join(f"{name}: ({value:.12f})" for name, value in zip("xyzabc", numbers, strict=True))
        start = ", ".join(f"j{at}: ({value:.9f})" for at, value in enumerate(other, 1))
        calls.append(f"q{n} = rpl_near_joints(pose {{{pose}}}, joints {{{start}}})")
        calls.append(f"f{n} = rpl_flange(q{n})")
    simulation = solved(robot, calls)
    for n, (one, other) in enumerate(zip(joints, near, strict=True)):
        flange = model.forward(one)
        wanted = model.nearest(flange, other)
        found = simulation.variable(f"q{n}")
        assert np.allclose(found.axes.values, wanted, atol=1e-5), (robot, n)  # type: ignore[union-attr]
        place = simulation.variable(f"f{n}")
        assert np.allclose([place.trans.x, place.trans.y, place.trans.z], flange[:3, 3], atol=1e-4)  # type: ignore[union-attr]


ASKED = """def main():
  set_tcp(p[0, 0.02, 0.15, 0, 0, 0])
  home = [0.0, -1.5708, 1.5708, -1.5708, -1.5708, 0.0]
  movej(home)
  n = 0
  fine = 0
  while n < 2:
    place = pose_trans(p[-0.4, -0.2, 0.2, 0, 3.14159, 0], p[n * 0.1, 0, 0, 0, 0, 0.1])
    if get_inverse_kin_has_solution(place, home):
      q = get_inverse_kin(place, home)
      movej(q)
      r = get_inverse_kin(place)
      back = get_forward_kin(r)
      flange = get_forward_kin(r, p[0, 0, 0, 0, 0, 0])
      if point_dist(get_actual_tcp_pose(), place) < 0.0005 and norm(r[0] - q[0]) < 0.001:
        if norm(back[2] - place[2]) < 0.0005 and norm(flange[2] - back[2] - 0.15) < 0.0005:
          fine = fine + 1
        end
      end
    end
    n = n + 1
  end
  if get_inverse_kin_has_solution(pose_trans(place, p[0, 0, -2, 0, 0, 0])):
    fine = 0
  end
  if fine == 2:
    set_standard_digital_out(0, True)
  end
end
"""


@pytest.mark.parametrize("target", ["rapid", "vplus", "tp", "inform", "krl"])
def test_computed_places_are_solved_in_every_language(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", ASKED)], "urscript", diagnostics)
    assert [value for _, _, value in run_program(read.program, "ur5e").outputs] == [True]
    translation = translate_program(read, target, "ur5e", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(file.path, file.data) for file in translation.files], target, diagnostics)
    result = run_program(back.program, "ur5e", None, translation.renamed.get("main", "main"))
    assert [value for _, _, value in result.outputs] == [True]


SEEN = """ENTRY main
MODULE m
VAR nozzle: TOOL = {{held: TRUE, frame: {{x: 0, y: 0, z: 90, a: 0, b: 0, c: 0}}}}
PROCEDURE main()
    VAR at: TARGET
    VAR p, q: POSE
    VAR j, k: JOINTS
    $tool = {{x: 0, y: 0, z: 90, a: 0, b: 0, c: 0}}
    MOVE TO joints {{j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0}}
    at = {written}
    j = current_joints()
    k = target_to_joints_near({place}, j)
    MOVE TO k
    p = pose_of(current_target())
    k.j1 = k.j1 + 5
    q = pose_of(joints_to_target(k, nozzle))
    MOVE TO k
    SET do[1] TO abs(p.z - at.z - 20) < 0.1 AND abs(k.j1 - j.j1) < 6 AND distance(q.trans, current_position()) < 0.1
END PROCEDURE
END MODULE
"""


@pytest.mark.parametrize("place", ["offset(current_target(), 0, 0, 20)", "offset(at, 0, 0, 20)"])
@pytest.mark.parametrize("target", ["vplus", "tp", "inform"])
def test_places_that_were_read_are_solved_near_the_joints(target: str, place: str) -> None:
    diagnostics = Diagnostics()
    text = SEEN.format(place=place, written="current_target()")
    read = read_sources([source_from_text("m.rpl", text)], "rpl", diagnostics)
    assert [value for _, _, value in run_program(read.program, "kuka_kr6r900sixx").outputs] == [True]
    translation = translate_program(read, target, "kuka_kr6r900sixx", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert "posture-by-joints" in {item.code.name for item in diagnostics.of(Severity.WARNING)}
    back = read_sources([source_from_bytes(file.path, file.data) for file in translation.files], target, diagnostics)
    result = run_program(back.program, "kuka_kr6r900sixx", None, translation.renamed.get("main", "main"))
    assert [value for _, _, value in result.outputs] == [True]
