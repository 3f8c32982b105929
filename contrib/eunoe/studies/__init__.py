"""Studies: series of runs and the tables that are made of them."""
