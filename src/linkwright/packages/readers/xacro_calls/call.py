"""Records of a file's xacro calls, included launch files, and the possible values of open places."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

from linkwright.diagnostics import Span
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.packages.readers.xacro_calls.texts import Choice, Open, Selection, Text, resolve, split_mark

_LAUNCH = "launch:"


@dataclass(frozen=True, slots=True)
class XacroCall:
    """A call that expands a description.

    Attributes:
        path: the path of the description.
        arguments: name -> value.
        span: the place of the call.
        is_command: whether the call is a command line, whose quotes are removed.
    """

    path: Text
    arguments: Mapping[str, Text]
    span: Span
    is_command: bool = False


@dataclass(frozen=True, slots=True)
class Inclusion:
    """A launch file that another includes.

    Attributes:
        path: the file.
        arguments: name -> value of the launch arguments that are passed to it.
    """

    path: Text
    arguments: Mapping[str, Text]


@dataclass
class CallingFile:
    """The calls and inclusions of one file.

    Attributes:
        path: the file.
        calls: the xacro calls in the file.
        inclusions: the launch files that it includes.
        choices: name -> the possible values of open places.
    """

    path: str
    calls: list[XacroCall] = field(default_factory=list)
    inclusions: list[Inclusion] = field(default_factory=list)
    choices: dict[str, Choice] = field(default_factory=dict)

    @cached_property
    def included(self) -> list[tuple[str | None, str, Inclusion]]:
        """Each inclusion, preceded by the package that its path begins with, or None, and the file name."""
        found: list[tuple[str | None, str, Inclusion]] = []
        for inclusion in self.inclusions:
            last = inclusion.path[-1] if inclusion.path and isinstance(inclusion.path[-1], str) else ""
            package, rest = split_mark(resolve(inclusion.path, self.choices, Selection()) or last)
            found.append((package, rest.rpartition("/")[2], inclusion))
        return found

    def declare(self, name: str, default: Text | None, others: tuple[Text, ...] = ()) -> None:
        """Record a launch argument with its default and its other possible values."""
        values = dict.fromkeys((*(() if default is None else (default,)), *others))
        known = self.choices.get(_LAUNCH + name)
        if values and (known is None or len(known.rows) < len(values)):
            self.choices[_LAUNCH + name] = Choice(tuple((value,) for value in values))


def launch_argument(name: str) -> Open:
    """Return the open place of a launch argument."""
    return Open(_LAUNCH + name)


def launch_choice(name: str) -> str:
    """Return the name of the choice that represents a launch argument."""
    return _LAUNCH + name


def launch_names(choices: Mapping[str, Choice]) -> dict[str, str]:
    """Return the launch arguments among choices: name of the choice -> name of the argument."""
    return {name: name.removeprefix(_LAUNCH) for name in choices if name.startswith(_LAUNCH)}
