"""ur-rtde (all five interfaces; its control script is run by our interpreter) and paramiko against `rpl serve ur`."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.clients.conftest import ClientEnvironment
from tests.clients.running import run_client

pytestmark = pytest.mark.clients
pytest.importorskip("asyncssh", reason="the extra `ssh` is not installed")

# ur-rtde knows no other ports: the controller has an address of its own.
HOST = "127.0.0.31"
PROGRAM = "def pick():\n  set_standard_digital_out(2, True)\n  while True:\n    sync()\n  end\nend\n"


@pytest.fixture
def controller(tmp_path: Path) -> Iterator[Path]:
    """The transcript of a controller on the usual ports; SFTP on a free one, which stands in `ports`."""
    (tmp_path / "pick.script").write_text(PROGRAM, encoding="utf-8")
    transcript = tmp_path / "transcript.jsonl"
    command = [sys.executable, "-m", "rpl.cli.main", "serve", "ur", str(tmp_path / "pick.script"), "--robot", "ur5e"]
    command += ["--host", HOST, "--port", "sftp=0", "--transcript", str(transcript)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        if not line:
            said = process.communicate(timeout=60.0)[1]
            if "cannot listen" in said:
                pytest.skip(f"this machine does not let it listen at {HOST}: {said.strip()}")
            raise AssertionError(said)
        (tmp_path / "ports").write_text(line, encoding="utf-8")
        yield transcript
    finally:
        process.kill()
        process.communicate(timeout=60.0)


DASHBOARD = """
import json, sys
import dashboard_client

d = dashboard_client.DashboardClient(sys.argv[1])
d.connect()
said = {"version": d.polyscopeVersion(), "mode": d.robotmode(), "serial": d.getSerialNumber()}
said["model"] = d.getRobotModel()
said["remote"] = d.isInRemoteControl()
d.loadURP("pick.script")
said["loaded"] = d.getLoadedProgram()
d.play()
said["running"] = d.running()
d.pause()
said["state"] = d.programState()
d.stop()
d.popup("hello"); d.closePopup(); d.closeSafetyPopup(); d.unlockProtectiveStop(); d.addToLog("hello")
said["saved"] = d.isProgramSaved()
d.powerOff(); said["off"] = d.robotmode()
d.powerOn(); d.brakeRelease(); said["on"] = d.robotmode(); said["safety"] = d.safetystatus()
d.quit()
print(json.dumps(said))
"""

VALUES = """
import json, sys, time
import rtde_io, rtde_receive

r = rtde_receive.RTDEReceiveInterface(sys.argv[1])
io = rtde_io.RTDEIOInterface(sys.argv[1])
said = {"q": r.getActualQ(), "pose": r.getActualTCPPose(), "modes": [r.getRobotMode(), r.getSafetyMode()]}
said["set"] = [io.setStandardDigitalOut(3, True), io.setConfigurableDigitalOut(1, True), io.setToolDigitalOut(0, True),
               io.setSpeedSlider(0.5), io.setAnalogOutputVoltage(0, 0.25), io.setInputIntRegister(20, 7)]
until = time.time() + 30
while time.time() < until and not (r.getDigitalOutState(3) and r.getDigitalOutState(9) and r.getDigitalOutState(16)
                                   and r.getSpeedScaling() == 0.5 and r.getStandardAnalogOutput0() == 0.25):
    time.sleep(0.01)
said["outputs"] = [r.getDigitalOutState(n) for n in range(18)]
first = r.getTimestamp(); time.sleep(0.2); said["goes on"] = r.getTimestamp() > first
print(json.dumps(said))
"""

SCRIPT = """
import json, sys, time
import rtde_receive, script_client

r = rtde_receive.RTDEReceiveInterface(sys.argv[1])
s = script_client.ScriptClient(sys.argv[1], 5, 12)
s.connect()
said = {"connected": s.isConnected()}
open("sent.script", "w").write("def sent():\\n  set_standard_digital_out(5, True)\\n  sleep(0.1)\\nend\\n")
said["sent"] = s.sendScript("sent.script")
until = time.time() + 30
while time.time() < until and not r.getDigitalOutState(5):
    time.sleep(0.01)
said["ran"] = r.getDigitalOutState(5)
print(json.dumps(said))
"""

CONTROL = """
import json, sys, time
import rtde_control, rtde_receive

def there():  # values of another connection come a moment later
    time.sleep(0.5)
    return r.getActualTCPPose()

