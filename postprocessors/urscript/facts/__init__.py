"""What the writer of URScript asks about a whole program: each question answered once, in front of writing."""
