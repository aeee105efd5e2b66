"""Which arm a backup is of: makers' names beside those of robot files."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.emulator.robotfile import robot_names
from rpl.inventory.robots import ArmFound, arms_of, named
from rpl.project import read_sources
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
