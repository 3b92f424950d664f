"""A file that a package installs, whatever its build file is."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from linkwright.lean_dataclasses import NamedTuple

_PLACEHOLDER = r"@(\w+)@|\$\{(\w+)\}"


class InstalledFile(NamedTuple):
    """A file that is installed.

    Attributes:
        source: relative to the package.
        destination: relative to the prefix.
        values: of the placeholders in it, where ``configure_file`` fills them in; None where it is copied as it is.
        content: what is in it, where the build writes it; None where it is made of its source.
    """

    source: str
    destination: str
    values: Mapping[str, str] | None = None
    content: str | None = None

    @property
    def is_made(self) -> bool:
        """Whether the build makes it, so that it is no copy of its source."""
        return self.values is not None or self.content is not None

    def text(self, package: Path) -> str:
        """What is in a file that the build makes.

        Raises:
            OSError: its source cannot be read.
        """
        if self.content is not None:
            return self.content
        values = self.values or {}
        text = (package / self.source).read_text(encoding="utf-8", errors="replace")
        return re.sub(_PLACEHOLDER, lambda match: values.get(match[1] or match[2], ""), text)
