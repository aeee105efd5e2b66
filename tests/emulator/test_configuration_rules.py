"""The rules of every brand's arm configuration, one line a rule, with where the rule is written or was measured.

`SHOWN`: joints and the flags that the controller shows at them. `TAKEN`: a pose (of joints), the flags given with it,
where the arm is, and the joints that the controller takes, or words of its refusal. (M) marks what no source says.
"""

from __future__ import annotations

import numpy as np
import pytest

from rpl import registry
from rpl.emulator.configuration import Notation
from rpl.emulator.model import load_robot

Joints = tuple[float, ...]
Shown = tuple[str, str, Joints, tuple[int, ...], str]
Taken = tuple[str, str, Joints, tuple[int | None, ...], Joints | None, Joints | str, str]

KRL, RAPID, TP, INFORM, VPLUS, UR = "krl", "rapid", "tp", "inform", "vplus", "urscript"
KR6, KR125, IRB120, IRB6700 = "kuka_kr6r900sixx", "kuka_kr125_3", "abb_irb120_3_58", "abb_irb6700_140_285"
LRMATE, R2000, M20, GP7 = "fanuc_lrmate200id", "fanuc_r2000ic165f", "fanuc_m20id25", "motoman_gp7"
KR16, KR210, GP25 = "kuka_kr16_2", "kuka_kr210r2700prime", "motoman_gp25"
VIPER, COBRA, UR5E = "adept_viper_s650", "adept_cobra_s600", "ur5e"

KVP = "a state read from a controller ($POS_ACT: X 1339.9 Y 15.92 A 0 B 90 C -0.6808 S 6 T 19) in public code"
MACHINE = "machine data of a KR 210 R2700 prime in a public backup: A3 and A4 are -41 mm apart"
CELL = "a cell of GP25, github.com/lukelalondePZ/Komatsu-Press-Demo"
SUMMARY = "FANUC, summary.dg of a SCARA prints CFG: R, 0, 0, 0 (public notes)"
EXPERT = "KUKA, Expert Programming KSS 5.2, tables 2 and 3"
BACKUP = "taught points of a KR 125/3 in a public backup"
SINGUL = "KUKA, KR C2 operating handbook, machine data 2.1.151 $SINGUL_POS, as delivered 0"
SYSTEM = "KUKA, KSS operating manual: PTP to a point without S and T"
CONFDATA = "ABB, RAPID instructions, functions and data types: confdata, ConfJ"
CALC = "CalcRobT on RobotStudio (LeroyDu56/CrossArm, docs/validation.md)"
ROBOGUIDE = "ROBOGUIDE (LeroyDu56/CrossArm, docs/validation.md)"
MOTN = "FANUC controllers refuse another turn with MOTN-018 (CrossArm; public backups)"
DATA = "Yaskawa, NX100 and DX100 data transmission: RCONF"
ADEPT = "Adept, V+ language reference: LEFTY, ABOVE, FLIP, SINGLE"
SCRIPT = "Universal Robots, script manual: get_inverse_kin"
KEPT = "(M) the joint that is free stays where it is"

