"""The records of the files and programs that a package installs.

They are the same for all kinds of build files.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple

_PLACEHOLDER = r"@(\w+)@|\$\{(\w+)\}"


class InstalledFile(NamedTuple):
    """A file that is installed.

    Attributes:
        source: the source path, relative to the package.
        destination: the installed path, relative to the prefix.
        values: the values of placeholders that ``configure_file`` replaces; None if the file is copied unchanged.
        content: the content that the build writes; None if the file is copied or generated from its source.
    """

    source: str
    destination: str
    values: Mapping[str, str] | None = None
    content: str | None = None

    @property
    def is_generated(self) -> bool:
        """Whether the build generates the file instead of copying its source."""
        return self.values is not None or self.content is not None

    def text(self, package: Path) -> str:
        """Return the content of a file that the build generates.

        Raises:
            OSError: the source of the file cannot be read.
        """
        if self.content is not None:
            return self.content
        values = self.values or {}
        text = (package / self.source).read_text(encoding="utf-8", errors="replace")
        return re.sub(_PLACEHOLDER, lambda match: values.get(match[1] or match[2], ""), text)


PROGRAM_GROUP = "console_scripts"
"""The group of the programs that a package installs."""

ENTRY_POINT_LINE = lazy_pattern(r"\s*([^\s=]+)\s*=\s*([\w.]+)\s*(?::\s*([\w.]+))?")
"""The name and module of an entry point, and its attribute if there is one."""


class EntryPoint(NamedTuple):
    """A function that serves as a program.

    Attributes:
        module: the full name of the function's module.
        function: the name of the function in the module, which may contain dots.
    """

    module: str
    function: str

    def __str__(self) -> str:
        return f"{self.module}:{self.function}"
