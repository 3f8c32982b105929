"""Tools around Eunoe's programs, in Python: reports, benchmarks, studies, verification. The commands are listed
in commands.py."""