SHOWN: tuple[Shown, ...] = (
    (KRL, KR6, (0, -90, 90, 0, 10, 0), (2, 2), EXPERT + ": S bits"),
    (KRL, KR6, (10, -150, 20, 0, 30, 0), (3, 2), EXPERT + ": S bit 0"),
    (KRL, KR6, (0, -90, 90, 0, -10, 0), (6, 18), EXPERT + ": S bit 2"),
    (KRL, KR6, (0, -90, 90, -0.0, -0.0, -0.0), (2, 2), EXPERT + ": a negative zero is a zero"),
    (KRL, KR6, (0, -90, 4.77, 0, 10, 0), (2, 2), "KR 6 R900 sixx on a controller: the elbow changes at +4.76"),
    (KRL, KR6, (0, -90, 4.75, 0, 10, 0), (0, 2), "KR 6 R900 sixx on a controller: the elbow changes at +4.76"),
    (KRL, KR125, (0, -90, 2.59, 0, 10, 0), (2, 2), BACKUP + ": the elbow changes at +2.58"),
    (KRL, KR125, (0, -90, 2.57, 0, 10, 0), (0, 2), BACKUP + ": the elbow changes at +2.58"),
    (KRL, KR125, (0, -90, 90, -190.07, 10, 0), (2, 10), BACKUP + ": T by the true angle, also beyond half a turn"),
    (KRL, KR125, (0, -90, 90, 190, 10, -350), (2, 34), BACKUP + ": T by the true angle, also beyond half a turn"),
    (RAPID, IRB6700, (0, 0, 0, 0, 0, 0), (0, 0, 0, 0), CONFDATA + ": quarter turns of axes 1, 4 and 6"),
    (RAPID, IRB6700, (-0.00018, 0, 0, 90, 1, 190), (-1, 1, 2, 0), CALC + ": strict, -0.00018 is -1, 90 is 1, 190 is 2"),
    (RAPID, IRB6700, (89.99, 0, 0, -185, -1, -0.0), (0, -3, 0, 1), CALC + ": -185 is -3, J5 negative counts 1"),
    (RAPID, IRB6700, (0, 0, -81.5, 0, 30, 0), (0, 0, 0, 0), CALC + ": elbow at -atan2(1392.5, 200) = -81.83"),
    (RAPID, IRB6700, (0, 0, -82.2, 0, 30, 0), (0, 0, 0, 2), CALC + ": elbow at -atan2(1392.5, 200) = -81.83"),
    (RAPID, IRB6700, (0, -60, -60, 0, 30, 0), (0, 0, 0, 4), CALC + ": wrist centre behind axis 1 counts 4"),
    (RAPID, IRB6700, (0, -60, -100, 0, -30, 0), (0, 0, 0, 7), CALC + ": the elbow does not depend on the shoulder"),
    (TP, LRMATE, (0, 0, 0, 0, -90, 0), (0, 0, 0, 0, 0, 0), ROBOGUIDE + ": N U T"),
    (TP, LRMATE, (0, 0, 0, 0, 90, 0), (1, 0, 0, 0, 0, 0), ROBOGUIDE + ": F is J5 above zero"),
    (TP, M20, (0, 40, 60, 0, -90, 0), (0, 1, 0, 0, 0, 0), ROBOGUIDE + ": D by the elbow line, J3 to the horizontal"),
    (TP, M20, (0, -60, 80, 0, -90, 0), (0, 0, 1, 0, 0, 0), ROBOGUIDE + ": B, and the elbow line is not mirrored"),
    (TP, R2000, (0, 0, 0, 179.99, -90, -179.99), (0, 0, 0, 0, 0, 0), MOTN + ": turn 0 is open at both ends"),
    (TP, R2000, (0, 0, 0, 180, -90, -180), (0, 0, 0, 0, 1, -1), MOTN + ": 180 is turn 1, -180 is turn -1"),
    (TP, R2000, (0, 0, 0, 350, -90, -235), (0, 0, 0, 0, 1, -1), MOTN + ": 350 is turn 1, -235 is turn -1"),
    (INFORM, GP7, (0, 0, 0, 0, -60, 0), (1, 0, 0, 0, 0, 0), DATA + ": no-flip, upper, front"),
    (INFORM, GP7, (0, 0, 0, 0, 60, 0), (0, 0, 0, 0, 0, 0), DATA + ": flip; (M) by the sign of B"),
    (INFORM, GP7, (0, 0, 0, 185, -60, 200), (1, 0, 0, 1, 1, 0), DATA + ": R and T beyond half a turn"),
    (INFORM, GP7, (0, 0, 0, 180, -60, -180), (1, 0, 0, 0, 1, 0), DATA + ": the half turn is above -180 up to 180"),
    (VPLUS, COBRA, (10, 40, 50, 0), (0, 0, 0), ADEPT + ": a SCARA's handedness, RIGHTY is joint 2 positive"),
    (VPLUS, COBRA, (10, -40, 50, 0), (1, 0, 0), ADEPT + ": LEFTY is joint 2 negative"),
    (VPLUS, VIPER, (0, -90, 180, 0, 45, 0), (0, 0, 0), ADEPT + ": RIGHTY ABOVE NOFLIP"),
    (VPLUS, VIPER, (0, -90, 180, 0, -45, 0), (0, 0, 1), ADEPT + ": FLIP is joint 5 negative"),
    (UR, UR5E, (0, -90, 90, 0, 45, 0), (), SCRIPT + ": a pose has no flags"),
    (KRL, KR16, (-0.6808, -60, 70, 0, -10, 0), (6, 19), KVP + ": A1 clockwise, S 6 and T bits 0, 1 and 4"),
    (KRL, KR210, (0, -90, -1.95, 0, 10, 0), (2, 6), MACHINE + ": an elbow offset upwards, the elbow changes at -1.96"),
    (KRL, KR210, (0, -90, -1.97, 0, 10, 0), (0, 6), MACHINE + ": an elbow offset upwards, the elbow changes at -1.96"),
    (INFORM, GP25, (136.043, -8.663, -22.801, -43.074, 19.224, 42.541), (0,) * 6, CELL + ": flip above zero"),
    (INFORM, GP25, (145.76, -8.74, -8.4, 89.77, -55.76, 180.4), (1, 0, 0, 0, 1, 0), CELL + ": no-flip below zero"),
    (INFORM, GP25, (0, 0, 0, -181, -60, 181), (1, 0, 0, 1, 1, 0), DATA + ": R at -181 and T at 181 are beyond"),
    (TP, COBRA, (10, 40, 50, 200), (0, 0, 0, 0, 1, 0), SUMMARY + ": of a SCARA R and the turns of J1 and J4"),
    (TP, COBRA, (10, -40, 50, 0), (0, 1, 0, 0, 0, 0), SUMMARY + ": (M) L is joint 2 below zero"),
    (VPLUS, VIPER, (10, -150, 90, 20, 50, 30), (1, 0, 0), ADEPT + ": LEFTY, the wrist behind axis 1, elbow above"),
    (VPLUS, VIPER, (10, -168.1014, 123.9323, 26.8662, 35.4344, 20.7391), (1, 1, 0), ADEPT + ": LEFTY, elbow below"),
)

