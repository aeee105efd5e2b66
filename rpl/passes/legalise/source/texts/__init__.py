"""The source's formats and orders of texts in neutral functions."""
