"""Lethe's own inputs, run as they are."""
