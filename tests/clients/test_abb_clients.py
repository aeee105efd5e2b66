"""abb-robot-client (REST, websocket, EGM), rwsuis and rwswrap against `rpl serve abb`."""

import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.clients.conftest import ClientEnvironment
from tests.clients.running import run_client
from tests.controllers.serving import Served, served

pytestmark = pytest.mark.clients
pytest.importorskip("aiohttp", reason="the extra `rws` is not installed")
pytest.importorskip("cryptography", reason="the extra `rws` is not installed")

SAMPLE = Path(__file__).parents[2] / "samples/rapid/project"
DATA = """MODULE tmod
  PERS robtarget ptest:=[[100,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS zonedata zTest:=[FALSE,10,15,15,1.5,15,1.5];
  PERS speeddata vTest:=[100,500,5000,1000];
  PERS num aTest{3}:=[1,2,3];
  PERS num nTest:=1;
  PERS jointtarget jTest:=[[1,2,3,4,5,6],[9E9,9E9,9E9,9E9,9E9,9E9]];
ENDMODULE
"""


@pytest.fixture
def controller(tmp_path: Path) -> Iterator[Served]:
    module = tmp_path / "tmod.mod"
    module.write_text(DATA, encoding="latin-1")
    robot = ("--robot", "abb_irb120_3_58", "--time-scale", "3")
    with served("abb", tmp_path, SAMPLE, module, *robot) as found:
        yield found


CLIENT = """
import json, sys, time
from abb_robot_client.rws import *

c = RWS(sys.argv[1], "Default User", "robot")
said = {}
said["states"] = [c.get_execution_state().ctrlexecstate, c.get_controller_state(), c.get_operation_mode()]
said["ramdisk"] = c.get_ramdisk_path()
said["tasks"] = {name: task.motiontask for name, task in c.get_tasks().items()}
said["joints"] = list(c.get_jointtarget().robax)
target = c.get_robtarget()
said["pose"] = list(target.trans) + list(target.rot)
said["listed"] = c.list_files("$HOME")
said["read"] = len(c.read_file("$HOME/main.mod"))
c.upload_file("$HOME/up.mod", b"MODULE up" + b" " * 100000)
said["uploaded"] = len(c.read_file("$HOME/up.mod"))
c.delete_file("$HOME/up.mod")
said["left"] = c.list_files("$HOME")
try:
    c.read_file("$HOME/nobody.mod")
except Exception as error:
    said["missing"] = str(error)
said["data"] = sorted(item["name"] for item in c.get_rapid_variables())
c.set_rapid_variable_num("nTest", 7.5)
said["number"] = c.get_rapid_variable_num("nTest")
c.set_rapid_variable_num_array("aTest", [4, 5, 6])
said["array"] = list(c.get_rapid_variable_num_array("aTest"))
said["jointtarget"] = list(c.get_rapid_variable_jointtarget("jTest").robax * 180 / 3.141592653589793)
try:
    c.set_rapid_variable("nTest", "[1,2")
except ABBException as error:
    said["refused"] = str(error)
c.set_digital_io("doTest", 1)
c.set_analog_io("aoTest", 2.5)
said["signals"] = [c.get_digital_io("doTest"), c.get_analog_io("aoTest")]
c.set_speedratio(50.0)
said["speed"] = c.get_speedratio()
said["queue"] = [c.try_create_ipc_queue("q"), c.try_create_ipc_queue("q")]
c.send_ipc_message("q", "num;5", "q")
said["message"] = c.read_ipc_message("q")[0].data

events = []
kinds, medium = SubscriptionResourceType, SubscriptionResourcePriority.Medium
wanted = [SubscriptionResourceRequest(kind, medium) for kind in (kinds.ExecutionState, kinds.ControllerState)]
wanted += [SubscriptionResourceRequest(kinds.OperationalMode, medium), SubscriptionResourceRequest(kinds.Elog, medium)]
wanted += [SubscriptionResourceRequest(kinds.Signal, SubscriptionResourcePriority.High, "doTest")]
wanted += [SubscriptionResourceRequest(kinds.PersVar, SubscriptionResourcePriority.High, "nTest")]
wanted += [SubscriptionResourceRequest(kinds.IpcQueue, medium, "q")]
subscription = c.subscribe(wanted, events.append)


def until(holds):
    end = time.monotonic() + 60
    while not holds():
        assert time.monotonic() < end, events
        time.sleep(0.05)


until(lambda: subscription.ws.sock is not None and subscription.ws.sock.connected)
c.set_digital_io("doTest", 0)
c.set_rapid_variable_num("nTest", 8)
c.send_ipc_message("q", "num;6", "q")
c.resetpp()
c.start(cycle="once", tasks=["T_ROB1"])
until(lambda: any(getattr(e, "ctrlexecstate", "") == "stopped" for e in events))
c.set_controller_state("motoroff")
until(lambda: any(getattr(e, "state", "") == "motoroff" for e in events))
said["events"] = sorted({type(event).__name__ for event in events})
said["log"] = [entry.title for entry in c.read_event_log()]
subscription.close()
c.close()
print(json.dumps(said))
"""