c = rtde_control.RTDEControlInterface(sys.argv[1])
r = rtde_receive.RTDEReceiveInterface(sys.argv[1])
said = {"running": c.isProgramRunning(), "before": r.getActualQ()}
goal = [0.3] + r.getActualQ()[1:]
said["moveJ"], said["goal"], said["joints"] = c.moveJ(goal, 2.0, 4.0), goal, there() and r.getActualQ()
pose = there()
lower = pose[:2] + [pose[2] - 0.05] + pose[3:]
said["ik"] = c.getInverseKinematics(lower)
said["moveL"], said["lower"], said["pose"] = c.moveL(lower, 0.5, 1.0), lower, there()
said["moveJ_IK"], said["upper"], said["back"] = c.moveJ_IK(pose, 2.0, 4.0), pose, there()
said["path"] = c.moveL([lower + [0.5, 1.0, 0.0], pose + [0.5, 1.0, 0.0]])
said["end"] = there()
said["settings"] = [c.setPayload(1.0, [0.0, 0.0, 0.01]), c.setTcp([0.0, 0.0, 0.1, 0.0, 0.0, 0.0])]
c.stopScript()
said["after"] = c.isProgramRunning()
print(json.dumps(said))
"""

SERVO = """
import json, sys, time
import rtde_control, rtde_receive

c = rtde_control.RTDEControlInterface(sys.argv[1])
r = rtde_receive.RTDEReceiveInterface(sys.argv[1])
said = {}

def stream(name, call, stop, count=100):
    answers = []
    for number in range(count):
        began = c.initPeriod()
        answers.append(call(number))
        c.waitPeriod(began)
    moved = wait_until(lambda: moves() or not c.isProgramRunning())
    said[name] = {"all": all(answers), "moved": moved, "stopped": stop(), "runs": c.isProgramRunning()}
    time.sleep(0.5)  # values of another connection come a moment later
    said[name]["q"], said[name]["pose"] = r.getActualQ(), r.getActualTCPPose()
    time.sleep(0.3)
    said[name]["rests"] = max(abs(a - b) for a, b in zip(r.getActualQ(), said[name]["q"])) < 1e-6
    said[name]["back"] = c.moveJ(q, 2.0, 4.0)
    time.sleep(0.5)

def wait_until(holds):
    until = time.time() + 20
    while time.time() < until and not holds():
        time.sleep(0.01)
    return holds()

def moves():
    return max(abs(a - b) for a, b in zip(r.getActualQ(), q)) > 1e-3

q, pose = r.getActualQ(), r.getActualTCPPose()
said["q"], said["pose"] = q, pose
said["stay"] = [c.servoJ(q, 0.5, 0.5, 0.002, 0.1, 300) for _ in range(50)] + [c.servoStop(), not moves()]
stream("servoJ", lambda n: c.servoJ([q[0] + 0.001 * n] + q[1:], 0.5, 0.5, 0.002, 0.1, 300), c.servoStop)
stream("servoL", lambda n: c.servoL(pose[:2] + [pose[2] - 0.0005 * n] + pose[3:], 0.5, 0.5, 0.002, 0.1, 300),
       c.servoStop)
stream("speedJ", lambda n: c.speedJ([0.2, 0.0, 0.0, 0.0, 0.0, 0.0], 0.5, 0.002), c.speedStop)
stream("speedL", lambda n: c.speedL([0.0, 0.0, -0.05, 0.0, 0.0, 0.0], 0.5, 0.002), c.speedStop)
stream("no time", lambda n: c.speedL([0.0, 0.0, -0.05, 0.0, 0.0, 0.0], 0.5), c.speedStop, 1)
c.stopScript()
print(json.dumps(said))
"""

FILES = """
import io, json, sys
import paramiko

transport = paramiko.Transport((sys.argv[1], int(sys.argv[2])))
transport.connect(username="root", password="robot")
sftp = paramiko.SFTPClient.from_transport(transport)
said = {"listed": sorted(sftp.listdir("/programs"))}
data = b"def place():\\nend\\n" * 5000
sftp.putfo(io.BytesIO(data), "/programs/place.tmp")
sftp.posix_rename("/programs/place.tmp", "/programs/pick.script")
said["same"] = sftp.open("/programs/pick.script").read() == data
said["size"] = sftp.stat("/programs/pick.script").st_size
sftp.mkdir("/programs/cell"); sftp.putfo(io.BytesIO(b"x"), "/programs/cell/x.script")
said["below"] = sftp.listdir("/programs/cell")
sftp.remove("/programs/cell/x.script")
try:
    sftp.stat("/programs/cell/x.script")
