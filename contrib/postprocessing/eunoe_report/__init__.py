"""Pages about runs and studies, with their figures."""

import sys

try:
    import matplotlib  # noqa: F401
    import numpy  # noqa: F401
except ImportError as error:
    sys.exit(f"{sys.executable} has no {error.name}: install python3-numpy and "
             "python3-matplotlib, and run this script with Debian's /usr/bin/python3.")
