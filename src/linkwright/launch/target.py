"""The launch file to run: a path, or a file name in a package."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, display_path, joined, phrase
from linkwright.launch.arguments import parse_arguments
from linkwright.packages import PackageFinder
from linkwright.packages.launch_files import find_launch_files_below, is_launch_file_name


@dataclass(frozen=True)
class LaunchTarget:
    """A launch file as specified on the command line.

    Attributes:
        file: the path of the file. If there is a package, the name of the file, or its path relative to the package's
            share folder.
        package: the name of the package, or None.
    """

    file: str
    package: str | None = None

    def create_finder(self) -> PackageFinder:
        """Return a finder of ROS packages.

        The search starts in the current folder and, if the launch file is a path, in the folder of the file.
        """
        if self.package is None:
            return PackageFinder(start=[Path(self.file).absolute().parent, Path.cwd()])
        return PackageFinder()

    def resolve(self, finder: PackageFinder) -> Path:
        """Return the absolute path of the launch file.

        Raises:
            LinkwrightError: PKG101, there is no such package; LAUNCH101, the package has no such file, or has several.
        """
        if self.package is None:
            return Path(self.file).absolute()
        share = finder.share(self.package)
        for path in (share / self.file, share / "launch" / self.file):
            if path.is_file():
                return path
        return self._find_in_package(share)

    def _find_in_package(self, share: Path) -> Path:
        launch_files = find_launch_files_below(share)
        matching_files = [path for path in launch_files if path.name == self.file]
        if len(matching_files) == 1:
            return matching_files[0]
        if matching_files:
            message = phrase(
                "package '{package}' has several launch files '{file}'", package=self.package, file=self.file
            )
            paths_text = ", ".join(str(path.relative_to(share)) for path in matching_files)
            raise LinkwrightError(
                Diagnostic("LAUNCH101", message, hint=phrase("pass the path of one of them: {paths}", paths=paths_text))
            )
        names = [path.name for path in launch_files]
        message = phrase(
            "package '{package}' has no launch file '{file}' (in {share})",
            package=self.package,
            file=self.file,
            share=display_path(share),
        )
        hint = did_you_mean(self.file, names)
        if hint is None:
            hint = (
                phrase("the package has {names}", names=joined(names))
                if names
                else phrase("check that setup.py installs the launch files; the package has none")
            )
        raise LinkwrightError(Diagnostic("LAUNCH101", message, hint=hint))


def parse_launch_words(words: Sequence[str]) -> tuple[LaunchTarget, dict[str, str]]:
    """Return the launch file and the arguments that a command line names.

    The command line is ``launch PACKAGE FILE [name:=value ...]`` or ``launch PATH [name:=value ...]``.

    Args:
        words: the arguments after ``launch``.

    Returns:
        The launch file, and the values of the launch arguments by name.

    Raises:
        LinkwrightError: LAUNCH110, no launch file is named; LAUNCH111, an argument is malformed.
    """
    split_index = next((index for index, argument in enumerate(words) if ":=" in argument), len(words))
    split_index = min(split_index, 2)
    if split_index == 2 and _is_file(words[0]):  # probably a malformed launch argument
        split_index = 1
    target_names, argument_texts = words[:split_index], words[split_index:]
    values = parse_arguments(argument_texts)
    if not target_names:
        raise _incomplete_error(
            phrase("no launch file is given"),
            phrase("pass a PACKAGE and a FILE in it, or the PATH of a launch file"),
        )
    if len(target_names) == 1:
        if not _is_file(target_names[0]) and not _is_path(target_names[0]):
            files = [path.name for path in _find_package_files(target_names[0])]
            if files:
                hint = phrase("the package has {names}", names=joined(files))
                raise _incomplete_error(
                    phrase("'{named}' is a package: add the name of a launch file in it", named=target_names[0]), hint
                )
        return LaunchTarget(target_names[0]), values
    return LaunchTarget(target_names[1], target_names[0]), values


def _is_file(argument: str) -> bool:
    return Path(argument).is_file()


def _is_path(argument: str) -> bool:
    return os.sep in argument or is_launch_file_name(argument) or argument.endswith((".py", ".xml", ".yaml"))


def _find_package_files(name: str) -> list[Path]:
    share = PackageFinder().find(name)
    return [] if share is None else find_launch_files_below(share)


def _incomplete_error(message: Phrase, hint: Phrase) -> LinkwrightError:
    return LinkwrightError(Diagnostic("LAUNCH110", message, hint=hint))