HOME6 = (0, -90, 90, 0, 60, 0)
TAKEN: tuple[Taken, ...] = (
    # KRL: explicit, missing, absolutely accurate, next to zero, singular
    (KRL, KR6, (10, -80, 70, 200, 50, 60), (2, 10), HOME6, (10, -80, 70, -160, 50, 60), EXPERT + ": T"),
    (KRL, KR6, (10, -80, 70, 200, 50, 60), (2, 2), HOME6, "cannot be reached", EXPERT + ": A4 ends at 185"),
    (KRL, KR6, (10, -80, 70, 30, 50, -300), (2, 34), HOME6, (10, -80, 70, 30, 50, -300), EXPERT + ": T"),
    (KRL, KR6, (10, -80, 70, 30, 50, 60), (2, 34), HOME6, (10, -80, 70, 30, 50, -300), EXPERT + ": T"),
    (KRL, KR6, (10, -80, 70, 30, 50, 60), (18, 2), HOME6, (10, -80, 70, 30, 50, 60), EXPERT + ": bit 4"),
    (KRL, KR6, (10, -80, 70, 30, 50, 60), (10, 2), HOME6, (10, -80, 70, 30, 50, 60), EXPERT + ": bit 3 is not used"),
    (KRL, KR6, (10, -80, 70, 30, 50, 60), (26, 2), HOME6, (10, -80, 70, 30, 50, 60), EXPERT + ": bits 3 and 4"),
    (KRL, KR6, (10, -80, 70, 30, 50, 60), (18, 34), HOME6, (10, -80, 70, 30, 50, -300), EXPERT + ": bit 4 and T"),
    (KRL, KR6, (0, -80, 70, 0, 50, 0), (2, 59), HOME6, "cannot be reached", EXPERT + ": A2 is below zero, A5 above"),
    (KRL, KR6, (0, -80, 70, 0, 50, 0), (2, 43), HOME6, (0, -80, 70, 0, 50, 0), "(M) T next to zero, exactly there"),
    (KRL, KR6, (10, -80, 70, 30, 50, 60), (1, 0), HOME6, "cannot be reached", "never replaced in silence"),
    (KRL, KR6, (20, -80, 70, 10, 50, 30), (None, None), (0, -90, 90, 0, -9, 0), (20, -80, 70, -170, -50, -150), SYSTEM),
    (KRL, KR6, (0, -90, 90, 0, 60, -40), (2, None), (0, -90, 90, 0, 60, 300), (0, -90, 90, 0, 60, 320), SYSTEM),
    (KRL, KR6, HOME6, (2, None), None, "first motion needs both", SYSTEM),
    (KRL, KR6, (1.5, -90, 90, 0, 60, 0), (2, 3), HOME6, (1.5, -90, 90, 0, 60, 0), "(M) T next to zero"),
    (KRL, KR6, (10, -80, 70, 30, 0, 10), (2, 2), (0, -90, 90, 25, 9, 0), (10, -80, 70, 0, 0, 40), SINGUL + ": axis 4"),
    (KRL, KR6, (10, -80, 70, 30, 0, 10), (6, 2), (0, -90, 90, 25, 9, 0), (10, -80, 70, 0, 0, 40), SINGUL),
    # RAPID: ConfJ on, off, tolerance
    (RAPID, IRB120, (10, 10, 10, 20, 30, 370), (0, 0, 4, 0), None, (10, 10, 10, 20, 30, 370), CONFDATA + ": explicit"),
    (RAPID, IRB120, (10, 10, 10, 20, 30, 10), (0, 0, -1, 0), None, (10, 10, 10, 20, 30, 10), CONFDATA + ": 45 degrees"),
    (RAPID, IRB120, (10, 10, 10, 20, 30, 10), (0, 0, 1, 0), None, "cannot be reached", CONFDATA + ": more than 45"),
    (RAPID, IRB120, (10, 10, 10, 20, 30, 10), (0, 0, 0, 2), None, "cannot be reached", CONFDATA),
    (RAPID, IRB120, (10, 10, 10, 0, 40, 0), (None,) * 4, (0, 0, 0, 0, 30, 350), (10, 10, 10, 0, 40, 360), CONFDATA),
    (RAPID, IRB120, (0, 0, 0, 30, 0, 10), (0, 0, 0, 0), (0, 0, 0, 25, 9, 0), (0, 0, 0, 25, 0, 15), KEPT),
    # FANUC: exactly the CONFIG, refused otherwise
    (TP, R2000, (0, 0, 0, 0, -90, 180), (0, 0, 0, 0, 0, 1), None, (0, 0, 0, 0, -90, 180), MOTN),
    (TP, R2000, (0, 0, 0, 0, -90, 180), (0, 0, 0, 0, 0, -1), None, (0, 0, 0, 0, -90, -180), MOTN),
    (TP, R2000, (0, 0, 0, 0, -90, 180), (0, 0, 0, 0, 0, 0), None, "cannot be reached", MOTN),
    (TP, R2000, (0, 0, 0, 0, -90, 0), (1, 0, 0, 0, 0, 0), None, "'N U T, 0, 0, 0'", MOTN + ": what it can do is said"),
    (TP, R2000, (0, 0, 0, 0, -90, 0), (None,) * 6, (0, 0, 0, 0, -80, 300), (0, 0, 0, 0, -90, 360), "PR[]"),
    (TP, R2000, (10, 0, 0, 30, 0, 10), (0, 0, 0, 0, 0, 0), (0, 0, 0, 25, -9, 0), (10, 0, 0, 25, 0, 15), KEPT),
    (TP, COBRA, (10, 40, 50, 20), (None, 1, None, 0, 0, 0), None, (46.5254, -40, 50, -23.4746), SUMMARY + ": L"),
    (TP, COBRA, (10, 40, 50, 20), (0, 0, 0, 0, 0, 1), None, "'R, 0, 0, 1' cannot be reached", "a SCARA has no axis 6"),
    # INFORM: given flags are met, the others kept
    (INFORM, GP7, (10, 10, 5, 20, -50, 30), (1, 0, 0, 0, 0, 0), None, (10, 10, 5, 20, -50, 30), DATA),
    (INFORM, GP7, (10, 10, 5, 20, -50, 30), (1, 0, 0, 0, 1, 0), None, (10, 10, 5, 20, -50, -330), DATA + ": T beyond"),
    (INFORM, GP7, (10, 10, 5, 20, -50, 30), (1, 1, 0, 0, 0, 1), None, "cannot be reached", DATA),
    (INFORM, GP7, (10, 10, 5, 20, -50, 30), (None,) * 6, (0, 0, 0, 0, -20, 0), (10, 10, 5, 20, -50, 30), DATA),
    # V+: what is not asked for stays
    (VPLUS, VIPER, (10, -80, 170, 20, 50, 30), (None, None, 1), (0, -90, 180, 0, 5, 0), (10, -80, 170, -160, -50, -150),
     ADEPT),
    (VPLUS, COBRA, (10, 40, 50, 20), (1, None, None), (0, 30, 0, 0), (46.5254, -40, 50, -23.4746), ADEPT + ": LEFTY"),
    (VPLUS, VIPER, (10, -150, 90, 20, 50, 30), (0, 0, 0), (0, -90, 180, 0, 5, 0),
     (-170, -72.6542, 189.546, -164.2923, 104.5881, 47.2195), ADEPT + ": RIGHTY"),
    (VPLUS, VIPER, (10, -150, 90, 20, 50, 30), (0, 1, 0), (0, -90, 180, 0, 5, 0),
     (-170, 16.6032, 24.3863, -150.9246, 32.6254, 18.0743), ADEPT + ": BELOW"),
    (VPLUS, VIPER, (10, -150, 90, 20, 50, 30), (1, 1, 0), (0, -90, 180, 0, 5, 0),
     (10, -168.1014, 123.9323, 26.8662, 35.4344, 20.7391), ADEPT + ": LEFTY BELOW"),
    (VPLUS, VIPER, (170, -150, 190, 20, 50, 30), (1, 0, 0), None, "cannot be reached LEFTY ABOVE NOFLIP", ADEPT),
    # URScript: the nearest
    (UR, UR5E, (10, -80, 70, -60, 50, 30), (), (10, -80, 70, -60, 50, -300), (10, -80, 70, -60, 50, -330), SCRIPT),
)  # fmt: skip


def notation(dialect: str) -> Notation:
    make = registry.dialect(dialect).notation
    assert make is not None
    return make()


@pytest.mark.parametrize(("dialect", "robot", "joints", "flags", "source"), SHOWN)
def test_shown(dialect: str, robot: str, joints: Joints, flags: tuple[int, ...], source: str) -> None:
    assert source
    kind = notation(dialect)
    assert kind.encode(load_robot(robot), np.array(joints, dtype=float)) == dict(zip(kind.fields, flags, strict=True))


@pytest.mark.parametrize(("dialect", "robot", "pose", "flags", "near", "wanted", "source"), TAKEN)
def test_taken(
    dialect: str, robot: str, pose: Joints, flags: tuple[int | None, ...], near: Joints | None, wanted: Joints | str,
    source: str,
) -> None:  # fmt: skip
    assert source
    kind, model = notation(dialect), load_robot(robot)
    here = None if near is None else np.array(near, dtype=float)
    found = kind.select(model, model.forward(pose), dict(zip(kind.fields, flags, strict=True)), here)
    if isinstance(wanted, str):
        assert found.joints is None
        assert wanted in found.reason
    else:
        assert found.joints == pytest.approx(wanted, abs=1e-3), found.reason
