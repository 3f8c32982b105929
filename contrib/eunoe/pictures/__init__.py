"""Which command makes which picture of the documentation, and what made those that are there."""
