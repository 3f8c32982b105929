"""Where the campaign's small results and its page are in the repository."""

from __future__ import annotations

from eunoe.repository import DOC

DATA = DOC / "reproduction" / "data"
PAGE = DOC / "reproduction.md"
