"""Frame of TP listings; a package so that the wheel holds it."""
