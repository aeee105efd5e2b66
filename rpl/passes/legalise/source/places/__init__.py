"""The source's own notations of places: pulses, rotation vectors, displacements, home positions."""
