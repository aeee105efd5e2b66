"""fanuc-ucl (SNPX, RMI, Stream Motion), fanucpy (MAPPDK) and aioftp, unchanged, against `rpl serve fanuc`."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.clients.conftest import ClientEnvironment
from tests.clients.running import run_client

pytestmark = pytest.mark.clients
pytest.importorskip("pyftpdlib", reason="the extra `ftp` is not installed")

SAMPLE = Path(__file__).parents[2] / "samples/tp/palletiser"
# fanuc-ucl cannot be told other ports: the robot has an address of its own.
HOST = "127.0.0.41"
READY_S, ENDED_S = 120.0, 60.0

PANEL = """
import json, sys
from fanuc_ucl import hmi

WAIT_S, seen = 60.0, {}
driver = hmi.HmiDriver(sys.argv[1])
driver.connect(timeout_secs=WAIT_S)
driver.write(hmi.Register, 1, [11, -22, 33]).wait_timeout(WAIT_S)
seen["registers"] = list(driver.read(hmi.Register, 1, 3).wait_timeout(WAIT_S))
driver.write(hmi.DigitalOutput, 5, [True, False, True]).wait_timeout(WAIT_S)
seen["outputs"] = list(driver.read(hmi.DigitalOutput, 1, 8).wait_timeout(WAIT_S))
driver.write(hmi.GroupOutput, 1, [10, 11]).wait_timeout(WAIT_S)
override = driver.register_sysvar_asg(int, name="$MCR.$GENOVERRIDE", timeout_secs=WAIT_S)
override.write(driver, 40).wait_timeout(WAIT_S)
seen["override"] = override.read(driver).wait_timeout(WAIT_S)
number = driver.register_asg(float, index=7, timeout_secs=WAIT_S)
number.write(driver, 2.5).wait_timeout(WAIT_S)
seen["real"] = number.read(driver).wait_timeout(WAIT_S)
text = driver.register_asg(str, index=3, timeout_secs=WAIT_S)
text.write(driver, "twelve").wait_timeout(WAIT_S)
seen["text"] = text.read(driver).wait_timeout(WAIT_S)
here = driver.register_asg(hmi.PositionData, True, frame=0, timeout_secs=WAIT_S).read(driver).wait_timeout(WAIT_S)
seen["place"] = [here.cartesian.x, here.cartesian.y, here.cartesian.z]
seen["valid"] = [here.cartesian.is_valid, here.joint.is_valid]
task = driver.register_asg(hmi.ProgramStatus, task=1, kind=hmi.ProgramStatusKind.Default, timeout_secs=WAIT_S)
seen["task"] = int(task.read(driver).wait_timeout(WAIT_S).state)
driver.clear_alarms().wait_timeout(WAIT_S)
driver.disconnect()
print(json.dumps(seen))
"""

REMOTE = """
import json, sys
from fanuc_ucl import JointFormat, JointTemplate, rmi

WAIT_S, seen = 60.0, {}
driver = rmi.RmiDriver(rmi.RmiDriverConfig(sys.argv[1], timeout_secs=WAIT_S))
driver.connect()
seen["initialised"] = driver.send(rmi.FrcInitialize()).wait_timeout(WAIT_S).error_id
seen["override"] = driver.send(rmi.FrcSetOverRide(80)).wait_timeout(WAIT_S).error_id
seen["status"] = driver.send(rmi.FrcGetStatus()).wait_timeout(WAIT_S).error_id
seen["frame"] = driver.send(rmi.FrcSetUFrame(0)).wait_timeout(WAIT_S).error_id
target = rmi.JointAngles(JointFormat.FanucDeg, JointTemplate.SIX, 10.0, 5.0, -5.0, 0.0, -60.0, 20.0)
move = rmi.FrcJointMotionJRep(target, rmi.SpeedType.MilliSeconds, 500, rmi.TermType.FINE, 0)
seen["move"] = driver.send(move).wait_timeout(120.0).error_id
seen["wait"] = driver.send(rmi.FrcWaitTime(0.5)).wait_timeout(120.0).error_id
found = driver.send(rmi.FrcReadJointAngles()).wait_timeout(WAIT_S)
seen["joints"] = list(found.joints(JointFormat.FanucDeg, JointTemplate.SIX).as_array())[:6]
seen["position"] = driver.send(rmi.FrcReadCartesianPosition()).wait_timeout(WAIT_S).error_id
seen["output"] = driver.send(rmi.FrcWriteDOUT(3, rmi.OnOff.ON)).wait_timeout(WAIT_S).error_id
seen["aborted"] = driver.send(rmi.FrcAbort()).wait_timeout(WAIT_S).error_id
driver.disconnect()
print(json.dumps(seen))
"""

STREAMING = """
import json, sys
from fanuc_ucl import JointFormat, JointTemplate, stmo

WAIT_S = 60.0
driver = stmo.StreamMotionDriver(sys.argv[1], 4)
driver.connect()
driver.start(WAIT_S)
setpoints = []
for step in range(100):
    joints = [step * 0.05, 5.0, -5.0, 0.0, -60.0, 20.0]
    setpoints.append(stmo.MotionCommandPacket.try_from_joints(JointFormat.FanucDeg, JointTemplate.SIX, joints))
