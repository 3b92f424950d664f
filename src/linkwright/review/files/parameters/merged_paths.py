"""Merge equal changes to several elements whose paths differ in one word."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

_MAX_WORDS = 3
"""The maximum number of differing words that are shown."""


class MergedPaths:
    """Paths of equal changes, such as changes to the same limit of several joints."""

    def __init__(self) -> None:
        self._words: list[list[str]] = []
        self._positions: list[int | None] = []
        self._other_words: list[list[str]] = []
        self._groups: dict[tuple[tuple[str, ...], int, Hashable], int] = {}

    def add(self, path: str, change: Hashable) -> int:
        """Add a path, and return the index of its group.

        Args:
            path: the path of the changed element.
            change: a key that is equal for all changes of a group.
        """
        words = path.split(" ")
        patterns = [
            ((*words[:position], "", *words[position + 1 :]), position, change) for position in range(len(words))
        ]
        for pattern in patterns:
            group = self._groups.get(pattern)
            if group is not None and self._positions[group] in (None, pattern[1]):
                self._positions[group] = pattern[1]
                self._other_words[group].append(words[pattern[1]])
                return group
        group = len(self._words)
        self._words.append(words)
        self._positions.append(None)
        self._other_words.append([])
        for pattern in patterns:
            self._groups.setdefault(pattern, group)
        return group

    @property
    def paths(self) -> Sequence[str]:
        """The first path of each group, with the differing words of the other paths."""
        return [
            self._format_path(*parts) for parts in zip(self._words, self._positions, self._other_words, strict=True)
        ]

    def _format_path(self, words: Sequence[str], position: int | None, other_words: Sequence[str]) -> str:
        if position is None:
            return " ".join(words)
        names = [words[position], *other_words]
        text = ", ".join(names[:_MAX_WORDS])
        if len(names) > _MAX_WORDS:
            text = f"{text}, ... ({len(names)})"
        return " ".join([*words[:position], text, *words[position + 1 :]])


_NAMED_TAGS = frozenset(
    {"world", "model", "include", "link", "joint", "visual", "collision", "sensor", "light", "plugin", "frame", "actor"}
)
"""The tags of elements with names."""


def to_path_pattern(path: str) -> tuple[str, ...]:
    """Return the words of a path, with empty strings for the names of elements.

    Equal changes with equal patterns belong together, such as those of the visuals of all links.
    """
    pattern: list[str] = []
    is_name = False
    for word in path.split(" "):
        pattern.append("" if is_name else word)
        is_name = not is_name and word in _NAMED_TAGS
    return tuple(pattern)


def trim_common_words(paths: Sequence[str]) -> list[str]:
    """Return paths of equal length without their common first and last words."""
    rows = [path.split(" ") for path in paths]
    columns = list(zip(*rows, strict=True))
    positions = [position for position, words in enumerate(columns) if len(set(words)) > 1]
    if not positions:
        return list(paths)
    return [" ".join(words[positions[0] : positions[-1] + 1]) for words in rows]
