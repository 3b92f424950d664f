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
    find_launch_names,
    name_launch_choice,
)
from linkwright.packages.readers.xacro_calls.texts import (
    MAX_VARIATIONS,
    Placeholder,
    Selection,
    Share,
    Text,
    generate_selections,
    generate_variations,
    make_share_mark,
    resolve,
    split_mark,
)

_MAX_DEPTH = 4
_MAX_LAUNCHES = 16
_PACKAGE_MARK = lazy_pattern("\0([^\0]*)\0")


@dataclass(frozen=True, slots=True)
class ArgumentSet:
    """The values that a caller passes to the arguments of a description in one call.

    Attributes:
        values: the values, by argument name.
        runtime_names: the names of the arguments whose values are known only at runtime. An empty name represents
            arguments whose names are also unknown.
        span: the location of the call, or None for values of a configuration.
        is_certain: whether the values are known to occur in combination.
        varied: the names of the arguments whose values differ from the default values of the same call.
        is_mixed: whether a launch argument selects another file than by default, and other arguments also differ from
            their defaults, so that their values may not fit this file.
        is_offered: whether the values are choices that launch arguments offer, while the other arguments have their
            defaults.
    """

    values: Mapping[str, str]
    runtime_names: tuple[str, ...] = ()
    span: Span | None = None
    is_certain: bool = True
    varied: tuple[str, ...] = ()
    is_mixed: bool = False
    is_offered: bool = False

    @property
    def is_complete(self) -> bool:
        """Whether all values are known and certain to occur in combination."""
        return self.is_certain and not self.runtime_names


def argument_sets(path: str | Path, finder: PackageFinder | None = None) -> tuple[ArgumentSet, ...]:
    """Return the sets of values that launch files, tests and build files pass to a description.

    The search covers the files of the description's package and of neighboring packages that depend on it. If these
    packages have no argument sets, the search continues in the other neighboring packages. No file is executed.

    Args:
        path: the file of the description.
        finder: the finder of packages; by default, a finder that searches around the file.

    Returns:
        The sets without duplicates, the most certain sets first. A call without values has an empty set.
    """
    return ArgumentSets().of(Path(path), finder)


class ArgumentSets:
    """A search for the argument sets of many descriptions that reads each calling file once.

    Args:
        folders: packages to search in addition to the packages near a file.
    """

    def __init__(self, folders: Iterable[Path] = ()) -> None:
        self._folders = tuple(folders)
        self._files = CallingFiles()

    def of(self, path: Path, finder: PackageFinder | None = None) -> tuple[ArgumentSet, ...]:
        """Return the argument sets of a description; see `argument_sets`."""
        path = Path(os.path.abspath(path))  # noqa: PTH100 - do not resolve links
        finder = finder or PackageFinder(start=path.parent)
        nearby_files = list(self._files.nearby_calling_files(path, self._folders))
        sets = list(_CalledDescription(path, finder, nearby_files).sets())
        if not any(argument_set.values for argument_set in sets):
            # A launch file may use a package that is not a declared dependency.
            sets = list(
                _CalledDescription(
                    path, finder, [*nearby_files, *self._files.distant_calling_files(path, self._folders)]
                ).sets()
            )
        merged: dict[object, ArgumentSet] = {}
        for argument_set in sets:
            key = (tuple(sorted(argument_set.values.items())), argument_set.runtime_names)
            previous = merged.get(key)
            if previous is None:
                merged[key] = argument_set
            else:
                is_certain, is_offered = (
                    argument_set.is_certain or previous.is_certain,
                    argument_set.is_offered and previous.is_offered,
                )
                merged[key] = replace(previous, is_certain=is_certain, is_offered=is_offered)
        sorted_sets = sorted(
            merged.values(), key=lambda argument_set: (not argument_set.is_complete, bool(argument_set.runtime_names))
        )
        complete = [argument_set for argument_set in sorted_sets if argument_set.is_complete][:MAX_VARIATIONS]
        return (
            *complete,
            *[argument_set for argument_set in sorted_sets if not argument_set.is_complete][:MAX_VARIATIONS],
        )


