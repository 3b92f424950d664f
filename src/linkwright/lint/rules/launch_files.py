"""Rules about Python launch files and the files that they name.

Launch files are parsed but never executed.
"""

from __future__ import annotations

import re
from abc import abstractmethod
from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Phrase, Severity, foreign, nearest, phrase, quoted
from linkwright.lint.made_files import is_made_later
from linkwright.lint.rule import Rule, Scope
from linkwright.lint.rules.package_manifest import PackageRule
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import is_substitute

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext
    from linkwright.packages.readers.launch_files import LaunchFile, SharedFile

_FILE = lazy_pattern(r"[^/]*\.[A-Za-z0-9]{1,8}$")


_COMMENT = lazy_pattern(r"#.*")


class LaunchRule(PackageRule):
    """The base class of rules that check each launch file of a package."""

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield the findings in all launch files of a package."""
        for file in package.launch_files.values():
            yield from self.check_launch(file)

    @abstractmethod
    def check_launch(self, file: LaunchFile) -> Iterator[Diagnostic]:
        """Yield the findings in a launch file."""


class LaunchSyntaxError(LaunchRule):
    """A launch file is not Python.

    ## Why

    `ros2 launch` cannot run a file with a syntax error.

    ## Example

    ```python
    return LaunchDescription([
        robot_state_publisher
        rviz,
    ])
    ```

    ## Use instead

    ```python
    return LaunchDescription([
        robot_state_publisher,
        rviz,
    ])
    ```
    """

    code = "LW840"
    name = "launch-syntax-error"
    severity = Severity.ERROR

    def check_launch(self, file: LaunchFile) -> Iterator[Diagnostic]:
        """Yield a finding if a launch file has a syntax error."""
        if file.error is not None:
            message = phrase(
                "the launch file '{path}' is not Python: {message}", path=file.path, message=foreign(file.error.message)
            )
            yield self.report(message, span=file.error.span, source=file.source)


class LaunchFunctionMissing(LaunchRule):
    """A launch file does not define ``generate_launch_description``.

    ## Why

    `ros2 launch` calls this function and no other. Tests for launch_testing, launch_pytest and pytest are not reported,
    because they define other functions. Modules of a Python package (next to an `__init__.py`) are not reported either.
    For a file without statements, which is unfinished or disabled, the finding is only an information.

    ## Example

    ```python
    def generate_launch_desciption():
        return LaunchDescription([])
    ```

    ## Use instead

    ```python
    def generate_launch_description():
        return LaunchDescription([])
    ```
    """

    code = "LW841"
    name = "launch-function-missing"
    severity = Severity.ERROR

    def check_launch(self, file: LaunchFile) -> Iterator[Diagnostic]:
        """Yield a finding if a launch file does not define ``generate_launch_description``."""
        if file.python is None or file.has_function or file.is_test:
            return
        if Path(file.source.name).with_name("__init__.py").is_file():
            return
        from linkwright.packages.readers.launch_files import FUNCTION

        functions = re.findall(r"^def\s+(\w+)", file.source.text, re.MULTILINE)
        like = next(iter(nearest(FUNCTION, functions, 1)), None)
        hint = (
            phrase("'{like}' looks misspelt", like=like)
            if like
            else phrase("define {function}(), which returns a LaunchDescription", function=FUNCTION)
        )
        span = file.source.span(0)
        if like:
            at = file.source.text.index(like)
            span = file.source.span(at, at + len(like))
        message = phrase("the launch file '{path}' does not define {function}()", path=file.path, function=FUNCTION)
        # Without a similarly named function, the file may be a module that other launch files import.
        severity = Severity.ERROR if like else Severity.WARNING
        if not _COMMENT.sub("", file.source.text).strip():
            severity = Severity.INFO
        yield self.report(message, span=span, source=file.source, hint=hint, severity=severity)


class LaunchedFileMissing(Rule):
    """A launch file names a file that does not exist in its package.

    ## Why

    The launch fails, or the node starts without its file. Files that are probably created later are not reported: maps,
    files that git ignores, files that the launch file itself writes, and files that a script or a README of the package
    mentions.

    ## Example

    ```python
    model = get_package_share_path('my_robot_description') / 'urdf/mbot.urdf'
    ```

    in a package whose file is called `urdf/mbot_base.urdf`.

    ## Use instead

    ```python
    model = get_package_share_path('my_robot_description') / 'urdf/mbot_base.urdf'
    ```
    """

    code = "LW842"
    name = "launched-file-missing"
    scope = Scope.PACKAGE

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        package = subject.package
        if package is None:
            return
        made = {item for file in package.launch_files.values() for item in file.made}
        for file in package.launch_files.values():
            for shared in file.paths:
                if (shared.package, shared.path) not in made:
                    yield from self._check_path(shared, file, package, subject)

    def _check_path(
        self, shared: SharedFile, file: LaunchFile, package: PackageContext, subject: Subject
    ) -> Iterator[Diagnostic]:
        if not _FILE.search(shared.path) or "*" in shared.path:
            return
        own = shared.package == package.name
        share = package.folder if own else subject.finder.find(shared.package)
        if share is None or (share / shared.path).exists() or (own and _is_installed_as(package, shared)):
            return
        name = shared.path.rpartition("/")[2]
        if not own and (share.parent.name != "share" or is_substitute(share)):
            return  # another package found as sources may install its files elsewhere, or only some of them
        sources = None if own else subject.finder.find_in_sources(shared.package)
        if sources is not None and (sources / shared.path).exists():
            return  # the installed copy may be older than this file
        if own and any(other.rpartition("/")[2] == name for other in package.files) and _may_move(package):
            return
        if own and is_made_later(package, shared.path):
            return
        message = phrase("the package '{package}' has no file '{path}'", package=shared.package, path=shared.path)
        yield self.report(message, span=shared.span, source=file.source, hint=_like(package, shared) if own else None)


def _is_installed_as(package: PackageContext, shared: SharedFile) -> bool:
    """Return whether ``setup.py`` installs a file of the package at this path."""
    folder, _, name = shared.path.rpartition("/")
    setup = package.setup
    if setup is None:
        return False
    destination = f"share/{package.name}/{folder}".rstrip("/")
    return any(
        item.destination is not None
        and item.destination.rstrip("/") == destination
        and any(file.rpartition("/")[2] == name for file in item.files(package.folder))
        for item in setup.installed
    )


def _may_move(package: PackageContext) -> bool:
    """Return whether files may be installed in folders other than their source folders."""
    setup = package.setup
    if setup is not None:
        return not setup.is_complete or any(item.destination is None for item in setup.installed)
    return True


def _like(package: PackageContext, shared: SharedFile) -> Phrase | None:
    name = shared.path.rpartition("/")[2]
    same = [file for file in package.files if file.rpartition("/")[2] == name]
    if same:
        return phrase("did you mean '{same}'?", same=same[0])
    like = nearest(shared.path, package.files, 1)
    return phrase("did you mean {names}?", names=quoted(like[0])) if like else None
