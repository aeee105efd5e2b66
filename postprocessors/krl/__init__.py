"""KUKA KRL as a target: the record that the registry finds."""

from rpl.registry import Target

TARGET = Target(__name__, "KUKA KRL", encodings=("cp1252", "utf-8"))
