"""Adept/Omron V+ as a target: the record that the registry finds."""

from rpl.registry import Target

TARGET = Target(__name__, "Adept V+")
