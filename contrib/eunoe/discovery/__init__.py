"""Blind suites for eunoe-discovery: twins with hidden truths, and how well the truths were found."""
