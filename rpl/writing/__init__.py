"""IR to text: expressions, numbers, names, layout, the emission ledger. Templates live with the targets."""
