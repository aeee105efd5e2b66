"""Reading one statement at a time: split, parse by shape, lower, assemble blocks, account for every piece of text."""
