"""The sets of argument values with which a description is expanded."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path

from linkwright.descriptions.argument_sets.workspace import CallingFiles
from linkwright.diagnostics import Span
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass, replace
from linkwright.packages import PackageFinder, enclosing_package
from linkwright.packages.readers.xacro_calls.call import (
    CallingFile,
    Inclusion,
    XacroCall,
    launch_choice,
    launch_names,
)
from linkwright.packages.readers.xacro_calls.texts import (
    MOST_SETS,
    Open,
    Selection,
    Share,
    Text,
    resolve,
    selections,
    share_mark,
    split_mark,
    variations,
)

_DEEPEST = 4
_MOST_LAUNCHES = 16
_MARK = lazy_pattern("\0([^\0]*)\0")


@dataclass(frozen=True, slots=True)
class ArgumentSet:
    """The values that a caller passes to the arguments of a description in one call.

    Attributes:
        values: the values, by argument name.
        open: the names of the arguments whose values are known only at runtime. An empty name represents arguments
            whose names are also unknown.
        span: the location of the call, or None for values of a configuration.
        is_certain: whether the values are known to occur in combination.
        varied: the names of the arguments whose values differ from those that the same call passes by default.
        is_mixed: whether a launch argument selects another file than by default, and other arguments also differ from
            their defaults, so that their values may not fit this file.
        is_offered: whether the values are choices that launch arguments offer, while the other arguments have their
            defaults.
    """

    values: Mapping[str, str]
    open: tuple[str, ...] = ()
    span: Span | None = None
    is_certain: bool = True
    varied: tuple[str, ...] = ()
    is_mixed: bool = False
    is_offered: bool = False

    @property
    def is_complete(self) -> bool:
        """Whether all values are known and certain to occur in combination."""
        return self.is_certain and not self.open


def argument_sets(path: str | Path, finder: PackageFinder | None = None) -> tuple[ArgumentSet, ...]:
    """Return the sets of values that launch files, tests and build files pass to a description.

    The search covers the files of the description's package and of neighbouring packages that depend on it. If these
    have no argument sets, it continues in the other neighbouring packages. No file is executed.

    Args:
        path: the file of the description.
        finder: the finder of packages; by default, it finds those around the file.

    Returns:
        The sets without duplicates, the most certain ones first. A call without values has an empty set.
    """
    return ArgumentSets().of(Path(path), finder)


class ArgumentSets:
    """The search for the argument sets of many descriptions, which reads each calling file once.

    Args:
        folders: packages to search in addition to those near a file.
    """

    def __init__(self, folders: Iterable[Path] = ()) -> None:
        self._folders = tuple(folders)
        self._files = CallingFiles()

    def of(self, path: Path, finder: PackageFinder | None = None) -> tuple[ArgumentSet, ...]:
        """Return the argument sets of a description; see `argument_sets`."""
        path = Path(os.path.abspath(path))  # noqa: PTH100 - links stay what they are
        finder = finder or PackageFinder(start=path.parent)
        near = list(self._files.around(path, self._folders))
        sets = list(_CalledDescription(path, finder, near).sets())
        if not sets:  # A launch file may use a package that is not a declared dependency.
            sets = list(_CalledDescription(path, finder, [*near, *self._files.elsewhere(path, self._folders)]).sets())
        found: dict[object, ArgumentSet] = {}
        for argument_set in sets:
            key = (tuple(sorted(argument_set.values.items())), argument_set.open)
            known = found.get(key)
            if known is None:
                found[key] = argument_set
            else:
                certain, offered = (
                    argument_set.is_certain or known.is_certain,
                    argument_set.is_offered and known.is_offered,
                )
                found[key] = replace(known, is_certain=certain, is_offered=offered)
        best = sorted(found.values(), key=lambda argument_set: (not argument_set.is_complete, bool(argument_set.open)))
        complete = [argument_set for argument_set in best if argument_set.is_complete][:MOST_SETS]
        return (*complete, *[argument_set for argument_set in best if not argument_set.is_complete][:MOST_SETS])


@dataclass(eq=False)
class _CalledDescription:
    """A description, and the files that may expand it, each with the name of the file's package."""

    path: Path
    finder: PackageFinder
    files: list[tuple[str | None, CallingFile]]

    def sets(self) -> Iterator[ArgumentSet]:
        """Yield the argument sets of all calls."""
        for package, file in self.files:
            calls = [call for call in file.calls if self._may_be(call.path)]
            if not calls:
                continue
            launches = self._launches(package, file)
            for call in calls:
                for given in launches:
                    yield from self._of_call(call, file, given)

    def _of_call(self, call: XacroCall, file: CallingFile, given: Mapping[str, str]) -> Iterator[ArgumentSet]:
        first: ArgumentSet | None = None
        for selection in selections(call.path, file.choices, given):
            written = resolve(call.path, file.choices, selection)
            if written is None or not self._is_target(_unquoted(written) if call.is_command else written, file):
                continue
            for taken, certain in variations(call.arguments.values(), file.choices, selection):
                found = self._set(call, file, taken, is_certain=certain)
                first = first or found
                apart = {name for name, row in taken.rows.items() if row != selection.rows.get(name, 0)}
                yield replace(
                    found,
                    varied=_varied(call, found, first),
                    is_mixed=any(selection.rows.values()) and bool(apart),
                    is_offered=bool(apart) and apart <= launch_names(file.choices).keys(),
                )
        if first is None and _is_open(call.path):
            yield self._set(call, file, Selection({}, given), is_certain=False)

    def _set(self, call: XacroCall, file: CallingFile, selection: Selection, *, is_certain: bool) -> ArgumentSet:
        values: dict[str, str] = {}
        missing: list[str] = []
        for name, text in call.arguments.items():
            value = resolve(text, file.choices, selection)
            value = None if value is None else self._with_folders(value)
            if value is None:
                missing.append(name)
            elif not name:
                words = (word.partition(":=") for word in (_words(value) if call.is_command else value.split()))
                values.update((word, text) for word, sign, text in words if sign)
            else:
                values[name] = _unquoted(value) if call.is_command else value
        return ArgumentSet(values, tuple(missing), call.span, is_certain)

    # --- which file is meant --------------------------------------------------------------------------------

    def _may_be(self, path: Text) -> bool:
        """Return whether a path with unknown parts may be the description."""
        pattern = "".join(re.escape(piece) if isinstance(piece, str) else "\0" for piece in path)
        if "/" not in pattern.strip("\0") and not pattern.strip("\0").endswith(re.escape(self.path.name)):
            # Without a fixed part, any file could be meant; accept only a path that is entirely unknown.
            return len(path) == 1 and pattern == "\0"
        expression = "(^|.*/)" + pattern.lstrip("\0/").replace("\0", ".*").removeprefix("\\./")
        return re.fullmatch(expression, self.path.as_posix()) is not None

    def _is_target(self, written: str, file: CallingFile) -> bool:
        """Return whether a path without unknown parts is the path of the description."""
        package, rest = split_mark(written)
        if _MARK.search(rest):
            return False  # A share folder in the middle of a path is not supported.
        if package is None:
            return self._is_same(Path(os.path.dirname(file.path), written)) or self._is_same(Path(written))  # noqa: PTH120
        own = enclosing_package(self.path.parent)
        if own is not None and own[0] == package and self._is_same(own[1] / rest.lstrip("/")):
            return True
        share = self.finder.find(package)
        return share is not None and self._is_same(share / rest.lstrip("/"))

    def _is_same(self, path: Path) -> bool:
        return os.path.realpath(path) == os.path.realpath(self.path)

    def _with_folders(self, value: str) -> str | None:
        """Return a value in which share folders replace the marks of packages.

        The result is None if a package is not found.
        """
        for package in _MARK.findall(value):
            share = self.finder.find(package)
            if share is None:
                return None
            value = value.replace(share_mark(package), str(share))
        return value

    # --- launch arguments -----------------------------------------------------------------------------------

    def _launches(self, package: str | None, file: CallingFile, depth: int = 0) -> list[dict[str, str]]:
        """Return the launch arguments with which a file is launched, directly or by including files.

        Returns:
            For each way to launch the file, the given values by the names of their choices.
        """
        found: list[dict[str, str]] = [{}]
        if depth >= _DEEPEST:
            return found
        for named, by, other, inclusion in self._inclusions.get(Path(file.path).name, ()):
            if named not in (None, package):
                continue
            for given in self._launches(by, other, depth + 1):
                selection = Selection({}, given)
                texts = {launch_choice(name): text for name, text in inclusion.arguments.items()}
                inherited = {name: (Open(name),) for name in launch_names(other.choices)}
                values = {
                    name: value
                    for name, text in {**inherited, **texts}.items()
                    if (value := resolve(text, other.choices, selection)) is not None
                }
                if values not in found and len(found) < _MOST_LAUNCHES:
                    found.append({**given, **values})
        return found

    @cached_property
    def _inclusions(self) -> dict[str, list[tuple[str | None, str | None, CallingFile, Inclusion]]]:
        """The inclusions of launch files, by the name of the included file.

        An inclusion is a tuple of the package in the path, the including package, the including file, and the inclusion
        itself.
        """
        found: dict[str, list[tuple[str | None, str | None, CallingFile, Inclusion]]] = {}
        for package, file in self.files:
            for named, name, inclusion in file.included:
                found.setdefault(name, []).append((named, package, file, inclusion))
        return found


def _is_open(path: Text) -> bool:
    """Return whether a path has a part that is not known before runtime."""
    return any(_is_open(piece.package) if isinstance(piece, Share) else isinstance(piece, Open) for piece in path)


def _varied(call: XacroCall, one: ArgumentSet, other: ArgumentSet) -> tuple[str, ...]:
    """Return the names of the arguments that differ between two sets.

    If some of these arguments are plain choices, the result is limited to them. Texts composed of choices, such as
    paths, are then left out.
    """
    names = tuple(name for name, value in one.values.items() if other.values.get(name) != value)
    return tuple(name for name in names if len(call.arguments.get(name, ())) == 1) or names


def _unquoted(value: str) -> str:
    """Return a command-line value without its quotes."""
    return "".join(_words(value)) if set(value) & {'"', "'"} else value


def _words(line: str) -> list[str]:
    """Return the words of a part of a command line, without their quotes."""
    import shlex  # imported here because quotes are rare

    try:
        return shlex.split(line)
    except ValueError:
        return [line]
