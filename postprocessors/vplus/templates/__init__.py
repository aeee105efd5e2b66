"""Frame of V+ files; a package so that the wheel holds it."""
