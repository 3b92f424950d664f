"""Summarize an added or removed build file in one line."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.review.files.build.facts import BUILT_KINDS, INSTALLED_KINDS, BuildFacts, FactKind, list_names

_SHOWN_KINDS = (
    *(FactKind.EXECUTABLE, FactKind.LIBRARY, *BUILT_KINDS, FactKind.COMPONENT, FactKind.PLUGIN_DESCRIPTION),
    *(FactKind.INTERFACE, FactKind.MODULE, FactKind.ENTRY_POINT, FactKind.TEST),
)


def build_contents(facts: BuildFacts) -> Phrase | None:
    """Return the installed targets, files and tests of a build file; None if there are none."""
    parts = list(_list_content_parts(facts))
    return joined(parts, "; ") if parts else None


def _list_content_parts(facts: BuildFacts) -> Iterator[Phrase]:
    installed = {fact.name for fact in facts.facts if fact.kind in INSTALLED_KINDS}
    for kind in _SHOWN_KINDS:
        hidden_names = installed if kind in BUILT_KINDS else ()
        names = list(dict.fromkeys(fact.name for fact in facts.facts if fact.kind is kind))
        names = [name for name in names if name not in hidden_names]
        if names:
            yield phrase("{kind} {names}", kind=kind.title, names=list_names(names))
    folders = list(dict.fromkeys(f"{PurePosixPath(target).parent}/" for target in facts.files))
    if folders:
        yield phrase("files in {names}", names=list_names(folders))
