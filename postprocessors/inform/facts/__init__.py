"""What the writer of INFORM asks about a whole program: each question answered once, in front of writing."""
