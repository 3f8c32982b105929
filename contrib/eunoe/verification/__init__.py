"""Runs the cases of prm/verification and compares their results with references."""
