"""A file that a package installs, whatever its build file is."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

_PLACEHOLDER = re.compile(r"@(\w+)@|\$\{(\w+)\}")


@dataclass(frozen=True, slots=True)
class InstalledFile:
    """A file that is installed.

    Attributes:
        source: relative to the package.
        destination: relative to the prefix.
        values: of the placeholders in it, where ``configure_file`` fills them in; None where it is copied as it is.
    """

    source: str
    destination: str
    values: Mapping[str, str] | None = None

    def text(self, package: Path) -> str:
        """What is in the file that ``configure_file`` makes of it.

        Raises:
            OSError: it cannot be read.
        """
        values = self.values or {}
        text = (package / self.source).read_text(encoding="utf-8", errors="replace")
        return _PLACEHOLDER.sub(lambda match: values.get(match[1] or match[2], ""), text)
