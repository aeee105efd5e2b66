"""py-openshowvar, unchanged, against `rpl serve kuka`."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.clients.conftest import ClientEnvironment
from tests.clients.running import run_client
from tests.controllers.serving import served

pytestmark = pytest.mark.clients
SAMPLE = Path(__file__).parents[2] / "samples/krl/machine_tending"

CLIENT = """
import json, sys
from py_openshowvar import openshowvar
client = openshowvar(sys.argv[1], int(sys.argv[2]))
can = client.can_connect
def read(name):
    found = client.read(name, debug=False)
    return None if found is None else found.decode()
names = ("$AXIS_ACT", "$POS_ACT", "$OV_PRO", "$MODE_OP", "$ROBNAME[]", "$IN[1]", "$PRO_STATE1", "NOTHING")
first = {name: read(name) for name in names}
client.write("$OV_PRO", "40", debug=False)
client.write("$OUT[3]", "TRUE", debug=False)
refused = client.write("$IN[1]", "TRUE", debug=False)
print(json.dumps({"can": can, "first": first, "refused": refused, "then": [read("$OV_PRO"), read("$OUT[3]")]}))
client.close()
"""


def test_py_openshowvar_reads_and_writes(client_environment: ClientEnvironment, tmp_path: Path) -> None:
    python = client_environment("kuka", ["py-openshowvar==1.1.7"])
    with served("kuka", tmp_path, SAMPLE, "--robot", "kuka_kr6r900sixx") as here:
        found = run_client(python, CLIENT, here.host, here.ports["c3"])
        assert found["can"] is True
        assert found["first"]["$AXIS_ACT"].startswith("{E6AXIS: A1 0.00000, A2 -90.00000")
        assert found["first"]["$POS_ACT"].startswith("{E6POS: X 525.00000")
        assert found["first"]["$MODE_OP"] == "#EX" and found["first"]["$PRO_STATE1"] == "#P_FREE"
        assert found["first"]["NOTHING"] is None, "py-openshowvar gives nothing for a name that is not there"
        assert found["refused"] is None
        assert found["then"] == ["40", "TRUE"]
        assert "Traceback" not in here.stop()
