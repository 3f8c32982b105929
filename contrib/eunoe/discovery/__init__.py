"""Blind suites for eunoe-discovery: twins with hidden truths, and scores of how well the truths
were found."""
