"""What the writer of V+ asks about a whole program: each question answered once, in front of writing."""
