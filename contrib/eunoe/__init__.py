"""Tools around Eunoe's programs, in Python: reports, benchmarks, studies, verification. commands.py
lists the commands."""