def test_abb_robot_client(client_environment: ClientEnvironment, controller: Served) -> None:
    python = client_environment("abb-robot-client", ["abb-robot-client==0.4.0"])
    said = run_client(python, CLIENT, f"http://{controller.host}:{controller.ports['rws']}")
    assert said["states"] == ["stopped", "motoron", "AUTO"]
    assert said["tasks"] == {"T_ROB1": True}
    assert said["joints"] == [0.0] * 6
    assert said["pose"] == pytest.approx([374.0, 0.0, 630.0, 0.5**0.5, 0.0, 0.5**0.5, 0.0])
    assert said["listed"] == said["left"] == ["expected.toml", "main.mod", "stations.mod", "tmod.mod", "tools.sys"]
    assert said["read"] == (SAMPLE / "main.mod").stat().st_size
    assert said["uploaded"] == 100009
    assert "nobody.mod" in said["missing"]
    assert {"nTest", "aTest", "ptest"} <= set(said["data"])
    assert (said["number"], said["array"]) == (7.5, [4.0, 5.0, 6.0])
    assert said["jointtarget"] == pytest.approx([1, 2, 3, 4, 5, 6])
    assert "no value" in said["refused"]
    assert (said["signals"], said["speed"]) == ([1, 2.5], 50.0)
    assert (said["queue"], said["message"]) == ([True, False], "num;5")
    assert set(said["events"]) >= {
        "ControllerState",
        "EventLogEntryEvent",
        "IpcMessage",
        "RAPIDExecutionState",
        "Signal",
        "VariableValue",
    }
    assert "at the station left" in said["log"]


EGM = """
import json, sys
from abb_robot_client.egm import EGM

egm = EGM(int(sys.argv[1]))
said = {"count": 0}
print("ready", flush=True)
for _ in range(2000):
    ok, state = egm.receive_from_robot(timeout=30)
    assert ok
    said["count"] += 1
    said["joints"] = list(state.joint_angles)
    said["planned"] = list(state.joint_angles_planned)
    said["motors"], said["running"] = bool(state.motors_on), bool(state.rapid_running)
    said["pose"] = list(state.cartesian[0]) + list(state.cartesian[1])
    said["number"] = state.robot_message.header.seqno
    if said["count"] > 5 and abs(said["joints"][0] - 12.5) < 1e-6:
        break
    egm.send_to_robot([12.5, 0, 0, 0, 30, 0])
egm.close()
print(json.dumps(said))
"""