@dataclass(eq=False)
class _CalledDescription:
    """A description, and the files that may expand it, each with its package name."""

    path: Path
    finder: PackageFinder
    files: list[tuple[str | None, CallingFile]]

    def sets(self) -> Iterator[ArgumentSet]:
        """Yield the argument sets of all calls."""
        for package, file in self.files:
            calls = [call for call in file.calls if self._may_match(call.path)]
            if not calls:
                continue
            launches = self._find_launches(package, file)
            for call in calls:
                for launch_values in launches:
                    yield from self._generate_sets(call, file, launch_values)

    def _generate_sets(
        self, call: XacroCall, file: CallingFile, launch_values: Mapping[str, str]
    ) -> Iterator[ArgumentSet]:
        first_set: ArgumentSet | None = None
        for selection in generate_selections(call.path, file.choices, launch_values):
            path = resolve(call.path, file.choices, selection)
            if path is None or not self._is_target(_strip_quotes(path) if call.is_command else path, file):
                continue
            selection = file.with_conditional_defaults(selection)
            for variation, is_certain in generate_variations(call.arguments.values(), file.choices, selection):
                argument_set = self._make_argument_set(call, file, variation, is_certain=is_certain)
                first_set = first_set or argument_set
                changed_choices = {name for name, row in variation.rows.items() if row != selection.rows.get(name, 0)}
                yield replace(
                    argument_set,
                    varied=_find_varied_arguments(call, argument_set, first_set),
                    is_mixed=any(selection.rows.values()) and bool(changed_choices),
                    is_offered=bool(changed_choices) and changed_choices <= find_launch_names(file.choices).keys(),
                )
        if first_set is None and _has_placeholder(call.path):
            found = self._select_this_file(call, file, launch_values)
            if found is not None:
                values = file.with_conditional_defaults(found)
                yield self._make_argument_set(call, file, values, is_certain=False)

    def _select_this_file(
        self, call: XacroCall, file: CallingFile, launch_values: Mapping[str, str]
    ) -> Selection | None:
        """Return the values with which the path of a call may be the description, or None if there are none.

        Only values that conditions name are tried, the longest first, because one may be the beginning of another.
        """
        conditions = {(default.choice, default.value) for default in file.list_conditional_defaults()}
        is_tried = False
        for name, value in sorted(conditions, key=lambda item: (-len(item[1]), item)):
            path = tuple(
                value if isinstance(piece, Placeholder) and piece.choice == name else piece for piece in call.path
            )
            if path != call.path and name not in launch_values:
                is_tried = True
                if self._may_match(path):
                    return Selection({}, {**launch_values, name: value})
        return None if is_tried else Selection({}, launch_values)

    def _make_argument_set(
        self, call: XacroCall, file: CallingFile, selection: Selection, *, is_certain: bool
    ) -> ArgumentSet:
        values: dict[str, str] = {}
        unknown_names: list[str] = []
        for name, text in call.arguments.items():
            value = resolve(text, file.choices, selection)
            value = None if value is None else self._replace_marks(value)
            if value is None:
                unknown_names.append(name)
            elif not name:
                assignments = (
                    word.partition(":=") for word in (_split_words(value) if call.is_command else value.split())
                )
                values.update((word, text) for word, sign, text in assignments if sign)
            else:
                values[name] = _strip_quotes(value) if call.is_command else value
        return ArgumentSet(values, tuple(unknown_names), call.span, is_certain)

    # --- matching of paths ----------------------------------------------------------------------------------

    def _may_match(self, path: Text) -> bool:
        """Return whether a path with unknown parts may be the description."""
        pattern = "".join(re.escape(piece) if isinstance(piece, str) else "\0" for piece in path)
        if "/" not in pattern.strip("\0") and not pattern.strip("\0").endswith(re.escape(self.path.name)):
            # Without a fixed part, any file could be meant; accept only a path that is entirely unknown.
            return len(path) == 1 and pattern == "\0"
        expression = "(^|.*/)" + pattern.lstrip("\0/").replace("\0", ".*").removeprefix("\\./")
        return re.fullmatch(expression, self.path.as_posix()) is not None

    def _is_target(self, path_text: str, file: CallingFile) -> bool:
        """Return whether a path without unknown parts is the path of the description."""
        package, relative_path = split_mark(path_text)
        if _PACKAGE_MARK.search(relative_path):
            return False  # A share folder in the middle of a path is not supported.
        if package is None:
            return self._is_same(Path(os.path.dirname(file.path), path_text)) or self._is_same(Path(path_text))  # noqa: PTH120
        own_package = enclosing_package(self.path.parent)
        if (
            own_package is not None
            and own_package[0] == package
            and self._is_same(own_package[1] / relative_path.lstrip("/"))
        ):
            return True
        share = self.finder.find(package)
        return share is not None and self._is_same(share / relative_path.lstrip("/"))

    def _is_same(self, path: Path) -> bool:
        return os.path.realpath(path) == os.path.realpath(self.path)

    def _replace_marks(self, value: str) -> str | None:
        """Replace the marks of packages in a value by their share folders.

        The result is None if a package is not found.
        """
        for package in _PACKAGE_MARK.findall(value):
            share = self.finder.find(package)
            if share is None:
                return None
            value = value.replace(make_share_mark(package), str(share))
        return value

    # --- launch arguments -----------------------------------------------------------------------------------

    def _find_launches(self, package: str | None, file: CallingFile, depth: int = 0) -> list[dict[str, str]]:
        """Return the launch arguments of a file, for each way in which it is launched.

        Returns:
            For each way to launch the file, the values of the launch arguments, by the names of their choices.
        """
        launches: list[dict[str, str]] = [{}]
        if depth >= _MAX_DEPTH:
            return launches
        for package_in_path, including_package, including_file, inclusion in self._inclusions.get(
            Path(file.path).name, ()
        ):
            if package_in_path not in (None, package):
                continue
            for outer_values in self._find_launches(including_package, including_file, depth + 1):
                selection = Selection({}, outer_values)
                texts = {name_launch_choice(name): text for name, text in inclusion.arguments.items()}
                inherited_texts = {name: (Placeholder(name),) for name in find_launch_names(including_file.choices)}
                values = {
                    name: value
                    for name, text in {**inherited_texts, **texts}.items()
                    if (value := resolve(text, including_file.choices, selection)) is not None
                }
                if values not in launches and len(launches) < _MAX_LAUNCHES:
                    launches.append({**outer_values, **values})
        return launches

    @cached_property
    def _inclusions(self) -> dict[str, list[tuple[str | None, str | None, CallingFile, Inclusion]]]:
        """The inclusions of launch files, by the name of the included file.

        Each value lists tuples: the package in the path, the including package, the including file, and the
        `Inclusion`.
        """
        inclusions: dict[str, list[tuple[str | None, str | None, CallingFile, Inclusion]]] = {}
        for package, file in self.files:
            for package_in_path, name, inclusion in file.included_names:
                inclusions.setdefault(name, []).append((package_in_path, package, file, inclusion))
        return inclusions


def _has_placeholder(path: Text) -> bool:
    """Return whether a path has a part that is not known before runtime."""
    return any(
        _has_placeholder(piece.package) if isinstance(piece, Share) else isinstance(piece, Placeholder)
        for piece in path
    )


def _find_varied_arguments(call: XacroCall, argument_set: ArgumentSet, reference_set: ArgumentSet) -> tuple[str, ...]:
    """Return the names of the arguments that differ between two sets.

    If some of these arguments are plain choices, the result is limited to them. Texts composed of choices, such as
    paths, are then left out.
    """
    names = tuple(name for name, value in argument_set.values.items() if reference_set.values.get(name) != value)
    return tuple(name for name in names if len(call.arguments.get(name, ())) == 1) or names


def _strip_quotes(value: str) -> str:
    """Return a command-line value without its quotes."""
    return "".join(_split_words(value)) if set(value) & {'"', "'"} else value


def _split_words(line: str) -> list[str]:
    """Return the words of a part of a command line, without their quotes."""
    import shlex  # imported here because quotes are rare

    try:
        return shlex.split(line)
    except ValueError:
        return [line]
