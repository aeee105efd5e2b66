"""One Lark grammar per language: syntax, nothing else."""
