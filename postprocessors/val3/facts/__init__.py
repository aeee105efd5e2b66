"""What the writer of VAL3 asks about a whole program: each question answered once, in front of writing."""
