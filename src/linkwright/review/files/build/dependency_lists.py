"""Compare lists of repositories (vcstool, rosinstall) and of Python packages (pip)."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from linkwright.diagnostics import Phrase, joined, joined_first, phrase
from linkwright.review.changes import MAX_NAMES, Location
from linkwright.review.file_pair import FilePair
from linkwright.review.files.parameters.yaml_values import compose_yaml, read_yaml_text
from linkwright.review.texts.list_changes import change_text
from linkwright.review.versions import Version

REPOSITORY_SUFFIXES = (".repos", ".rosinstall")
REQUIREMENTS = re.compile(r"requirements([-_.]\w+)*\.txt")
"""The names of files with Python packages for pip."""
_REPOSITORIES = "repositories"
_REPOSITORY_LIST = re.compile(r"(?m)^repositories[ \t]*:[ \t]*(?:#.*)?$")
_ADDRESS = re.compile(r"(?m)^[ \t]+url[ \t]*:[ \t]*\S+(?:\.git|://|@)")
_LOCAL_NAME, _URL, _REVISION = "local-name", "uri", "version"
"""The keys of an entry of rosinstall."""
_REQUIREMENT = re.compile(r"(?P<name>[A-Za-z0-9][\w.-]*)\s*(?P<rest>.*)")
_COMMENT = re.compile(r"(^|\s)#.*")


@dataclass(frozen=True)
class Entry:
    """A repository or a Python package.

    Attributes:
        line: the line, starting at 1.
        settings: the URL, version and other settings by name.
    """

    line: int
    settings: Mapping[str, str] = field(default_factory=dict)

    @property
    def text(self) -> Phrase:
        """The settings in one line."""
        return joined([value if name == "" else f"{name} {value}" for name, value in self.settings.items()])


_Entries = Mapping[str, Entry]


def is_repository_list(text: str) -> bool:
    """Return whether a YAML text is a list of repositories for vcstool, whatever the name of its file is."""
    return _REPOSITORY_LIST.search(text) is not None and _ADDRESS.search(text) is not None


def compare_repositories(pair: FilePair) -> None:
    """Compare two versions of a list of repositories."""
    _compare_entries(pair, read_repositories, lambda name: phrase("repository '{name}'", name=name))


def compare_requirements(pair: FilePair) -> None:
    """Compare two versions of a list of Python packages."""
    _compare_entries(pair, read_requirements, lambda name: phrase("Python package '{name}'", name=name))


def repository_contents(version: Version, path: str) -> Phrase | None:
    """Return the names of the repositories in a list, or None if it is empty."""
    return joined_first(list(read_repositories(version.file(path))), MAX_NAMES) or None


def requirement_contents(version: Version, path: str) -> Phrase | None:
    """Return the names of the Python packages in a list, or None if it is empty."""
    return joined_first(list(read_requirements(version.file(path))), MAX_NAMES) or None


def _compare_entries(pair: FilePair, read: Callable[[Path], _Entries], title: Callable[[str], Phrase]) -> None:
    entries = pair.read(read)
    if entries is None:
        return
    old, new = entries
    for name, entry in new.items():
        location = Location(pair.new_path, entry.line, 1)
        if name not in old:
            text = phrase("{element} added", element=title(name))
            pair.add(_append_settings(text, entry), location)
            continue
        before = old[name].settings
        for setting in dict.fromkeys([*entry.settings, *before]):
            values = before.get(setting, "-"), entry.settings.get(setting, "-")
            if values[0] != values[1]:
                change = change_text(setting or phrase("version"), *values)
                pair.add(phrase("{entry}: {change}", entry=title(name), change=change), location)
    for name, entry in old.items():
        if name not in new:
            text = phrase("{element} removed", element=title(name))
            pair.add(_append_settings(text, entry), Location(pair.old_path, entry.line, 1, is_old=True))


def _append_settings(text: Phrase, entry: Entry) -> Phrase:
    return phrase("{change}: {contents}", change=text, contents=entry.text) if entry.settings else text


def read_repositories(file: Path) -> dict[str, Entry]:
    """Return the repositories in a file for vcstool or rosinstall, by the folder of the clone.

    Raises:
        UnreadableFileError: the text is not YAML, or too long.
    """
    root = compose_yaml(read_yaml_text(file))
    if isinstance(root, yaml.SequenceNode):
        return dict(entry for item in root.value for entry in _read_rosinstall_entry(item))
    repositories = _read_mapping(root).get(_REPOSITORIES)
    return {
        name: Entry(node.start_mark.line + 1, _read_settings(node))
        for name, node in _read_mapping(repositories).items()
    }


def _read_rosinstall_entry(node: yaml.Node) -> Iterator[tuple[str, Entry]]:
    for kind, entry in _read_mapping(node).items():
        settings = _read_settings(entry)
        name = settings.pop(_LOCAL_NAME, None)
        if name is not None:
            values = {"type": kind, "url": settings.get(_URL, ""), "version": settings.get(_REVISION, "")}
            yield name, Entry(node.start_mark.line + 1, {key: value for key, value in values.items() if value})


def _read_settings(node: yaml.Node) -> dict[str, str]:
    values = _read_mapping(node).items()
    return {name: " ".join(str(value.value).split()) for name, value in values if isinstance(value, yaml.ScalarNode)}


def _read_mapping(node: yaml.Node | None) -> dict[str, yaml.Node]:
    return {str(key.value): value for key, value in node.value} if isinstance(node, yaml.MappingNode) else {}


def read_requirements(file: Path) -> dict[str, Entry]:
    """Return the versions in a requirements file by Python package.

    Lines that name no package, such as options, are keys without a version.

    Raises:
        UnreadableFileError: the text is too long.
    """
    entries: dict[str, Entry] = {}
    for number, line in enumerate(read_yaml_text(file).splitlines(), 1):
        text = " ".join(_COMMENT.sub("", line).split())
        match = _REQUIREMENT.fullmatch(text)
        if match is None:
            entries |= {text: Entry(number)} if text else {}
        else:
            entries[match["name"]] = Entry(number, {"": match["rest"]} if match["rest"] else {})
    return entries
