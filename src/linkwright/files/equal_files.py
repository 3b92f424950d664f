"""Pair the old and new paths of renamed files whose old contents are equal."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import SequenceMatcher
from pathlib import PurePosixPath

_MAX_FILES = 32
"""The maximum number of equal files that are paired by their paths; git pairs more of them."""


def pair_paths(old_paths: Sequence[str], new_paths: Sequence[str]) -> dict[str, str]:
    """Return the old path of each new path, the most similar paths first.

    Args:
        old_paths: the paths of files with equal contents.
        new_paths: the new paths of some of them.
    """
    if len(old_paths) > _MAX_FILES:
        return {}
    scores = sorted(
        ((-_compute_similarity(old, new), i, k) for i, old in enumerate(old_paths) for k, new in enumerate(new_paths)),
    )
    pairs: dict[str, str] = {}
    for _, i, k in scores:
        if new_paths[k] not in pairs and old_paths[i] not in pairs.values():
            pairs[new_paths[k]] = old_paths[i]
    return pairs


def _compute_similarity(old: str, new: str) -> float:
    """Return the similarity of two paths. An equal file name counts more than the folders."""
    has_equal_name = PurePosixPath(old).name == PurePosixPath(new).name
    return has_equal_name + SequenceMatcher(None, old, new, autojunk=False).ratio()
