"""RPL as a target: every node of the IR has its text, so it refuses nothing."""

from rpl.registry import Target

TARGET = Target(
    __name__,
    "RPL, the universal robot programming language",
    options={"files": "`program` (the default): one file for all modules; `module`: one for each"},
)
