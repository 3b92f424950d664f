"""Find worlds, behavior trees and plugin descriptions that name what no source registers any more."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import partial

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.sources.names import CPP_SUFFIXES, Detail, NameKind
from linkwright.review.sources.reading import read_source_names
from linkwright.review.versions import Version, Versions

_WORLD_SUFFIXES = (".sdf", ".world", ".urdf", ".xacro", ".gazebo", ".sdf.jinja")
_XML_SUFFIX = ".xml"
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_DECLARATION = re.compile(r"<class\b[^>]*>")
_ATTRIBUTE = re.compile(r"\b(\w+)\s*=\s*[\"']([^\"']*)[\"']")
_TREE_FILE = re.compile(r"<BehaviorTree\b")
_SCOPE = "::"


def find_lost_registrations(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files that still name a plugin or node which a changed source no longer registers, with the changes.

    Names that any other source of the repository mentions are left out, because it may register them in another way.
    """
    old, new = (
        _read_names(version, [path for path in paths if path is not None and path.endswith(CPP_SUFFIXES)])
        for version, paths in (
            (versions.old, [file.old_path for file in changed_files if not file.is_submodule]),
            (versions.new, [file.new_path for file in changed_files if not file.is_submodule]),
        )
    )
    lost = {kind: set(names) - set(new[kind]) for kind, names in old.items() if set(names) - set(new[kind])}
    lost_bases = _find_lost_bases(old[NameKind.PLUGINLIB_CLASS], new[NameKind.PLUGINLIB_CLASS])
    if not lost and not lost_bases:
        return
    sources = [versions.new.text(path) for path in versions.new.paths(CPP_SUFFIXES)]
    mentions = partial(_mentions, sources)
    lost = {kind: {name for name in names if not mentions(name, kind)} for kind, names in lost.items()}
    lost_bases = {pair for pair in lost_bases if not _exports_for_base(sources, *pair)}
    for path in versions.new.paths((*_WORLD_SUFFIXES, _XML_SUFFIX)):
        text = versions.new.text(path)
        if any(name.rpartition(_SCOPE)[2] in text for names in (*lost.values(), dict(lost_bases)) for name in names):
            text = _COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
            yield from ((path, change) for change in _find_users(path, text, lost))
            yield from ((path, change) for change in _find_declarations(path, text, lost_bases))


def _read_names(version: Version, paths: Sequence[str]) -> dict[NameKind, dict[str, set[str]]]:
    """Return the registered names in sources by kind, each with the base classes for which it is exported."""
    names: dict[NameKind, dict[str, set[str]]] = {kind: {} for kind in _PATTERNS}
    for path in paths:
        source = read_source_names(version.file(path))
        for kind, known in names.items():
            for item in source.of_kind(kind):
                bases = dict(item.details).get(Detail.BASES, "")
                known.setdefault(item.name, set()).update(filter(None, bases.split(", ")))
    return names


def _find_lost_bases(old: Mapping[str, set[str]], new: Mapping[str, set[str]]) -> set[tuple[str, str]]:
    """Return the classes that are still exported, each with a base class for which it no longer is."""
    return {(name, base) for name, bases in old.items() if new.get(name) for base in bases - new[name]}


def _exports_for_base(texts: Sequence[str], name: str, base: str) -> bool:
    """Return whether a source may export a class for a base class, whatever their namespaces."""
    words = (re.escape(item.rpartition(_SCOPE)[2]) for item in (name, base))
    macro = re.compile(r"\b[A-Z][A-Z0-9_]+\s*\([^;{{}}]*\b{}\b[^;{{}}]*\b{}\b".format(*words))
    return any(macro.search(text) is not None for text in texts)


def _find_declarations(path: str, text: str, lost: Collection[tuple[str, str]]) -> Iterator[Change]:
    """Yield a change for each plugin that a file still declares for a base class for which it is not exported."""
    for match in _DECLARATION.finditer(text) if path.endswith(_XML_SUFFIX) else ():
        attributes = dict(_ATTRIBUTE.findall(match[0]))
        pair = attributes.get("type", "").strip(), attributes.get("base_class_type", "").strip()
        if pair in lost:
            line = text[: match.start()].count("\n") + 1
            message = phrase(
                "declares '{name}' for '{base}', for which no source exports it any more", name=pair[0], base=pair[1]
            )
            reason = phrase("programs that load the class fail")
            yield Change(message, Effect.BREAKING, reason, Location(path, line, 1))


def _mentions(texts: Sequence[str], name: str, kind: NameKind) -> bool:
    """Return whether a source may register a name.

    It has the name in quotation marks, or names the class in a macro and may be in its namespace.
    """
    scope, _, short = name.rpartition(_SCOPE)
    macro = re.compile(rf"\b[A-Z][A-Z0-9_]+\s*\([^;{{}}]*\b{re.escape(short)}\b")
    namespace = re.compile(rf"\bnamespace\s+(?:\w+::)*{re.escape(scope.rpartition(_SCOPE)[2])}\b")
    is_class = kind is not NameKind.TREE_NODE
    is_qualified = kind is NameKind.SIMULATION_PLUGIN and bool(scope)
    return any(
        f'"{name}"' in text
        or (is_class and macro.search(text) is not None and (not is_qualified or namespace.search(text) is not None))
        for text in texts
    )


def _find_users(path: str, text: str, lost: Mapping[NameKind, Collection[str]]) -> Iterator[Change]:
    """Yield a change for the first place in a file with each lost name."""
    for kind, names in lost.items():
        suffixes, pattern, reason = _PATTERNS[kind]
        if not path.endswith(suffixes) or (kind is NameKind.TREE_NODE and not _TREE_FILE.search(text)):
            continue
        for name in sorted(names):
            match = re.search(pattern.replace("NAME", re.escape(name)), text)
            if match is not None:
                line = text[: match.start()].count("\n") + 1
                message = phrase("names '{name}', which no source registers any more", name=name)
                yield Change(message, Effect.BREAKING, reason, Location(path, line, 1))


_PATTERNS: Mapping[NameKind, tuple[tuple[str, ...], str, Phrase]] = {
    NameKind.SIMULATION_PLUGIN: (
        _WORLD_SUFFIXES,
        r"<plugin\b[^>]*\bname\s*=\s*[\"']NAME[\"']",
        phrase("the plugin is not loaded"),
    ),
    NameKind.PLUGINLIB_CLASS: (
        (_XML_SUFFIX,),
        r"<class\b[^>]*\btype\s*=\s*[\"'](?:\w+::)*NAME[\"']",
        phrase("programs that load the class do not find it"),
    ),
    NameKind.TREE_NODE: (
        (_XML_SUFFIX,),
        r"<NAME(?=[\s/>])|<(?:Action|Condition|Control|Decorator)\b[^>]*\bID\s*=\s*[\"']NAME[\"']",
        phrase("the behavior tree cannot be loaded"),
    ),
}
"""The suffixes of the files that use the names of a kind, a pattern for them, and the effect of a lost name."""