def test_abb_robot_client_guides_the_robot(client_environment: ClientEnvironment, tmp_path: Path) -> None:
    python = client_environment("abb-robot-client", ["abb-robot-client==0.4.0"])
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with served("abb", tmp_path, SAMPLE, "--robot", "abb_irb120_3_58", "--port", f"egm={port}"):
        said = run_client(python, EGM, port)
    assert said["joints"] == pytest.approx([12.5, 0, 0, 0, 30, 0])
    assert said["planned"] == said["joints"]
    assert (said["motors"], said["running"]) == (True, False)
    assert sum(part**2 for part in said["pose"][3:]) == pytest.approx(1.0)


UIS = """
import json, sys
from rwsuis import RWS

r = RWS.RWS(sys.argv[1], "Default User", "robot")
said = {}
r.request_mastership()
said["set"] = r.set_rapid_variable("nTest", 7).status_code
said["number"] = r.get_rapid_variable("nTest")
r.release_mastership()
r.set_rapid_array("aTest", [7, 8, 9])
said["array"] = r.get_rapid_variable("aTest")
r.set_robtarget_translation("ptest", [1, 2, 3])
r.set_robtarget_rotation_z_degrees("ptest", 90)
said["target"] = r.get_robtarget_variables("ptest")
r.set_zonedata("zTest", 20)
r.set_speeddata("vTest", 250)
said["data"] = [r.get_rapid_variable("zTest"), r.get_rapid_variable("vTest")]
r.request_rmmp()
r.cancel_rmmp()
r.motors_off()
said["off"] = r.get_controller_state()
r.motors_on()
said["on"] = [r.get_controller_state(), r.get_operation_mode()]
r.set_speed_ratio(30)
r.start_RAPID()
said["runs"] = r.is_running()
r.stop_RAPID()
said["stands"] = r.is_running()
said["gripper"] = r.get_gripper_position()
print()
print(json.dumps(said))
"""


def test_rwsuis(client_environment: ClientEnvironment, controller: Served) -> None:
    python = client_environment("rwsuis", ["rwsuis==0.2"])
    said = run_client(python, UIS, f"http://{controller.host}:{controller.ports['rws']}")
    assert (said["set"], said["number"], said["array"]) == (204, "7", "[7,8,9]")
    assert said["target"][0] == [1, 2, 3]
    assert said["target"][1] == pytest.approx([0, 0.5**0.5, 0.5**0.5, 0], abs=1e-5)  # the tool looks down
    assert said["data"] == ["[FALSE,20,30,30,3,30,3]", "[250,500,5000,1000]"]
    assert (said["off"], said["on"]) == ("motoroff", ["motoron", "AUTO"])
    assert (said["runs"], said["stands"]) == (True, False)


WRAP = """
import json, sys, urllib3
from rwswrap.RWS import RWS

urllib3.disable_warnings()
r = RWS(sys.argv[1], "Default User", "robot", module="tmod")
said = {}
said["modules"] = r.get_modules()
r.set_rapid_variable("nTest", 9, module="tmod")
said["number"] = r.get_rapid_variable("nTest", module="tmod")
said["loaded"] = r.load_module("extra", path="$HOME/").status_code
said["after"] = r.get_modules()
said["reset"] = r.reset_pp().status_code
print()
print(json.dumps(said))
"""


def test_rwswrap(client_environment: ClientEnvironment, tmp_path: Path) -> None:
    python = client_environment("rwswrap", ["rwswrap==0.1.0", "requests"])
    (tmp_path / "tmod.mod").write_text(DATA, encoding="latin-1")
    (tmp_path / "extra.modx").write_text("MODULE extra\n  PERS num nExtra:=1;\nENDMODULE\n", encoding="utf-8")
    files = (SAMPLE, tmp_path / "tmod.mod", tmp_path / "extra.modx")
    with served("abb", tmp_path, *files) as controller:
        said = run_client(python, WRAP, f"https://{controller.host}:{controller.ports['rws2']}")
    assert "tmod" in said["modules"]
    assert said["number"] == "9"
    assert said["loaded"] == 200
    assert "extra" in said["after"]
    assert said["reset"] == 204
