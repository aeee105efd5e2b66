"""IR to IR: names to declarations, types, rewriting for what a target lacks. Pure functions; no node is mutated."""
