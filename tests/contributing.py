"""What CONTRIBUTING.md shows, for the tests that compile it."""

from __future__ import annotations

import re
from pathlib import Path

PAGE = Path(__file__).resolve().parents[1] / "CONTRIBUTING.md"
# Asks for the observable of the page at every step, on two grains.
CENTRE_OF_MASS = """
subsection mesh
  set grid type = subdivided_hyper_rectangle
  set grid arguments = 2, 2, 2 : -0.01, -0.01, -0.01 : 0.01, 0.01, 0.01 : true
end
subsection insertion info
  set insertion method = list
  set list diameters = 1e-3, 2e-3
end
subsection post-processing
  subsection centre of mass
    set calculation = true
    set output frequency = 1
  end
end
"""


def shown_files() -> dict[str, str]:
    """The files that the page adds, by name, each of which it shows as a whole."""
    text = PAGE.read_text(encoding="utf-8")
    files = dict(re.findall(r"`([\w/]+\.cc)`:\s+```cpp\n(.*?)^```$", text, re.M | re.S))
    # The code block of a test is indented, as it belongs to a list, and is not counted.
    assert len(files) == len(re.findall(r"^```cpp$", text, re.M)) == 3, "three additions, each one file"
    return files
