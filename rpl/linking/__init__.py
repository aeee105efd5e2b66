"""IR to flat instructions with explicit frames and a program counter, routine by routine when first called."""

from rpl.linking.program import LinkedProgram, link

__all__ = ["LinkedProgram", "link"]
