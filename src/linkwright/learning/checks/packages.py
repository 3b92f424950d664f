"""Files and packages of the learner's workspace, as checks see them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkwright.descriptions import examine
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, did_you_mean, phrase, quoted_names
from linkwright.learning.checks.launched import LaunchCheck
from linkwright.learning.checks.not_yet import NotYet
from linkwright.learning.checks.robots import RobotCheck
from linkwright.packages import PackageFinder


class FileFolder:
    """A folder of the learner's files.

    Attributes:
        folder: the folder.
        finder: the finder of the workspace's packages.
    """

    def __init__(self, folder: Path, finder: PackageFinder) -> None:
        self.folder = folder
        self.finder = finder
        self._robots: dict[tuple[str, tuple[tuple[str, str], ...]], RobotCheck] = {}

    def file(self, name: str) -> Path:
        """Return a file of the folder.

        Args:
            name: the path in the folder, such as ``urdf/mbot_base.urdf``.

        Raises:
            NotYet: there is no such file.
        """
        path = self.folder / name
        if path.is_file():
            if path.stat().st_size == 0:
                raise NotYet(phrase("the file '{name}' is empty", name=name))
            return path
        others = [
            other.relative_to(self.folder).as_posix()
            for other in self.folder.rglob(f"*{path.suffix}")
            if other.is_file()
        ]
        suggestion = did_you_mean(name, others)
        if others and suggestion is not None:
            raise NotYet(
                phrase(
                    "'{folder}' has no file '{name}'; it has {others}",
                    folder=self.folder.name,
                    name=name,
                    others=quoted_names(others[:3]),
                )
            )
        raise NotYet(phrase("'{folder}' has no file '{name}'", folder=self.folder.name, name=name))

    def robot(self, name: str, **arguments: str) -> RobotCheck:
        """Return the robot of a URDF or xacro file.

        Args:
            name: the path in the folder.
            arguments: the xacro arguments.

        Raises:
            NotYet: the file is missing, or is not a valid description.
        """
        key = name, tuple(sorted(arguments.items()))
        if key not in self._robots:
            self._robots[key] = self._read_robot(self.file(name), arguments)
        return self._robots[key]

    def _read_robot(self, path: Path, arguments: Mapping[str, str]) -> RobotCheck:
        try:
            description = examine(path, arguments=arguments, packages=self.finder)
        except LinkwrightError as error:
            raise NotYet(_describe(error.diagnostics[0])) from None
        errors = [finding for finding in description.diagnostics if finding.severity is Severity.ERROR]
        if errors or description.robot is None:
            raise NotYet(_describe(errors[0]))
        return RobotCheck(description.robot, path)

    def expect_no_findings(self, name: str = "") -> None:
        """Require that ``linkwright check`` finds nothing in a file, or in the whole folder.

        Raises:
            NotYet: there is a warning or an error.
        """
        from linkwright.lint.checking import Checker
        from linkwright.lint.targets import find_targets

        path = self.file(name) if name else self.folder
        try:
            findings, _ = Checker().check(find_targets([path]), [path])
        except LinkwrightError as error:
            findings = list(error.diagnostics)
        serious = [finding for finding in findings if finding.severity is not Severity.INFO]
        if serious:
            raise NotYet(_describe(serious[0]))


class PackageCheck(FileFolder):
    """A package of the learner's workspace.

    Attributes:
        name: the name.
        folder: the folder with its sources.
        finder: the finder of the workspace's packages.
    """

    def __init__(self, name: str, folder: Path, finder: PackageFinder) -> None:
        super().__init__(folder, finder)
        self.name = name

    def launch(self, name: str, **arguments: str) -> LaunchCheck:
        """Return a launch of the package, to be used as a context manager.

        Args:
            name: the launch file, such as ``display.launch.py``.
            arguments: the launch arguments.

        Raises:
            NotYet: there is no such launch file.
        """
        self.file(f"launch/{name}")
        return LaunchCheck(self.name, name, arguments, self.finder)


def _describe(finding: Diagnostic) -> Phrase:
    """Return a finding as one sentence with its file and line."""
    if finding.span is None:
        return phrase("{message} [{code}]", message=finding.message, code=finding.code)
    return phrase(
        "{file}, line {line}: {message} [{code}]",
        file=Path(finding.span.file).name,
        line=finding.span.line,
        message=finding.message,
        code=finding.code,
    )
