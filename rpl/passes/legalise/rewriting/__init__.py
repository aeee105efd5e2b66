"""How a pass rewrites: statements, expressions, routines brought along, names and temporaries."""
