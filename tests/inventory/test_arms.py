"""Which arm a backup is of: makers' names beside those of robot files."""

from __future__ import annotations

import gzip
from pathlib import Path

import pytest

from rpl.diagnostics import Diagnostics
from rpl.emulator.robotfile import robot_names
from rpl.inventory.robots import ArmFound, arms_of, named
from rpl.project import read_program, read_sources
from rpl.source import source_from_text


@pytest.mark.parametrize(
    ("maker", "called", "robot"),
    [
        ("kuka", "KR6R900SIXX C4SR FLR ZH01", "kuka_kr6r900sixx"),
        ("kuka", "KR120R2700 EXTRA HA C4 FLR", "kuka_kr120r2700extra"),
        ("kuka", "KR16_2 C4", "kuka_kr16_2"),
        ("kuka", "KR30L16_3A C4 FLR", ""),
        ("abb", "ROB1_6700_2.65_235", "abb_irb6700_235_265"),
        ("abb", "ROB1_6700_LeanID_2.65_220", ""),  # this payload has no file
        ("abb", "IRB140_0.81_5_typeB", "abb_irb140"),
        ("abb", "IRB1200_5_0.9", "abb_irb1200_5_90"),
        ("fanuc", "LR Mate 200iD/4S", "fanuc_lrmate200id4s"),
        ("fanuc", "LR Mate 200iD", "fanuc_lrmate200id"),
        ("fanuc", "R-2000iC/165F", "fanuc_r2000ic165f"),
        ("fanuc", "M-710iC/70", ""),
    ],
)
def test_names_of_makers(maker: str, called: str, robot: str) -> None:
    assert named(called, [name for name in robot_names() if name.startswith(maker)])[0] == robot


def test_arms_of_the_same_model_are_near() -> None:
    names = [name for name in robot_names() if name.startswith("abb")]
    assert named("ROB1_6700_LeanID_2.65_220", names)[1] == tuple(name for name in names if "irb6700" in name)


@pytest.mark.parametrize(
    ("dialect", "path", "text", "expected"),
    [
        (
            "krl",
            "$machine.dat",
            'DEFDAT $MACHINE PUBLIC\nCHAR $TRAFONAME[32]\n$TRAFONAME[]="#KR6R900SIXX C4SR FLR"\nENDDAT\n',
            ArmFound("KR6R900SIXX C4SR FLR", "$machine.dat", "kuka_kr6r900sixx"),
        ),
        (
            "rapid",
            "MOC.cfg",
            'MOC:CFG_1.0:6:0::\n#\nROBOT:\n\n      -name "ROB_1" -use_robot_type "ROB1_6700_2.65_235"\n',
            ArmFound("ROB1_6700_2.65_235", "MOC.cfg", "abb_irb6700_235_265"),
        ),
        (
            "tp",
            "SYSVARS.VA",
            "[*SYSTEM*]$SCR_GRP  Storage: CMOS  Access: RW  : ARRAY[1] OF SCR_GRP_T\n"
            "  Field: $SCR_GRP[1].$ROBOT_MODEL  Access: RO: STRING[25] = 'R-2000iC/165F'\n",
            ArmFound("R-2000iC/165F", "SYSVARS.VA", "fanuc_r2000ic165f"),
        ),
    ],
)
def test_files_of_backups_name_the_arm(dialect: str, path: str, text: str, expected: ArmFound) -> None:
    read = read_sources([source_from_text(path, text)], dialect, Diagnostics())
    assert arms_of(read) == (expected,)


SYSTEM = """/SYSTEM 8
//DATE      : 2026/02/01 08:00:00
//ROBOT NAME
R1 : 1-06VXH25-A0*(GP25)                          0011_1111
R2 : 1-06VX8-A0*(GP8)                             0011_1111
S1 : TURN-1                                       0000_0001
//CONTROL POWER
R1    : 2026/02/01 08:00,00016:34'49
"""
JOB = "/JOB\n//NAME A\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\n///DATE 2026/02/10 09:00\n///ATTR SC,RW\nNOP\nEND\n"
KINEMATICS = (
    '<kinematics status="{}"><deltaTheta value="{}"/><a value="{}"/><d value="{}"/><alpha value="0,0,0,0,0,0"/>'
    "</kinematics>"
)
SAVED = (
    '<?xml version="1.0"?><URProgram name="pick">{}<children><MainProgram><children><Script type="Code">'
    "<cachedContents>sync()</cachedContents></Script></children></MainProgram></children></URProgram>"
)


def test_a_backup_of_jobs_names_its_arms_in_its_system_file(tmp_path: Path) -> None:
    (tmp_path / "A.JBI").write_text(JOB)
    (tmp_path / "SYSTEM.SYS").write_text(SYSTEM)
    found = arms_of(read_program([tmp_path]))
    assert found == (
        ArmFound("GP25", "SYSTEM.SYS", "motoman_gp25"),
        ArmFound("GP8", "SYSTEM.SYS", "motoman_gp8"),
    )


@pytest.mark.parametrize(
    ("called", "robot"),
    [("GP12", "motoman_gp12"), ("GP120", ""), ("GP180-120", "motoman_gp180_120"), ("MA2010", "motoman_ma2010")],
)
def test_a_number_that_goes_on_is_another_arm(called: str, robot: str) -> None:
    assert named(called, [name for name in robot_names() if name.startswith("motoman")])[0] == robot


@pytest.mark.parametrize(
    ("turned", "a", "d", "robot"),
    [
        ("0,0,0,0,0,0", "0,-0.425,-0.3922,0,0,0", "0.1625,0,0,0.1333,0.0997,0.0996", "ur5e"),
        ("0,0,0,0,0,0", "0,-0.425,-0.39225,0,0,0", "0.089159,0,0,0.10915,0.09465,0.0823", "ur5"),
        # Calibrated arms, as they stand in two saved programs of other people.
        ("0,-1.408,1.372,0.036,0,0", "0,-0.0993,-0.5711,0,0,0", "0.1808,429.38,-433.06,3.858,0.1198,0.1156", "ur10e"),
        (
            "0,-0.03258,-0.87729,0.90988,0,0",
            "0,-0.61183,-0.35064,0,0,0",
            "0.18107,-12,254,-242,0.11979,0.11569",
            "ur10e",
        ),
        ("0,0,0,0,0,0", "0,0,0,0,0,0", "0,0,0,0,0,0", ""),
        ("0,0,0,0,0,0", "0,-0.7,-0.6,0,0,0", "0.15,0,0,0.13,0.1,0.1", ""),
        ("0", "no numbers", "0", ""),
    ],
)
def test_a_saved_program_is_of_the_arm_that_has_its_lengths(
    turned: str, a: str, d: str, robot: str, tmp_path: Path
) -> None:
    path = tmp_path / "pick.urp"
    path.write_bytes(gzip.compress(SAVED.format(KINEMATICS.format("LINEARIZED", turned, a, d)).encode()))
    assert [one.robot for one in arms_of(read_program([tmp_path]))] == ([robot] if robot else [])
