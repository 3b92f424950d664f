"""The workspace of an editor: its folders, the unsaved texts and the findings about them."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import Diagnostic, LinkwrightError, Span
from linkwright.language.definitions import NameDefinition, definitions_in
from linkwright.language.includes import IncludeIndex, real_path
from linkwright.language.mentions import FILE_SUFFIXES as MENTIONING_FILES
from linkwright.lint.checking import Checker, UniqueFindings
from linkwright.lint.contexts import Contexts
from linkwright.lint.finding import Finding, without_element
from linkwright.lint.folders import Examined, select_relevant_findings, select_relevant_package_findings
from linkwright.lint.targets import DESCRIPTION_SUFFIXES, XML_SUFFIXES, Targets, find_files_and_packages
from linkwright.packages import PackageFinder, enclosing_package
from linkwright.packages.manifest import MANIFEST
from linkwright.urdf import Robot, read
from linkwright.xacro import expand
from linkwright.xmltree import Overlay
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.reader import read_bytes

_CHECK_INPUTS = (
    ".py",
    ".launch",
    ".launch.xml",
    ".yaml",
    ".yml",
    "CMakeLists.txt",
    MANIFEST,
    "linkwright.toml",
    "pyproject.toml",
)
"""The suffixes of files that affect all checks: callers, manifests and settings."""


MAX_CHARACTERS = 1_000_000
"""The maximum number of characters of a file that is not large. A large file is checked, but has no other features. The
largest known public description has 300,000 characters."""
_MAX_ROBOTS = 16
"""The number of descriptions whose robots are stored."""


class _Result(NamedTuple):
    """The findings about a subject, and the hashes of the open texts that were checked."""

    findings: tuple[Diagnostic, ...]
    text_hashes: Mapping[Path, int]


_NO_RESULT = _Result((), {})


def hash_texts(texts: Mapping[Path, str]) -> dict[Path, int]:
    """Return the hash of each text, to detect changes without a copy of the texts."""
    return {file: hash(text) for file, text in texts.items()}


class Workspace:
    """The files below some folders, with the open texts of an editor.

    All paths are results of `linkwright.language.includes.real_path`. Methods that read files or check may be called
    from another thread, one at a time.

    Args:
        folders: the folders of the workspace.

    Attributes:
        folders: the folders, with symbolic links resolved.
        index: the descriptions in the folders.
        cached_results: results about files until a file changes, each with the hashes of the open texts.
    """

    def __init__(self, folders: Iterable[Path]) -> None:
        self.folders = tuple(real_path(folder) for folder in folders)
        self.index = IncludeIndex(self.folders)
        self._checker = Checker(folders=self.folders)
        self._names: dict[Path, tuple[int, tuple[NameDefinition, ...]]] = {}
        self._results: dict[Path, _Result] = {}
        self._robots: dict[Path, tuple[Mapping[Path, int], Robot | None]] = {}
        self.cached_results: dict[tuple[str, Path], tuple[Mapping[Path, int], object]] = {}

    def file_saved(self, file: Path) -> None:
        """Update the stored results after a file on the disk was changed, created or removed."""
        self._robots.clear()
        self.cached_results.clear()
        if file.name.endswith(_CHECK_INPUTS):
            self._checker = Checker(folders=self.folders)

    def finder(self, file: Path) -> PackageFinder:
        """Return the package finder for a file."""
        return self._checker.finder(file)

    def contains(self, file: Path) -> bool:
        """Return whether a file is in a folder of the workspace."""
        return any(file.is_relative_to(folder) for folder in self.folders)

    def text(self, file: Path, texts: Mapping[Path, str]) -> str | None:
        """Return the text of a file, open or not, or None if it cannot be read."""
        if file in texts:
            return texts[file]
        try:
            return decode(read_bytes(file), str(file))
        except (OSError, LinkwrightError):
            return None

    def is_large(self, file: Path, texts: Mapping[Path, str]) -> bool:
        """Return whether a file, open or not, has more than `MAX_CHARACTERS`."""
        if file in texts:
            return len(texts[file]) > MAX_CHARACTERS
        try:
            return file.stat().st_size > MAX_CHARACTERS
        except OSError:
            return False

    def argument_calls(self, entry: Path) -> list[tuple[Mapping[str, str], Span | None]]:
        """Return the argument sets of a description, each with its call, or None for defaults."""
        return [({}, None), *self._checker.calls(entry, self.index.packages)]

    def possible_arguments(self, entry: Path) -> list[Mapping[str, str]]:
        """Return the argument sets of a description, including calls with unknown values."""
        return [*self._checker.possible_arguments(entry, self.index.packages), {}]

    def configuration_files(self, file: Path) -> list[Path]:
        """Return the files of a file's package, if it has one, that may mention links and joints."""
        package = enclosing_package(file.parent)
        return [] if package is None else self.configurations_below(package[1])

    def configurations_below(self, folder: Path) -> list[Path]:
        """Return the files below a folder that may mention links and joints."""
        paths, _ = find_files_and_packages(folder, (*MENTIONING_FILES, ".srdf", ".srdf.xacro", ".sdf", ".world"))
        return [real_path(path) for path in paths]

    def files(self, suffixes: tuple[str, ...]) -> list[Path]:
        """Return the files of the workspace with some suffixes, inside packages or not."""
        paths = (path for folder in self.folders for path in find_files_and_packages(folder, suffixes)[0])
        return [*dict.fromkeys(map(real_path, paths))]

    def package_neighbors(self, file: Path, known_files: Container[Path]) -> list[Path]:
        """Return the descriptions in a file's package, except known ones."""
        package = enclosing_package(file.parent)
        if package is None:
            return []
        folder = real_path(package[1])
        return [other for other in self.index.files if other not in known_files and other.is_relative_to(folder)]

    def names(self, file: Path, texts: Mapping[Path, str]) -> list[NameDefinition]:
        """Return the names defined in a file, and in the descriptions that include it.

        Args:
            file: the file of the request.
            texts: the texts of the open files.
        """
        return [name for other in self.index.related_files(file, texts) for name in self._names_in(other, texts)]

    def robot(self, entry: Path, texts: Mapping[Path, str]) -> Robot | None:
        """Return the robot of a description with default arguments, or None if it has errors.

        Args:
            entry: the description.
            texts: the texts of the open files. The result is cached until the text of a description changes.
        """
        texts = {
            file: text
            for file, text in texts.items()
            if file.name.endswith(DESCRIPTION_SUFFIXES) and file in self.index.files
        }
        text_hashes = hash_texts(texts)
        cached = self._robots.pop(entry, None)
        if cached is None or cached[0] != text_hashes:
            overlay = Overlay({str(path): text for path, text in texts.items()})
            try:
                robot = read(expand(entry, {}, packages=self.finder(entry), overlay=overlay).document).robot
            except LinkwrightError:
                robot = None
            cached = text_hashes, robot
        self._robots[entry] = cached
        if len(self._robots) > _MAX_ROBOTS:
            del self._robots[next(iter(self._robots))]
        return cached[1]

    def all_names(self, texts: Mapping[Path, str]) -> list[NameDefinition]:
        """Return the names that all descriptions of the workspace define.

        Args:
            texts: the texts of the open files.
        """
        return [name for file in dict.fromkeys((*self.index.files, *texts)) for name in self._names_in(file, texts)]

    def _names_in(self, file: Path, texts: Mapping[Path, str]) -> tuple[NameDefinition, ...]:
        text = texts.get(file)
        if text is not None:
            return () if len(text) > MAX_CHARACTERS else tuple(definitions_in(text, file))
        try:
            status = file.stat()
            if status.st_size > MAX_CHARACTERS:
                return ()
            changed_ns = status.st_mtime_ns
            cached = self._names.get(file)
            if cached is None or cached[0] != changed_ns:
                text = decode(read_bytes(file), str(file))
                cached = self._names[file] = (changed_ns, tuple(definitions_in(text, file)))
        except (OSError, LinkwrightError):
            return ()
        return cached[1]

    def subjects(self, file: Path, texts: Mapping[Path, str]) -> list[Path]:
        """Return the descriptions and packages to check when a file has changed.

        These are the descriptions that include it, and the folder of its package.

        Args:
            file: the changed file.
            texts: the texts of the open files.
        """
        is_description = file.name.endswith(DESCRIPTION_SUFFIXES)
        if (is_description and file not in texts and file.exists() != (file in self.index.files)) or (
            file.name == MANIFEST and file.exists() != (file.parent in self.index.packages)
        ):
            self.index.refresh()
        elif not is_description and file not in texts:
            files_below = [other for other in (*self.index.files, *self._results) if other.is_relative_to(file)]
            if files_below or file.is_dir():  # A folder was created, moved or deleted.
                entries = [entry for other in files_below for entry in self.index.entries(other, texts)]
                self.index.refresh()
                return [*dict.fromkeys((*entries, *files_below))]
        package = enclosing_package(file.parent)
        descriptions = self.index.entries(file, texts) if is_description else []
        subjects = [*descriptions, *([] if package is None else [real_path(package[1])])]
        if subjects and file not in subjects:
            self._results.pop(file, None)  # These are findings about the file alone, from before it had subjects.
        return subjects

    def check(
        self, subject: Path, texts: Mapping[Path, str], changed: Iterable[Path] = ()
    ) -> dict[Path, list[Diagnostic]]:
        """Check a description or package, and return the findings about each affected file.

        Args:
            subject: a description, or the folder of a package, as `subjects` returns them.
            texts: the texts of the open files.
            changed: files that are included in the result even if there is no finding about them.
        """
        return self.record(subject, self.check_subject(subject, texts), texts, changed)

    def record(
        self, subject: Path, findings: tuple[Diagnostic, ...], texts: Mapping[Path, str], changed: Iterable[Path] = ()
    ) -> dict[Path, list[Diagnostic]]:
        """Store the findings about a subject, and return the findings about each affected file.

        A subject is a description or a package.

        Args:
            subject: the description or the folder of the package.
            findings: the findings that `check_subject` has returned.
            texts: the texts of the open files that were checked.
            changed: files that are included in the result even if there is no finding about them.
        """
        old_findings = self._results.pop(subject, _NO_RESULT).findings
        if findings:
            self._results[subject] = _Result(findings, hash_texts(texts))
        return self._findings_by_file(
            {_file_of(diagnostic, subject) for diagnostic in (*old_findings, *findings)} | {*changed}
        )

    def cleared_findings(self) -> dict[Path, list[Diagnostic]]:
        """Return an empty list for each file with findings, to clear the findings in an editor."""
        results = self._results.items()
        return {_file_of(finding, subject): [] for subject, result in results for finding in result.findings}

    def fixable_findings(self, file: Path, texts: Mapping[Path, str]) -> list[Finding]:
        """Return the findings about a file with a fix that applies to the current texts.

        Args:
            file: the file of the request.
            texts: the texts of the open files.
        """
        unique_findings = UniqueFindings()
        text_hashes = hash_texts(texts)
        for subject, result in self._results.items():
            for finding in result.findings:
                if isinstance(finding, Finding) and finding.fix is not None and _file_of(finding, subject) == file:
                    edited = {real_path(edit.source_file) for edit in finding.fix.edits}
                    if all(result.text_hashes.get(other) == text_hashes.get(other) for other in edited):
                        unique_findings.add([finding])
        return [finding for finding in unique_findings.all() if isinstance(finding, Finding)]

    def findings(self, file: Path, texts: Mapping[Path, str]) -> list[Diagnostic]:
        """Return the findings with a location in a file, if its text has not changed since.

        Args:
            file: the file of the request.
            texts: the texts of the open files.
        """
        unique_findings = UniqueFindings()
        text_hashes = hash_texts(texts)
        for result in self._results.values():
            if result.text_hashes.get(file) == text_hashes.get(file):
                unique_findings.add(
                    [
                        finding
                        for finding in result.findings
                        if finding.span is not None and real_path(finding.span.file) == file
                    ]
                )
        return unique_findings.all()

    def check_subject(self, subject: Path, texts: Mapping[Path, str]) -> tuple[Diagnostic, ...]:
        """Check a description or package, and return the findings without their elements.

        Args:
            subject: a description, or the folder of a package, as `subjects` returns them.
            texts: the texts of the open files.
        """
        findings = self._check_subject(subject, texts) if subject in texts or subject.exists() else ()
        return tuple(map(without_element, findings))

    def _check_subject(self, subject: Path, texts: Mapping[Path, str]) -> tuple[Diagnostic, ...]:
        overlay = Overlay({str(path): text for path, text in texts.items()})
        if subject.is_dir():
            diagnostics, problems = self._checker.check_package(subject, overlay, Contexts())
            return (*problems, *select_relevant_package_findings(diagnostics, [subject]))
        if not self._is_xml(subject, texts):
            return ()
        open_subjects = frozenset({subject}) if subject in texts else frozenset()
        targets = Targets((subject,), self.index.packages, open_subjects)
        checked_file, problems = self._checker.check_file(subject, targets, overlay, Contexts())
        examined = Examined.of(checked_file, subject)
        return (*problems, *select_relevant_findings(examined, [examined], targets, [subject]))

    def _is_xml(self, file: Path, texts: Mapping[Path, str]) -> bool:
        """Return whether a file is XML by its name, or else by its text."""
        return file.name.endswith((*XML_SUFFIXES, ".xml")) or (self.text(file, texts) or "").lstrip().startswith("<")

    def _findings_by_file(self, files: set[Path]) -> dict[Path, list[Diagnostic]]:
        """Return the findings about some files, of all subjects, without duplicates."""
        findings_by_file = {file: UniqueFindings() for file in files}
        for subject, result in self._results.items():
            for diagnostic in result.findings:
                file = _file_of(diagnostic, subject)
                if file in findings_by_file:
                    findings_by_file[file].add([diagnostic])
        return {file: unique.all() for file, unique in findings_by_file.items()}


def _file_of(diagnostic: Diagnostic, subject: Path) -> Path:
    """Return the file of a finding: its location, or else its description or manifest."""
    if diagnostic.span is not None:
        return real_path(diagnostic.span.file)
    return subject / MANIFEST if subject.is_dir() else subject
