"""A cell at work: several robots with their programs and the bodies around them, run together; what came of it."""
