"""Universal Robots URScript as a target: the record that the registry finds."""

from rpl.registry import Target

TARGET = Target(__name__, "Universal Robots URScript", encodings=("ascii",))
