"""Texts, messages and dialogues within the target's lengths and functions."""
