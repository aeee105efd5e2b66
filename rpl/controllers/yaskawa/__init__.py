"""Controllers of Yaskawa: files and state by the High-Speed Ethernet Server, `yaskawa://10.0.0.5`.

What is known of it, and from where: the layout of all packets, the commands and the words of the errors are those of
the manual 160766-1CD (FS100 options, instructions for High-Speed Ethernet Server function) as the MIT sources of
moto-hses and of hsinkoyu/fs100 give it; controllers of the lines DX200 and YRC1000 are said to speak the same. Names of
jobs (32 characters, 8 on controllers before the DX100) and what of a job's head the controller writes anew are general
knowledge that no manual was at hand for. Nobody has tried this on a controller of iron; hsinkoyu/fs100 passes against
the virtual one (files, status, position, jobs, variables one by one and several at once; tried by hand, because it is
not to be had from PyPI), but for torque, position error, alarm history and management time, which it does not have.
"""

import re

from rpl.controllers.rules import SendingRules
from rpl.controllers.vendors import Vendor

_WRITTEN_BY_THE_CONTROLLER = re.compile(rb"(?m)^///DATE [^\r\n]*")
_LINE_ENDS = re.compile(rb"\r\n?")


def same_job(name: str, sent: bytes, found: bytes) -> bool:
    """The same job but for the date of its last change, which the controller writes, and the ends of lines."""
    return _without_date(sent) == _without_date(found)


def _without_date(job: bytes) -> bytes:
    return _LINE_ENDS.sub(b"\n", _WRITTEN_BY_THE_CONTROLLER.sub(b"///DATE", job)).rstrip(b"\n")


VENDOR = Vendor(
    package=__name__,
    title="Yaskawa (High-Speed Ethernet Server)",
    ports={"files": 10041, "robot": 10040, "ftp": 21},
    path="",
    rules=SendingRules(
        programs=("*.jbi",),
        # Parameters, system data and lists (the ladder program and the names of signals among them); condition files
        # and variables are data that people set at the controller. Kinds of files: manual 160766-1CD, file list.
        denied=("*.prm", "*.sys", "*.lst", "*.cnd", "*.dat", "*.bin", "*.lad"),
        # M: which characters a pendant gives.
        name=r"[^\x00-\x20\x7f.,;:*?\"'<>|/\\]{1,32}",
        names="up to 32 characters, no space and none of . , ; : * ? \" ' < > | / \\",
        flat=True,
        encoding="ascii",
        line_ends="crlf",
        same=same_job,
    ),
    dialect="inform",
    options={"name_length": "the longest name of a job: 32, or 8 on older controllers"},
)
