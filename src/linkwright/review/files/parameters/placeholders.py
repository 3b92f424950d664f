"""Find placeholders of YAML templates, such as ``${NAME}``, that only have another name."""

from __future__ import annotations

import re

from linkwright.review.versions import Versions

_PLACEHOLDER = re.compile(r"\$\{(?P<name>[A-Za-z_]\w*)\}")
_PROGRAM_SUFFIXES = (".py", ".launch", ".xml", ".sh")


def find_renamed_placeholder(old: str, new: str, versions: Versions) -> tuple[str, str] | None:
    """Return the old and the new name of the only placeholder with another name, or None.

    A program or launch file of the repository must fill in the new one, and none the old one.

    Args:
        old: the text of the old version.
        new: the text of the new version.
        versions: both versions of the repository.
    """
    old_names, new_names = ({match["name"] for match in _PLACEHOLDER.finditer(text)} for text in (old, new))
    lost, gained = old_names - new_names, new_names - old_names
    if len(lost) != 1 or len(gained) != 1:
        return None
    (old_name,), (new_name,) = lost, gained
    words = [re.compile(rf"(?<!\w){name}(?!\w)") for name in (old_name, new_name)]
    texts = [versions.new.text(path) for path in versions.new.paths(_PROGRAM_SUFFIXES)]
    is_old_used, is_new_used = (any(word.search(text) for text in texts) for word in words)
    return (old_name, new_name) if is_new_used and not is_old_used else None


def rename_placeholder(text: str, old: str, new: str) -> str:
    """Return a text with another name of a placeholder."""
    return text.replace(f"${{{old}}}", f"${{{new}}}")
