"""IR to text: expression printing, number style, names, layout, the emission ledger. Templates live with the targets."""
