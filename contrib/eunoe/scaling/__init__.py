"""Predicts how a case would be divided among many ranks, and the cost of its steps."""
