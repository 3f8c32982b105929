"""Pages that are made of what the programs say of themselves."""