except FileNotFoundError:
    said["missing"] = True
print(json.dumps(said))
"""


@pytest.fixture
def ur_rtde(client_environment: ClientEnvironment) -> Path:
    return client_environment("ur_rtde", ["ur-rtde==1.6.5"])


def test_ur_rtde_works_the_dashboard(controller: Path, ur_rtde: Path) -> None:
    said = run_client(ur_rtde, DASHBOARD, HOST)
    assert said["version"] == "5.12.2.1101534" and said["serial"].isdigit() and said["model"] == "UR5"
    assert said["remote"] and said["running"] and said["saved"]
    assert said["loaded"].endswith("/programs/pick.script") and "PAUSED" in said["state"]
    assert "POWER_OFF" in said["off"] and "RUNNING" in said["on"] and "NORMAL" in said["safety"]


def test_ur_rtde_reads_values_and_sets_signals(controller: Path, ur_rtde: Path) -> None:
    said = run_client(ur_rtde, VALUES, HOST)
    assert said["q"] == pytest.approx([0.0, -1.5708, -1.5708, -1.5708, 1.5708, 0.0], abs=1e-4)
    assert said["pose"][:3] == pytest.approx([0.4919, -0.1333, 0.4879], abs=1e-4)
    assert said["modes"] == [7, 1] and said["set"] == [True] * 6 and said["goes on"]
    assert [number for number, on in enumerate(said["outputs"]) if on] == [3, 9, 16]


def test_ur_rtde_sends_a_script_that_runs(
    controller: Path, ur_rtde: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run_client(ur_rtde, SCRIPT, HOST) == {"connected": True, "sent": True, "ran": True}


def test_the_control_script_of_ur_rtde_is_run_by_our_interpreter(controller: Path, ur_rtde: Path) -> None:
    said = run_client(ur_rtde, CONTROL, HOST)
    assert said["running"] and said["moveJ"] and said["moveL"] and said["moveJ_IK"] and said["path"]
    assert said["joints"] == pytest.approx(said["goal"], abs=1e-5)
    assert said["pose"][:3] == pytest.approx(said["lower"][:3], abs=1e-5)
    assert said["back"][:3] == pytest.approx(said["upper"][:3], abs=1e-5)
    assert said["end"][:3] == pytest.approx(said["upper"][:3], abs=1e-5)
    assert not said["after"]
    assert len(said["ik"]) == 6 and said["settings"] == [True, True]
    started = [
        one for line in controller.read_text("utf-8").splitlines() if (one := json.loads(line))["kind"] == "start"
    ]
    assert started and all(one["interface"] == "realtime" for one in started)


def test_ur_rtde_drives_the_arm_place_by_place_and_at_given_speeds(controller: Path, ur_rtde: Path) -> None:
    """How far the arm comes depends on this machine; where it goes, and that it stops, does not."""
    said = run_client(ur_rtde, SERVO, HOST)
    q, pose = said["q"], said["pose"]
    for name in ("servoJ", "servoL", "speedJ", "speedL", "no time"):
        one = said[name]
        assert (one["all"], one["moved"], one["stopped"], one["runs"], one["rests"], one["back"]) == (True,) * 6, name
        other = [abs(a - b) for a, b in zip(one["q"][1:], q[1:], strict=True)]
        if name.endswith("J"):
            assert one["q"][0] - q[0] > 0.001 and max(other) < 1e-5
        else:
            assert one["pose"][2] < pose[2] - 0.0002
            assert one["pose"][:2] == pytest.approx(pose[:2], abs=1e-4)
    assert said["servoJ"]["q"][0] < q[0] + 0.0991 and said["servoL"]["pose"][2] > pose[2] - 0.0496
    assert all(said["stay"])


def test_paramiko_writes_and_reads_files(
    controller: Path, client_environment: ClientEnvironment, tmp_path: Path
) -> None:
    port = json.loads((tmp_path / "ports").read_text("utf-8"))["ports"]["sftp"]
    said = run_client(client_environment("paramiko", ["paramiko==5.1.0"]), FILES, HOST, port)
    assert said["listed"] == ["pick.script"] and said["same"] and said["size"] == 85_000
    assert said["below"] == ["x.script"] and said["missing"]
