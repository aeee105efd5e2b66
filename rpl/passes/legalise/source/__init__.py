"""What only the source's language has: marks of its editor, names of its own for neutral things, its units, forms of
places, texts and settings.
"""
