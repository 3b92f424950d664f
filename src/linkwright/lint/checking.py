"""Checks of files and packages, for `linkwright check` and editors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Span
from linkwright.lint.argument_sets import SetCheck
from linkwright.lint.configuration import find_settings, read_settings
from linkwright.lint.contexts import Contexts
from linkwright.lint.engine import Checked, examine, examine_package
from linkwright.lint.finding import without_element
from linkwright.lint.folders import (
    MISSING_PACKAGE_CODE,
    Examined,
    select_relevant_findings,
    select_relevant_package_findings,
)
from linkwright.lint.rule import Scope
from linkwright.lint.selector_words import to_canonical
from linkwright.lint.settings import Settings
from linkwright.lint.targets import Targets
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import PackageFinder
from linkwright.packages.manifest import MANIFEST
from linkwright.xmltree import Overlay

if TYPE_CHECKING:
    from linkwright.descriptions.argument_sets import ArgumentSet, ArgumentSets


class UniqueFindings:
    """A collection of findings that drops duplicates.

    For example, the findings of a file that two robots include occur twice.
    """

    def __init__(self) -> None:
        self._findings: dict[tuple[str, Span | None, str], Diagnostic] = {}

    def add(self, findings: Iterable[Diagnostic]) -> None:
        """Add the findings that are not in the collection yet, without their elements."""
        for diagnostic in findings:
            key = (diagnostic.code, _find_location(diagnostic), diagnostic.message)
            if key not in self._findings:
                self._findings[key] = without_element(diagnostic)

    def all(self) -> list[Diagnostic]:
        """Return the findings in the order of their addition."""
        return list(self._findings.values())


def _find_location(diagnostic: Diagnostic) -> Span | None:
    """Return the location of a finding with the resolved path of its file.

    The result is None for a finding without a location, and for missing packages.
    """
    span = diagnostic.span
    if span is None or diagnostic.code == MISSING_PACKAGE_CODE:
        return None  # installing the package once is enough, however many files use it
    return span._replace(file=str(Path(span.file).resolve()))


@dataclass(frozen=True, slots=True)
class Checker:
    """A checker of files and packages that finds packages and callers of descriptions once.

    Attributes:
        values: the values of arguments; if empty, the values of the settings or of callers are used.
        select: the rules to report instead of those that the settings select, or None.
        ignore: the rules to ignore in addition to those that the settings ignore.
        config: the settings file to use instead of the nearest one.
        folders: the folders to search for packages, in addition to those around each file.
        shares: the share folders of packages that take precedence, such as those of a commit, by name.
        overlay: texts that replace the contents of the files of `check`.
    """

    values: Mapping[str, str] = field(default_factory=dict)
    select: tuple[str, ...] | None = None
    ignore: tuple[str, ...] = ()
    config: Path | None = None
    folders: tuple[Path, ...] = ()
    shares: Mapping[str, Path] = field(default_factory=dict)
    overlay: Overlay | None = None
    _finders: dict[Path, PackageFinder] = field(default_factory=dict)
    _callers: list[ArgumentSets] = field(default_factory=list)

    def finder(self, file: Path) -> PackageFinder:
        """Return the package finder for a file.

        Each folder has its own finder. All finders share a single search of each source tree.
        """
        folder = file.absolute().parent
        if folder not in self._finders:
            start_folders = [folder, *self.folders, Path.cwd()]
            first_finder = next(iter(self._finders.values()), None)
            self._finders[folder] = (
                first_finder.starting_at(start_folders)
                if first_finder
                else PackageFinder(start=start_folders, extra=self.shares, sources_first=True)
            )
        return self._finders[folder]

    def settings(self, path: Path) -> tuple[Settings, tuple[Diagnostic, ...]]:
        """Return the settings for a file or folder, and the findings about the settings file."""
        settings, settings_findings = find_settings(path) if self.config is None else read_settings(self.config)
        select = None if self.select is None else tuple(map(to_canonical, self.select))
        return settings.with_command_line(select, tuple(map(to_canonical, self.ignore))), settings_findings

    def for_folders(self, folders: Sequence[Path]) -> Checker:
        """Return a checker with the same settings for other folders, such as another version's."""
        return Checker(self.values, self.select, self.ignore, self.config, tuple(folders))

    def check(
        self, targets: Targets, paths: Sequence[Path], on_checked: Callable[[Checked], None] | None = None
    ) -> tuple[list[Diagnostic], Checked | None]:
        """Check files and packages.

        Args:
            targets: the files and packages.
            paths: the files and folders that the user named.
            on_checked: a function that is called with the result of each file.

        Returns:
            All findings without duplicates, and the result of the last file, or None if there is no file.
        """
        findings, contexts = UniqueFindings(), Contexts()
        checked = None
        examined_files: list[Examined] = []
        all_settings_findings: list[tuple[Diagnostic, ...]] = []
        for file in targets.files:
            checked, settings_findings = self.check_file(file, targets, self.overlay, contexts)
            if on_checked is not None:
                on_checked(checked)
            examined_files.append(Examined.of(checked, file))
            all_settings_findings.append(settings_findings)
        for result, settings_findings in zip(examined_files, all_settings_findings, strict=True):
            findings.add((*settings_findings, *select_relevant_findings(result, examined_files, targets, paths)))
        for folder in targets.packages:
            diagnostics, settings_findings = self.check_package(folder, contexts=contexts)
            relevant_findings = select_relevant_package_findings(targets.select(folder, diagnostics), paths)
            findings.add((*settings_findings, *relevant_findings))
        return findings.all(), checked

    def check_file(
        self, file: Path, targets: Targets, overlay: Overlay | None = None, contexts: Contexts | None = None
    ) -> tuple[Checked, tuple[Diagnostic, ...]]:
        """Check a file with `values`, or with the configured or the callers' argument sets.

        Args:
            file: a description, world or other supported file.
            targets: the targets of the whole check, whose packages are searched for callers.
            overlay: texts that replace the contents of files.
            contexts: data that checks of the same file contents share.

        Returns:
            The result, and the findings about the settings.
        """
        settings, settings_findings = self.settings(file)
        finder = self.finder(file)

        def with_values(values: Mapping[str, str], xacro: bool | None = None) -> Checked:
            return examine(
                file,
                arguments=values,
                packages=finder,
                settings=settings,
                overlay=overlay,
                scopes=(Scope.DESCRIPTION,),
                xacro=xacro,
                contexts=contexts,
            )

        if self.values:
            return with_values(self.values), settings_findings
        check = SetCheck(file, finder, settings, with_values, is_named=file in targets.named_files)
        configured_sets = settings.arguments_of(file)
        if configured_sets:
            return check.with_configured(configured_sets), settings_findings
        return check.with_callers(lambda: self._argument_sets(file, targets.packages)), settings_findings

    def check_package(
        self, folder: Path, overlay: Overlay | None = None, contexts: Contexts | None = None
    ) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
        """Return the findings about a package without its descriptions, and about its settings."""
        settings, settings_findings = self.settings(folder)
        checked = examine_package(folder, settings, self.finder(folder / MANIFEST), overlay, contexts)
        return checked.diagnostics, settings_findings

    def calls(self, file: Path, packages: Sequence[Path]) -> list[tuple[Mapping[str, str], Span | None]]:
        """Return the argument values of a description: from the settings, or else from its callers.

        Args:
            file: the description.
            packages: the folders that are searched for callers.

        Returns:
            The complete sets of values, each with the location of the call, or None for values of the settings.
        """
        settings, _ = self.settings(file)
        configured_sets = settings.arguments_of(file)
        if configured_sets:
            return [(values, None) for values in configured_sets]
        return [
            (argument_set.values, argument_set.span)
            for argument_set in self._argument_sets(file, packages)
            if argument_set.is_complete
        ]

    def argument_sets(self, file: Path, packages: Sequence[Path]) -> list[ArgumentSet]:
        """Return the argument sets of a description: from the settings, or else from its callers.

        Sets of callers are included even if values are known only at runtime, or may not occur in combination.

        Args:
            file: the description.
            packages: the folders that are searched for callers.
        """
        from linkwright.descriptions.argument_sets import ArgumentSet

        settings, _ = self.settings(file)
        configured_sets = settings.arguments_of(file)
        if configured_sets:
            return [ArgumentSet(values) for values in configured_sets]
        return list(self._argument_sets(file, packages))

    def possible_arguments(self, file: Path, packages: Sequence[Path]) -> list[Mapping[str, str]]:
        """Return the argument values that callers pass to a description.

        The values of a set are included even if other values of the set are known only at runtime.

        Args:
            file: the description.
            packages: the folders that are searched for callers.
        """
        return [argument_set.values for argument_set in self._argument_sets(file, packages)]

    def _argument_sets(self, file: Path, packages: Sequence[Path]) -> tuple[ArgumentSet, ...]:
        """Return the argument sets that callers pass to a file.

        The callers are read once for all files.
        """
        from linkwright.descriptions.argument_sets import ArgumentSets

        if not self._callers:
            self._callers.append(ArgumentSets(packages))
        return self._callers[0].of(file, self.finder(file))
