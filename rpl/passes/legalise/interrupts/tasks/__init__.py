"""Tasks once more: those that interrupts have become, kept apart from each other."""
