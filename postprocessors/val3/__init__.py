"""Staubli VAL3 as a target: the record that the registry finds."""

from rpl.registry import Target

TARGET = Target(__name__, "Staubli VAL3")
