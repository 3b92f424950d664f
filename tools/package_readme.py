"""Write the README for a package index.

There, files of the repository have no address, and no checkout is needed.

Usage: python tools/package_readme.py (prints it)
"""

from __future__ import annotations

import re
from pathlib import Path

README = Path(__file__).resolve().parent.parent / "README.md"

_PICTURE = re.compile(r"^!\[[^\]]*\]\((?!https:)[^)]*\)\n\n", re.MULTILINE)
_LINK = re.compile(r"\[(!\[[^\]]*\]\([^)]*\)|[^\[\]]+)\]\((?!https:)[^)]*\)")


_CHECKOUT_PHRASES = (
    (re.compile(r" +# in a checkout of this repository$", re.MULTILINE), ""),
    (re.compile(r"\binstall \.(?=[`\n])"), "install linkwright"),
    (re.compile(r"\binstall '\.\["), "install 'linkwright["),
    (re.compile(r" No version is on a package index yet\."), ""),
)


def make_package_readme() -> str:
    """Return the README of the repository in the form for a package index."""
    text = remove_relative_links(README.read_text(encoding="utf-8"))
    for pattern, words in _CHECKOUT_PHRASES:
        text = pattern.sub(words, text)
    return text


def remove_relative_links(text: str) -> str:
    """Return Markdown without relative links, whose words remain, and without relative images."""
    return _LINK.sub(r"\1", _PICTURE.sub("", text))


if __name__ == "__main__":
    print(make_package_readme(), end="")
