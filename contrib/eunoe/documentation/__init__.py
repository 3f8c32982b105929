"""Pages that are generated from the programs' own descriptions."""
