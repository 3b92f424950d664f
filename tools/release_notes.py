"""The section of a version in CHANGELOG.md: taking it out for a release, and beginning it.

Usage: python tools/release_notes.py [VERSION] (prints it; without a version, what is unreleased)
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

CHANGELOG = Path(__file__).resolve().parent.parent / "CHANGELOG.md"
UNRELEASED = "Unreleased"
_HEADING = re.compile(r"^## \[(?P<name>[^\]]+)\](?: - \d{4}-\d{2}-\d{2})?$", re.MULTILINE)
_VERSION = re.compile(r"(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)", re.ASCII)


def sections(text: str) -> dict[str, str]:
    """What a changelog says about each version, by what stands in the heading's brackets."""
    found = list(_HEADING.finditer(text))
    ends = [heading.start() for heading in found[1:]] + [len(text)]
    return {heading["name"]: text[heading.end() : end].strip() for heading, end in zip(found, ends, strict=True)}


def section(text: str, version: str) -> tuple[str, str]:
    """Whose section it is, and what a changelog says about a version; as long as it has no section, what is unreleased.

    Raises:
        SystemExit: when there is nothing about it.
    """
    all_sections = sections(text)
    title = version if version in all_sections else UNRELEASED
    if not all_sections.get(title):
        raise SystemExit(f"{CHANGELOG.name} has nothing about {version}, and nothing unreleased")
    return title, f"# Linkwright {version}\n\n{all_sections[title]}\n"


def begun(text: str, version: str, date: str, before: str) -> str:
    """The changelog in which the unreleased changes are those of a version, made on a date such as ``2026-11-22``.

    Raises:
        SystemExit: when that is no version, or older than the one `before`, or has a section; or nothing is unreleased.
    """
    new, old = _VERSION.fullmatch(version), _VERSION.fullmatch(before)
    if not new:
        raise SystemExit(f"'{version}' is not a version; give one such as 0.2.0")
    if old and [int(part) for part in new.groups()] < [int(part) for part in old.groups()]:
        raise SystemExit(f"{version} is older than {before}, the version that there is")
    known = sections(text)
    if version in known:
        raise SystemExit(f"{CHANGELOG.name} has a section about {version} already")
    if not known.get(UNRELEASED):
        raise SystemExit(f"{CHANGELOG.name} has nothing under [{UNRELEASED}]")
    return text.replace(f"## [{UNRELEASED}]\n", f"## [{UNRELEASED}]\n\n## [{version}] - {date}\n", 1)


if __name__ == "__main__":
    print(section(CHANGELOG.read_text(encoding="utf-8"), *(sys.argv[1:] or [UNRELEASED]))[1], end="")
