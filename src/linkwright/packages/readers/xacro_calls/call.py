"""Records of the xacro calls and included launch files in a file.

The texts in these records may contain placeholders with several possible values.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

from linkwright.diagnostics import Span
from linkwright.loading.lean_dataclasses import dataclass, field, replace
from linkwright.packages.readers.xacro_calls.texts import Choice, Placeholder, Selection, Text, resolve, split_mark

_LAUNCH_PREFIX = "launch:"


@dataclass(frozen=True, slots=True)
class XacroCall:
    """A call that expands a description.

    Attributes:
        path: the path of the description.
        arguments: name -> value of the xacro arguments.
        span: the location of the call.
        is_command: whether the call is a command line; if so, quotes are removed from its arguments.
    """

    path: Text
    arguments: Mapping[str, Text]
    span: Span
    is_command: bool = False


@dataclass(frozen=True, slots=True)
class Inclusion:
    """The inclusion of a launch file by another launch file.

    Attributes:
        path: the path of the included file.
        arguments: name -> value of the launch arguments that are passed to the included file.
    """

    path: Text
    arguments: Mapping[str, Text]


@dataclass(frozen=True, slots=True)
class ConditionalDefault:
    """A default of a launch argument that holds only if another launch argument has a value, or has another one.

    Attributes:
        choice: the choice of the other argument.
        value: the value.
        is_equal: whether the other argument must have the value.
        default: the default.
    """

    choice: str
    value: str
    is_equal: bool
    default: Text


@dataclass
class CallingFile:
    """The xacro calls and inclusions in one file.

    Attributes:
        path: the path of the file.
        calls: the xacro calls in the file.
        inclusions: the launch files that the file includes.
        choices: name -> the possible values of placeholders.
        conditional_defaults: name of a choice -> the defaults of its launch argument under different conditions.
    """

    path: str
    calls: list[XacroCall] = field(default_factory=list)
    inclusions: list[Inclusion] = field(default_factory=list)
    choices: dict[str, Choice] = field(default_factory=dict)
    conditional_defaults: dict[str, list[ConditionalDefault]] = field(default_factory=dict)

    @cached_property
    def included_names(self) -> list[tuple[str | None, str, Inclusion]]:
        """Each inclusion, with the package and the file name of its path.

        The package is None if the path does not begin with the share folder of a package.
        """
        inclusions: list[tuple[str | None, str, Inclusion]] = []
        for inclusion in self.inclusions:
            last_piece = inclusion.path[-1] if inclusion.path and isinstance(inclusion.path[-1], str) else ""
            package, subpath = split_mark(resolve(inclusion.path, self.choices, Selection()) or last_piece)
            inclusions.append((package, subpath.rpartition("/")[2], inclusion))
        return inclusions

    def declare(self, name: str, default: Text | None, other_values: tuple[Text, ...] = ()) -> None:
        """Record a launch argument with its default and its other possible values."""
        values = dict.fromkeys((*(() if default is None else (default,)), *other_values))
        existing = self.choices.get(_LAUNCH_PREFIX + name)
        if values and (existing is None or len(existing.rows) < len(values)):
            self.choices[_LAUNCH_PREFIX + name] = Choice(tuple((value,) for value in values))

    def with_conditional_defaults(self, selection: Selection) -> Selection:
        """Return a selection with the defaults whose conditions hold for the values that it selects."""
        fixed_texts = dict(selection.fixed_texts)
        for name, defaults in self.conditional_defaults.items():
            holding = [default for default in defaults if self._holds(default, selection)]
            value = resolve(holding[0].default, self.choices, selection) if len(holding) == 1 else None
            if value is not None and name not in selection.rows:
                fixed_texts.setdefault(name, value)
        return replace(selection, fixed_texts=fixed_texts)

    def list_conditional_defaults(self) -> list[ConditionalDefault]:
        """Return the conditional defaults of all launch arguments."""
        return [default for defaults in self.conditional_defaults.values() for default in defaults]

    def _holds(self, default: ConditionalDefault, selection: Selection) -> bool:
        """Return whether the condition of a default certainly holds."""
        if default.choice not in selection.rows and default.choice not in selection.fixed_texts:
            return False
        value = resolve((Placeholder(default.choice),), self.choices, selection)
        return value is not None and (value == default.value) == default.is_equal


def make_launch_argument(name: str) -> Placeholder:
    """Return the placeholder for the value of a launch argument."""
    return Placeholder(_LAUNCH_PREFIX + name)


def name_launch_choice(name: str) -> str:
    """Return the name of the choice for a launch argument."""
    return _LAUNCH_PREFIX + name


def find_launch_names(choices: Mapping[str, Choice]) -> dict[str, str]:
    """Return the choices that are launch arguments: name of the choice -> name of the argument."""
    return {name: name.removeprefix(_LAUNCH_PREFIX) for name in choices if name.startswith(_LAUNCH_PREFIX)}