driver.command_motion(setpoints).wait_timeout(WAIT_S)
driver.stop()
driver.disconnect()
print(json.dumps({"sent": len(setpoints)}))
"""

DRIVER = """
import json, sys
from fanucpy import Robot

robot = Robot("Fanuc", sys.argv[1], int(sys.argv[2]), ee_DO_type="RDO", ee_DO_num=7)
robot.connect()
robot.move("joint", vals=[10.0, 5.0, -5.0, 0.0, -60.0, 20.0], velocity=50, acceleration=100, cnt_val=0)
seen = {"joints": robot.get_curjpos()}
pose = robot.get_curpos()
pose[2] += 10.0
robot.move("pose", vals=pose, velocity=100, acceleration=100, cnt_val=0, linear=True)
seen["up"] = [round(a - b, 2) for a, b in zip(robot.get_curpos(), pose)]
robot.gripper(True)
seen["gripper"] = robot.get_rdo(7)
robot.set_dout(2, True)
seen["outputs"] = [robot.get_dout(2), robot.get_dout(3)]
seen["power"] = robot.get_ins_power()
robot.disconnect()
print(json.dumps(seen))
"""

FILES = """
import asyncio, json, sys
import aioftp

async def main():
    async with aioftp.Client.context(sys.argv[1], int(sys.argv[2]), "anonymous", "") as client:
        await client.change_directory("MD:")
        stream = await client.download_stream("PICK.LS")
        data = await stream.read()
        await stream.finish()
        stream = await client.upload_stream("NEW.LS")
        await stream.write(data)
        await stream.finish()
        stream = await client.download_stream("NEW.LS")
        again = await stream.read()
        await stream.finish()
        await client.remove_file("NEW.TP")
        print(json.dumps({"read": len(data), "same": data.split(b"/MN")[1].split() == again.split(b"/MN")[1].split()}))

asyncio.run(main())
"""


@pytest.fixture
def ports(tmp_path: Path) -> Any:
    command = [sys.executable, "-m", "rpl.cli.main", "serve", "fanuc", str(SAMPLE), "--robot", "fanuc_lrmate200id"]
    command += ["--host", HOST, "--port", "ftp=0"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        if not line:
            said = process.communicate(timeout=READY_S)[1]
            if "cannot listen" in said:
                pytest.skip(f"the address {HOST} cannot be had here: {said.strip()}")
            raise AssertionError(said)
        yield json.loads(line)["ports"]
    finally:
        process.terminate()
        assert "Traceback" not in process.communicate(timeout=ENDED_S)[1]


def test_fanuc_ucl_reads_and_writes_registers_signals_and_windows(
    client_environment: ClientEnvironment, ports: dict[str, int]
) -> None:
    seen = run_client(client_environment("fanuc-ucl", ["fanuc-ucl==2.0.2"]), PANEL, HOST)
    assert seen["registers"] == [11, -22, 33]
    # One by one it asks for the first bit of a byte and takes any for its own (2.0.2); all of a byte at once are right.
    assert seen["outputs"] == [False] * 4 + [True, False, True, False]
    assert (seen["override"], seen["real"], seen["text"], seen["task"]) == (40, 2.5, "twelve", 0)
    assert seen["place"] == pytest.approx([465.0, 0.0, 365.0], abs=1e-3)
    assert seen["valid"] == [True, True]


def test_fanuc_ucl_moves_the_robot_by_remote_motion(
    client_environment: ClientEnvironment, ports: dict[str, int]
) -> None:
    seen = run_client(client_environment("fanuc-ucl", ["fanuc-ucl==2.0.2"]), REMOTE, HOST)
    assert seen.pop("joints") == pytest.approx([10.0, 5.0, -5.0, 0.0, -60.0, 20.0], abs=1e-3)
    assert set(seen.values()) == {0}


def test_fanuc_ucl_streams_setpoints(client_environment: ClientEnvironment, ports: dict[str, int]) -> None:
    seen = run_client(client_environment("fanuc-ucl", ["fanuc-ucl==2.0.2"]), STREAMING, HOST)
    assert seen == {"sent": 100}


def test_fanucpy_drives_the_robot(client_environment: ClientEnvironment, ports: dict[str, int]) -> None:
    seen = run_client(client_environment("fanucpy", ["fanucpy==0.1.14"]), DRIVER, HOST, ports["mappdk"])
    assert seen["joints"] == pytest.approx([10.0, 5.0, -5.0, 0.0, -60.0, 20.0], abs=1e-3)
    assert seen["up"] == pytest.approx([0.0] * 6, abs=0.02)
    assert (seen["gripper"], seen["outputs"], seen["power"]) == (1, [1, 0], 0.0)


def test_aioftp_carries_programs(client_environment: ClientEnvironment, ports: dict[str, int]) -> None:
    seen = run_client(client_environment("aioftp", ["aioftp==0.28.3"]), FILES, HOST, ports["ftp"])
    assert seen["same"] is True
    assert seen["read"] == len((SAMPLE / "pick.ls").read_bytes().replace(b"\n", b"\r\n"))
