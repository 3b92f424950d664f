"""A file that a package installs, whatever its build file is."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from linkwright.loading.lean_dataclasses import NamedTuple

_PLACEHOLDER = r"@(\w+)@|\$\{(\w+)\}"


class InstalledFile(NamedTuple):
    """A file that is installed.

    Attributes:
        source: relative to the package.
        destination: relative to the prefix.
        values: of the placeholders in it, if ``configure_file`` fills them in; None if it is copied as it is.
        content: its content, if the build writes it; None if it is made from its source.
    """

    source: str
    destination: str
    values: Mapping[str, str] | None = None
    content: str | None = None

    @property
    def is_made(self) -> bool:
        """Whether the build makes it instead of copying its source."""
        return self.values is not None or self.content is not None

    def text(self, package: Path) -> str:
        """The content of a file that the build makes.

        Raises:
            OSError: its source cannot be read.
        """
        if self.content is not None:
            return self.content
        values = self.values or {}
        text = (package / self.source).read_text(encoding="utf-8", errors="replace")
        return re.sub(_PLACEHOLDER, lambda match: values.get(match[1] or match[2], ""), text)
