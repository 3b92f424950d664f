"""Find plugins that a launch file newly loads by a parameter, from packages that no ``package.xml`` names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.files.parameters.plugin_packages import PluginPackages, find_plugin_package
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.outlines import PARAMETER, SERVER_PARAMETER, Entry, LaunchOutline
from linkwright.review.launches.programs.sources import try_read_outline
from linkwright.review.versions import TEST_FOLDERS, Versions


def find_undeclared_plugins(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the launch files that newly load a plugin of an undeclared package, each with a change."""
    for file in changed_files:
        path = file.new_path
        if path is None or file.is_submodule or not is_launch_file(path):
            continue
        if not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
            continue
        new = try_read_outline(versions.new, path)
        old = None if file.old_path is None else try_read_outline(versions.old, file.old_path)
        old_classes = set() if old is None else {name for name, _, _ in _list_plugins(old)}
        reported: set[str] = set()
        for name, package, entry in () if new is None else _list_plugins(new):
            reason = PluginPackages(versions, path).explain_missing_package(package)
            if reason is None or name in old_classes or name in reported:
                continue
            reported.add(name)
            text = phrase("loads the plugin '{name}' for the first time", name=name)
            yield path, Change(text, Effect.BREAKING, reason, Location(path, entry.span.line, entry.span.column))


def _list_plugins(outline: LaunchOutline) -> Iterator[tuple[str, str, Entry]]:
    """Yield the classes of the plugins in the parameters of a launch file, with their packages and actions."""
    for entry in outline.entries:
        values = {name: value for name, value in entry.settings.items() if name.startswith(PARAMETER)}
        if entry.kind == SERVER_PARAMETER:
            values = {entry.name.replace("/", "."): entry.settings.get("value", "")}
        for name, value in values.items():
            text = outline.resolve(value).strip("\"'")
            package = find_plugin_package(name.removeprefix(PARAMETER), text)
            if package is not None:
                yield text, package, entry
