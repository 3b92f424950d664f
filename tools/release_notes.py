"""Extract the section of a version from CHANGELOG.md, or begin a new section.

Usage: python tools/release_notes.py [VERSION] (prints the section, or without a version the unreleased changes)
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

CHANGELOG = Path(__file__).resolve().parent.parent / "CHANGELOG.md"
UNRELEASED = "Unreleased"
_HEADING = re.compile(r"^## \[(?P<name>[^\]]+)\](?: - \d{4}-\d{2}-\d{2})?$", re.MULTILINE)
_VERSION = re.compile(r"(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)", re.ASCII)


def split_sections(text: str) -> dict[str, str]:
    """Return the sections of a changelog, by the text in the brackets of their headings."""
    headings = list(_HEADING.finditer(text))
    ends = [heading.start() for heading in headings[1:]] + [len(text)]
    return {heading["name"]: text[heading.end() : end].strip() for heading, end in zip(headings, ends, strict=True)}


def find_section(text: str, version: str) -> tuple[str, str]:
    """Return the name and text of a version's section, or else of the unreleased changes.

    Raises:
        SystemExit: the section does not exist or is empty.
    """
    all_sections = split_sections(text)
    title = version if version in all_sections else UNRELEASED
    if not all_sections.get(title):
        raise SystemExit(f"{CHANGELOG.name} has nothing about {version}, and nothing unreleased")
    return title, f"# Linkwright {version}\n\n{all_sections[title]}\n"


def begin_section(text: str, version: str, date: str, before: str) -> str:
    """Return a changelog in which the unreleased changes become a version with a date.

    Raises:
        SystemExit: the version is not valid, is older than `before`, or has a section; or there are no unreleased
            changes.
    """
    new, old = _VERSION.fullmatch(version), _VERSION.fullmatch(before)
    if not new:
        raise SystemExit(f"'{version}' is not a version; give one such as 0.2.0")
    if old and [int(part) for part in new.groups()] < [int(part) for part in old.groups()]:
        raise SystemExit(f"{version} is older than {before}, the version that there is")
    known = split_sections(text)
    if version in known:
        raise SystemExit(f"{CHANGELOG.name} has a section about {version} already")
    if not known.get(UNRELEASED):
        raise SystemExit(f"{CHANGELOG.name} has nothing under [{UNRELEASED}]")
    return text.replace(f"## [{UNRELEASED}]\n", f"## [{UNRELEASED}]\n\n## [{version}] - {date}\n", 1)


if __name__ == "__main__":
    print(find_section(CHANGELOG.read_text(encoding="utf-8"), *(sys.argv[1:] or [UNRELEASED]))[1], end="")
