"""Compare the entry points and installed files in ``setup.cfg`` and ``pyproject.toml``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from configparser import ConfigParser, Error
from pathlib import Path, PurePosixPath
from typing import Any

from linkwright.diagnostics import foreign
from linkwright.packages.readers.entry_points import parse_toml
from linkwright.packages.readers.installed import PROGRAM_GROUP
from linkwright.review.file_pair import FilePair, UnreadableFileError
from linkwright.review.files.build.comparison import compare_build_files
from linkwright.review.files.build.facts import BuildFacts, Fact, FactKind
from linkwright.review.versions import Version

SETUP_CFG = "setup.cfg"
PYPROJECT = "pyproject.toml"
_SCRIPT_FOLDERS = (("develop", "script_dir"), ("develop", "script-dir"), ("install", "install_scripts"),
                   ("install", "install-scripts"))  # fmt: skip
"""The settings of the folder into which executables are installed."""
_SHOWN_SETTINGS = ("name", "version", "license", "python_requires", "requires-python")


def compare_setup_cfg_files(pair: FilePair) -> None:
    """Compare two versions of a ``setup.cfg``."""
    compare_build_files(pair, read_setup_cfg)


def compare_pyproject_files(pair: FilePair) -> None:
    """Compare two versions of a ``pyproject.toml``."""
    compare_build_files(pair, read_pyproject)


def read_setup_cfg(version: Version, path: str) -> BuildFacts:
    """Return the facts of a ``setup.cfg``.

    Raises:
        UnreadableFileError: the file has wrong syntax.
    """
    parser = ConfigParser(interpolation=None)
    try:
        parser.read_string(version.file(path).read_text(encoding="utf-8", errors="replace"))
    except Error as error:
        raise UnreadableFileError(foreign(str(error).splitlines()[0])) from error
    sections: dict[str, dict[str, str]] = {name: dict(parser[name]) for name in parser.sections()}
    facts = _make_empty_facts(path)
    facts.project = sections.get("metadata", {}).get("name", "")
    for group, lines in sections.get("options.entry_points", {}).items():
        facts.facts += _make_entry_point_facts(group, (line.partition("=")[::2] for line in lines.splitlines()))
    for folder, lines in sections.get("options.data_files", {}).items():
        _add_files(facts, version, folder, lines.splitlines())
    settings = {**sections.get("metadata", {}), **sections.get("options", {})}
    facts.facts += _make_setting_facts(settings)
    for section, option in _SCRIPT_FOLDERS:
        value = sections.get(section, {}).get(option, "")
        if value:
            name = f"{section}.{option.replace('-', '_')}"
            facts.facts.append(Fact(FactKind.SETTING, name, value, is_value_used=True))
    return facts


def read_pyproject(version: Version, path: str) -> BuildFacts:
    """Return the facts of a ``pyproject.toml``.

    Raises:
        UnreadableFileError: the file has wrong syntax.
    """
    try:
        document = parse_toml(version.file(path).read_text(encoding="utf-8", errors="replace"))
    except ValueError as error:
        raise UnreadableFileError(foreign(str(error))) from error
    facts = _make_empty_facts(path)
    project = _find_table(document, "project")
    facts.project = str(project.get("name", ""))
    facts.facts += _make_entry_point_facts(PROGRAM_GROUP, _find_table(project, "scripts").items())
    for group, entries in _find_table(project, "entry-points").items():
        facts.facts += _make_entry_point_facts(group, entries.items() if isinstance(entries, Mapping) else ())
    for folder, patterns in _find_table(document, "tool", "setuptools", "data-files").items():
        _add_files(facts, version, folder, patterns if isinstance(patterns, list) else ())
    facts.facts += _make_setting_facts(project)
    return facts


def _make_empty_facts(path: str) -> BuildFacts:
    return BuildFacts(package=PurePosixPath(path).parent.as_posix().removeprefix("."))


def _find_table(document: Mapping[str, Any], *names: str) -> Mapping[str, Any]:
    for name in names:
        value = document.get(name)
        document = value if isinstance(value, Mapping) else {}
    return document


def _make_entry_point_facts(group: str, entries: Iterable[tuple[object, object]]) -> Iterator[Fact]:
    for entry, target in entries:
        name, function = str(entry).strip(), str(target).strip()
        if not name or not function:
            continue
        if group == PROGRAM_GROUP:
            yield Fact(FactKind.EXECUTABLE, name, function)
        else:
            yield Fact(FactKind.ENTRY_POINT, f"{group}: {name}", function)


def _make_setting_facts(settings: Mapping[str, object]) -> Iterator[Fact]:
    for name in _SHOWN_SETTINGS:
        value = settings.get(name)
        if isinstance(value, str) and value.strip():
            yield Fact(FactKind.SETTING, name, value.strip())


def _add_files(facts: BuildFacts, version: Version, folder: str, patterns: Iterable[object]) -> None:
    """Add the files that match patterns to the files installed into a folder."""
    package = version.file(facts.package)
    for pattern in (str(pattern).strip() for pattern in patterns):
        if not pattern or Path(pattern).is_absolute() or ".." in PurePosixPath(pattern).parts:
            continue
        for file in sorted(package.glob(pattern)):
            if file.is_file():
                facts.files[f"{folder.strip('/')}/{file.name}"] = file.relative_to(package).as_posix()
