"""The launch file to run, given by a path, or by a package and a file name."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, display_path, joined, phrase
from linkwright.launch.arguments import parse_arguments
from linkwright.packages import PackageFinder
from linkwright.packages.launch_files import is_launch_file_name, launch_files_below


@dataclass(frozen=True)
class LaunchTarget:
    """A launch file as the user names it.

    Attributes:
        file: the path of the file. If a package is given: the file's name, or its path below the package's share
            folder.
        package: the package, or None.
    """

    file: str
    package: str | None = None

    def finder(self) -> PackageFinder:
        """Return a package finder that starts in the launch file's folder and the current folder."""
        if self.package is None:
            return PackageFinder(start=[Path(self.file).absolute().parent, Path.cwd()])
        return PackageFinder()

    def resolve(self, finder: PackageFinder) -> Path:
        """Return the absolute path of the launch file.

        Raises:
            LinkwrightError: PKG101, there is no such package; LAUNCH101, the package has no such file, or several.
        """
        if self.package is None:
            return Path(self.file).absolute()
        share = finder.share(self.package)
        for path in (share / self.file, share / "launch" / self.file):
            if path.is_file():
                return path
        return self._search(share)

    def _search(self, share: Path) -> Path:
        present = launch_files_below(share)
        found = [path for path in present if path.name == self.file]
        if len(found) == 1:
            return found[0]
        if found:
            message = phrase(
                "package '{package}' has several launch files '{file}'", package=self.package, file=self.file
            )
            listed = ", ".join(str(path.relative_to(share)) for path in found)
            raise LinkwrightError(
                Diagnostic("LAUNCH101", message, hint=phrase("give the path of one of them: {listed}", listed=listed))
            )
        names = [path.name for path in present]
        message = phrase(
            "package '{package}' has no launch file '{file}' (in {share})",
            package=self.package,
            file=self.file,
            share=display_path(share),
        )
        hint = did_you_mean(self.file, names)
        if hint is None:
            hint = (
                phrase("it has {names}", names=joined(names))
                if names
                else phrase("it has no launch files; does its setup.py install them?")
            )
        raise LinkwrightError(Diagnostic("LAUNCH101", message, hint=hint))


def parse_launch_words(words: Sequence[str]) -> tuple[LaunchTarget, dict[str, str]]:
    """Parse a command line that names a launch file and its arguments.

    The forms are ``launch PACKAGE FILE [name:=value ...]`` and ``launch PATH [name:=value ...]``.

    Args:
        words: the arguments after ``launch``.

    Returns:
        The launch file, and the values of the launch arguments by name.

    Raises:
        LinkwrightError: LAUNCH110, no launch file is named; LAUNCH111, arguments are malformed.
    """
    split = next((index for index, word in enumerate(words) if ":=" in word), len(words))
    split = min(split, 2)
    if split == 2 and _is_file(words[0]):  # the second word is probably a malformed launch argument
        split = 1
    named, rest = words[:split], words[split:]
    arguments = parse_arguments(rest)
    if not named:
        raise _incomplete(
            phrase("no launch file is given"), phrase("name a PACKAGE and a FILE in it, or the PATH of a launch file")
        )
    if len(named) == 1:
        if not _is_file(named[0]) and not _is_path(named[0]):
            files = [path.name for path in _files_of_package(named[0])]
            if files:
                hint = phrase("it has {names}", names=joined(files))
                raise _incomplete(phrase("'{named}' is a package: also name a launch file in it", named=named[0]), hint)
        return LaunchTarget(named[0]), arguments
    return LaunchTarget(named[1], named[0]), arguments


def _is_file(word: str) -> bool:
    return Path(word).is_file()


def _is_path(word: str) -> bool:
    return os.sep in word or is_launch_file_name(word) or word.endswith((".py", ".xml", ".yaml"))


def _files_of_package(name: str) -> list[Path]:
    share = PackageFinder().find(name)
    return [] if share is None else launch_files_below(share)


def _incomplete(message: Phrase, hint: Phrase) -> LinkwrightError:
    return LinkwrightError(Diagnostic("LAUNCH110", message, hint=hint))
