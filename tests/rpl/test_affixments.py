"""AFFIX and UNFIX: what is kept of a rigid connection whatever moves, what is reported, and what is printed.

What each statement does stands in clauses/affixments.txt, with the languages in which it holds.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.runtime.values import PoseValue
from rpl.simulation import Simulation, run_program
from rpl.source import source_from_text
from rpl.writing.target import WriteContext

NAMES = ("f0", "f1", "f2", "f3")
FRAMES = "".join(f"FRAME {name} = {{x: {at}, y: 0, z: 0, a: 0, b: 0, c: 0}}\n" for at, name in enumerate(NAMES))


def read(*texts: str) -> tuple[ir.Program, list[str]]:
    diagnostics = Diagnostics()
    sources = [source_from_text(f"cell{at}.rpl", text) for at, text in enumerate(texts)]
    return read_sources(sources, "rpl", diagnostics).program, [item.as_text() for item in diagnostics]


class World:
    """What the statements mean, said by matrices: who is affixed to whom, and the poses."""

    def __init__(self) -> None:
        self.poses = {name: matrix((float(at), 0.0, 0.0, 0.0, 0.0, 0.0)) for at, name in enumerate(NAMES)}
        self.kinds: dict[tuple[str, str], bool] = {}

    def affix(self, child: str, parent: str, rigidly: bool) -> None:
        self.kinds[child, parent] = rigidly

    def unfix(self, child: str, parent: str) -> None:
        self.kinds.pop((child, parent), None)

    def move(self, frame: str, pose: np.ndarray) -> None:
        """Everything that goes with the frame is displaced as the frame is."""
        displacement = pose @ np.linalg.inv(self.poses[frame])
        moved = {frame}
        while True:
            more = {child for (child, parent) in self.kinds if parent in moved}
            more |= {parent for (child, parent), rigidly in self.kinds.items() if rigidly and child in moved}
            if more <= moved:
                break
            moved |= more
        for name in moved:
            self.poses[name] = displacement @ self.poses[name]


def matrix(pose: tuple[float, ...]) -> np.ndarray:
    """x, y, z in mm and a, b, c in degrees about z, then the new y, then the new x."""
    x, y, z, *angles = pose
    (ca, cb, cc), (sa, sb, sc) = np.cos(np.radians(angles)), np.sin(np.radians(angles))
    turn_z = np.array([[ca, -sa, 0], [sa, ca, 0], [0, 0, 1]])
    turn_y = np.array([[cb, 0, sb], [0, 1, 0], [-sb, 0, cb]])
    turn_x = np.array([[1, 0, 0], [0, cc, -sc], [0, sc, cc]])
    done = np.eye(4)
    done[:3, :3], done[:3, 3] = turn_z @ turn_y @ turn_x, (x, y, z)
    return done


PAIRS = st.sampled_from([(one, other) for one in NAMES for other in NAMES if one != other])
POSES = st.tuples(*[st.integers(-500, 500)] * 3, *[st.integers(-80, 80)] * 3)
ACTS = st.lists(
    st.one_of(
        st.tuples(st.just("affix"), PAIRS, st.booleans()),
        st.tuples(st.just("unfix"), PAIRS),
        st.tuples(st.just("move"), st.sampled_from(NAMES), POSES),
    ),
    min_size=2,
    max_size=10,
)


@settings(max_examples=60, deadline=None)
@given(ACTS)
def test_relative_poses_are_kept(acts: list[tuple[object, ...]]) -> None:
    """Any frames, affixed in any way and circle, released and moved: each is where rigid displacements put it."""
    world, lines = World(), []
    affixed = {act[1] for act in acts if act[0] == "affix"}
    for act in acts:
        match act:
            case ("affix", (str(child), str(parent)), bool(rigidly)):
                world.affix(child, parent, rigidly)
                lines.append(f"AFFIX {child} TO {parent}{' RIGIDLY' if rigidly else ''}")
            case ("unfix", (str(child), str(parent))) if (child, parent) in affixed:
                world.unfix(child, parent)
                lines.append(f"UNFIX {child} FROM {parent}")
            case ("move", str(frame), tuple(pose)):
                world.move(frame, matrix(pose))
                value = ", ".join(f"{part}: {number}" for part, number in zip("xyzabc", pose, strict=True))
                lines.append(f"{frame} = {{{value}}}")
    program, found = read(FRAMES + "\n".join([*lines, "WAIT 0.1 s"]))
    assert found == []
    simulation = Simulation(program, None, None, "main", 10.0)
    simulation.run()
    assert simulation.ended
    for name in NAMES:
        value = simulation.variable(name)
        assert isinstance(value, PoseValue)
        found_pose = np.array(value.rigid().matrix)
        assert np.allclose(found_pose, world.poses[name], atol=1e-6), (name, lines)


TABLE = "FRAME part = {x: 0, y: 0, z: 0, a: 0, b: 0, c: 0}\nFRAME hand = {x: 0, y: 0, z: 9, a: 0, b: 0, c: 0}\n"
HANGING = "FRAME hole = {x: 0, y: 0, z: 0, a: 0, b: 0, c: 0} ON part\n"
TAKE = "AFFIX part TO TOOL\n"
HOLD = "AFFIX part TO hand\n"
BY_REFERENCE = "FUNCTION push(REFERENCE p: POSE): BOOL\np.x = 1\nRETURN TRUE\nEND FUNCTION\n"


@pytest.mark.parametrize(
    ("text", "code", "line", "words"),
    [
        (TABLE + "AFFIX part TO nowhere", "affix-not-a-frame", 3, "nothing of that name"),
        (TABLE + "VAR q: JOINTS\nAFFIX q TO hand", "affix-not-a-frame", 4, "its type is JOINTS"),
        (TABLE + "VAR q: TARGET\nAFFIX part TO q", "affix-not-a-frame", 4, "its type is TARGET"),
        (TABLE + "VAR q: ARRAY[3] OF POSE\nAFFIX q[1] TO hand", "affix-not-a-frame", 4, "part of a variable"),
        (TABLE + "VAR q: ARRAY[3] OF POSE\nAFFIX q TO hand", "affix-not-a-frame", 4, "it is an array"),
        (TABLE + "CONST q: POSE = {x: 1, y: 0, z: 0}\nAFFIX part TO q", "affix-not-a-frame", 4, "constant"),
        (TABLE + HANGING + "AFFIX hole TO hand", "affix-not-a-frame", 4, "hangs on another frame"),
        (TABLE + "SIGNAL s = do[1]\nAFFIX part TO s", "affix-not-a-frame", 4, "it is a signal"),
        (TABLE + "AFFIX part TO part", "affix-to-itself", 3, "part is affixed to itself"),
        (TABLE + "AFFIX part TO hand\nUNFIX hand FROM part", "unfix-not-affixed", 4, "AFFIX hand TO part"),
        (
            TABLE + "PROCEDURE p(REFERENCE q: POSE)\nAFFIX q TO hand\nEND PROCEDURE",
            "affix-not-a-frame",
            4,
            "a parameter is another frame in each call",
        ),
        (
            TABLE + "PROCEDURE p()\nVAR q: POSE\nAFFIX q TO hand\nEND PROCEDURE",
            "affix-not-a-frame",
            5,
            "it is a variable of the routine",
        ),
        (
            TABLE + HOLD + "DECLARE INTERRUPT 3 WHEN di[1] DO hand.x = 5",
            "affixed-frame-changed-here",
            4,
            "an action of a trigger or interrupt",
        ),
        (
            TABLE + HOLD + "MOVE TO part TRIGGER AT end DO hand.x = 5",
            "affixed-frame-changed-here",
            4,
            "an action of a trigger or interrupt",
        ),
        (
            TABLE + HOLD + "IF push(hand) THEN\nNOTHING\nEND IF\n" + BY_REFERENCE,
            "affixed-frame-changed-here",
            4,
            "the head of a block",
        ),
        (
            TABLE + HOLD + "WAIT UNTIL push(hand)\n" + BY_REFERENCE,
            "affixed-frame-changed-here",
            4,
            "waits or leaves",
        ),
        (
            TABLE + HOLD + "START TASK push(hand)\n" + BY_REFERENCE,
            "affixed-frame-changed-here",
            4,
            "another task has it by REFERENCE",
        ),
        (TABLE + "AFFIX part TO TOOL RIGIDLY", "affix-not-a-frame", 3, "a robot is moved by MOVE"),
        (TABLE + "UNFIX part FROM TOOL", "unfix-not-affixed", 3, "AFFIX part TO tool"),
        (TABLE + TAKE + "WHILE part.x < 5\nNOTHING\nEND WHILE", "held-part-read-here", 4, "again and again"),
        (TABLE + TAKE + "WAIT UNTIL part.x > 5", "held-part-read-here", 4, "again and again"),
        (TABLE + TAKE + "MOVE TO hand TRIGGER AT end DO hand = part", "held-part-read-here", 4, "an action"),
        (
            TABLE + TAKE + "PROCEDURE p()\nVAR q: POSE = part\nEND PROCEDURE",
            "held-part-read-here",
            5,
            "a first value in a routine",
        ),
    ],
)
def test_what_is_reported(text: str, code: str, line: int, words: str) -> None:
    found = read(text)[1]
    assert len(found) == 1 and f"cell0.rpl:{line}:" in found[0] and code in found[0] and words in found[0], found


def test_frames_that_move_each_other_in_too_many_ways() -> None:
    names = [f"g{number}" for number in range(8)]
    text = "".join(f"FRAME {name} = {{x: 1, y: 0, z: 0, a: 0, b: 0, c: 0}}\n" for name in names)
    text += "".join(f"AFFIX {one} TO {other} RIGIDLY\n" for one in names for other in names if one < other)
    found = read(text)[1]
    assert len(found) == len(names) and all("affixed-too-often" in item for item in found)


def test_frames_of_modules_that_do_not_see_each_other() -> None:
    here = "MODULE a\nFRAME part = {x: 0, y: 0, z: 0, a: 0, b: 0, c: 0}\nGLOBAL PROCEDURE main()\nAFFIX part TO {}\n"
    there = (
        "END PROCEDURE\nEND MODULE\nMODULE b\nGLOBAL FRAME hand = {x: 0, y: 0, z: 0, a: 0, b: 0, c: 0}\nEND MODULE\n"
    )
    assert read(here.replace("{}", "hand") + there)[1] == []
    hidden = "MODULE c\nGLOBAL FRAME part = {x: 0, y: 0, z: 0, a: 0, b: 0, c: 0}\nPROCEDURE p()\nAFFIX part TO hand\n"
    found = read(here.replace("{}", "hand") + there + hidden + "END PROCEDURE\nEND MODULE\n")[1]
    assert len(found) == 1 and "affixed-out-of-sight" in found[0]


def test_modules_that_see_them_move_them() -> None:
    places = "MODULE places\nGLOBAL FRAME part = {x: 1, y: 0, z: 0, a: 0, b: 0, c: 0}\n"
    places += "GLOBAL FRAME hand = {x: 0, y: 0, z: 0, a: 0, b: 0, c: 0}\nEND MODULE\n"
    work = "MODULE work\nPROCEDURE main()\nAFFIX part TO hand\nhand.x = 10\nIF part.x = 11 THEN SET do[1] TO ON\n"
    program, found = read(places, work + "END PROCEDURE\nEND MODULE\n")
    assert found == []
    result = run_program(program, None, None, "main", 10.0)
    assert [event.data["value"] for event in result.trace if event.kind == "output"] == [True]


def test_a_variable_of_the_name_tool_is_meant_in_backticks() -> None:
    text = "VAR `tool`: POSE = {x: 0, y: 0, z: 0, a: 0, b: 0, c: 0}\n" + TABLE + "AFFIX part TO `tool`\ntool.x = 5\n"
    program, found = read(text + "IF part.x = 5 THEN SET do[1] TO ON\n")
    assert found == []
    result = run_program(program, None, None, "main", 10.0)
    assert [event.data["value"] for event in result.trace if event.kind == "output"] == [True]


def test_a_gripper_of_another_module_lets_go() -> None:
    hand = "MODULE hands\nGLOBAL GRIPPER hand = do[1]\nEND MODULE\n".replace("GLOBAL GRIPPER", "GRIPPER")
    work = f"MODULE work\n{TABLE}PROCEDURE main()\nMOVE TO joints {{j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0}}\n"
    work += "CLOSE hand ON part\nMOVE BY {j1: 10} IN JOINTS\nOPEN hand\nMOVE BY {j1: 10} IN JOINTS\n"
    program, found = read(hand, work + "IF part.y > 1 THEN SET do[2] TO ON\nEND PROCEDURE\nEND MODULE\n")
    assert found == []
    scopes = {node.name: node.scope for module in program.modules for node in module.declarations}
    assert scopes["part_follows_tool"] == "global" and scopes["part"] == "module"


def test_names_that_are_taken_are_left_alone() -> None:
    text = TABLE + "VAR part_in_hand: POSE\nPROCEDURE hand_moved()\nEND PROCEDURE\n" + HOLD + "hand.x = 1\n"
    program, found = read(text)
    assert found == []
    names = [node.name for node in (*program.modules[0].declarations, *program.modules[0].routines)]
    assert len({name.lower() for name in names}) == len(names)
    assert {"part_in_hand_2", "hand_moved_2"} <= set(names)


def test_rpl_prints_the_arithmetic_and_reads_it_back() -> None:
    program, _ = read(
        TABLE + "NOTHING\n-- taken\nAFFIX part TO hand RIGIDLY -- held\nhand.x = 1\nUNFIX part FROM hand\n"
    )
    text = registry.target("rpl").write(program, WriteContext(Diagnostics()))[0].data.decode()
    assert "part_in_hand = inverse(hand) : part -- held\n" in text
    assert text.count("-- held") == 1
    again, found = read(text)
    assert found == [] and again == program
