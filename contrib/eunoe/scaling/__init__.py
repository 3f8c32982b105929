"""How a case would be shared out over many ranks, and what its steps would take."""
