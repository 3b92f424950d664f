"""The README as a package index shows it, where files of the repository have no address.

Usage: python tools/package_readme.py (prints it)
"""

from __future__ import annotations

import re
from pathlib import Path

README = Path(__file__).resolve().parent.parent / "README.md"

_PICTURE = re.compile(r"^!\[[^\]]*\]\((?!https:)[^)]*\)\n\n", re.MULTILINE)
_LINK = re.compile(r"\[(!\[[^\]]*\]\([^)]*\)|[^\[\]]+)\]\((?!https:)[^)]*\)")


def without_relative_links(text: str) -> str:
    """Markdown whose links lead somewhere from anywhere: of relative ones the words stay, relative pictures go."""
    return _LINK.sub(r"\1", _PICTURE.sub("", text))


if __name__ == "__main__":
    print(without_relative_links(README.read_text(encoding="utf-8")), end="")
