"""What the writer of TP asks about a whole program: each question answered once, in front of writing."""
