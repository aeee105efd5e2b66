"""One TOML per arm: plain data, read by `rpl.emulator.robotfile`. Numbers nobody verified are marked in their file."""
