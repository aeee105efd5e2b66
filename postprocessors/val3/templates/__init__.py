"""Templates of this target; a package so that they are part of every installation."""
