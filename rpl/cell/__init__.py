"""The world around the robot: for now what a `cell.toml` says of signals, data, the operator and vendor statements."""

from rpl.cell.cellfile import Answer, Cell, Input, Reaction, RoutineMeaning, VendorMeaning, parse_cell, read_cell

__all__ = ["Answer", "Cell", "Input", "Reaction", "RoutineMeaning", "VendorMeaning", "parse_cell", "read_cell"]
