"""Decide whether a parameter of a YAML file names a topic, service, action or frame that its node offers."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.review.breaking import frame_reason, name_reason
from linkwright.review.file_pair import FilePair
from linkwright.review.files.parameters.comparing import compare_parameter_files
from linkwright.review.files.parameters.names import find_node_name
from linkwright.review.files.parameters.yaml_values import YamlValue
from linkwright.review.launches.loaded_remappings import find_loaded_remappings
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind, SourceName, SourceNames
from linkwright.review.sources.other_ends import find_given_reason
from linkwright.review.sources.parameter_defaults import SUM
from linkwright.review.sources.reading import read_source_names
from linkwright.review.sources.reasons import find_message_frame_reason
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_OFFERED_KINDS = (NameKind.PUBLISHER, NameKind.SERVICE, NameKind.ACTION, NameKind.FRAME, NameKind.MESSAGE_FRAME)
_NAME = re.compile(r"[~/\w]*[A-Za-z][/\w]*")


def compare_parameters_with_sources(pair: FilePair) -> None:
    """Compare two versions of a YAML file, and decide by the sources of its nodes which names are breaking."""
    versions = pair.versions
    compare_parameter_files(
        pair,
        lambda new: GivenNames(versions, pair.new_path, new).find_change_reason,
        lambda: (
            find_loaded_remappings(versions.old, pair.old_path),
            find_loaded_remappings(versions.new, pair.new_path),
        ),
    )


@dataclass(frozen=True)
class GivenNames:
    """The names that a parameter file gives to its nodes.

    Attributes:
        versions: the repository before and after the change.
        path: the path of the parameter file in the new version.
        new: the new values of the file, by path.
    """

    versions: Versions
    path: str
    new: Mapping[str, YamlValue]

    def find_change_reason(self, parameter: str, old: YamlValue, new: YamlValue) -> Phrase | None:
        """Return the reason why another name is breaking, or None if the value names nothing that the node offers.

        The sources of the package of the file, and those of the node, tell what the parameter names.
        """
        node = find_node_name(parameter)
        is_name = node is not None and not (old.is_list or new.is_list)
        if not is_name or not _NAME.fullmatch(old.text) or not _NAME.fullmatch(new.text):
            return None
        if old.text.strip("~/") == new.text.strip("~/") or self._is_given_elsewhere(parameter, old.text):
            return None
        name = parameter.removeprefix(f"{node}.ros__parameters.")
        if any(_is_joined(source, name) for source in self._find_sources(self.versions.new, node or "", name)):
            return None
        given = [
            (item.kind, source)
            for source in self._find_sources(self.versions.old, node or "", name)
            for item in source.default_names
            if item.parameter.lstrip("~/.") == name
        ]
        if not given or any(kind not in _OFFERED_KINDS for kind, _ in given):
            return None
        kind, source = min(given, key=lambda item: _OFFERED_KINDS.index(item[0]))
        reason = _explain(kind, old.text, source)
        is_frame = kind in (NameKind.FRAME, NameKind.MESSAGE_FRAME)
        if reason is None or is_frame:
            return reason
        return find_given_reason(reason, kind, (old.text, new.text), self.versions, self.path)

    def _is_given_elsewhere(self, parameter: str, name: str) -> bool:
        """Return whether another parameter of the new file has a name as value."""
        return any(value.text.strip("/") == name.strip("/") for other, value in self.new.items() if other != parameter)

    def _find_sources(self, version: Version, node: str, parameter: str) -> list[SourceNames]:
        """Return the sources of a version that may read a parameter of a node: those of the node, or of the package.

        A source has the node if it gives the node its name.
        """
        package = self.versions.new.package_of(self.path)
        last_name = re.split(r"[./]", node)[-1]
        sources: dict[bool, list[SourceNames]] = {True: [], False: []}
        for path in version.paths((*CPP_SUFFIXES, PYTHON_SUFFIX)):
            is_searched = TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts) and parameter in version.text(path)
            if not is_searched or is_launch_file_name(PurePosixPath(path).name):
                continue
            source = read_source_names(version.file(path))
            has_node = any(item.name == last_name for item in source.of_kind(NameKind.NODE))
            if has_node or (package is not None and version.package_of(path) == package):
                sources[has_node].append(source)
        return sources[True] or sources[False]


def _is_joined(source: SourceNames, parameter: str) -> bool:
    """Return whether a source joins the value of a parameter with those of others."""
    joined = (item.parameter.split(SUM) for item in source.default_names if SUM in item.parameter)
    return any(parameter in names for names in joined)


def _explain(kind: NameKind, name: str, source: SourceNames) -> Phrase | None:
    if kind is NameKind.FRAME:
        return frame_reason(name)
    if kind is NameKind.MESSAGE_FRAME:
        span = next((item.span for item in source.names), None)
        return None if span is None else find_message_frame_reason(SourceName(kind, name, "", span), source)
    return name_reason(name)
