"""The substitutions of ``nav2_common.launch`` that rewrite and query parameter files.

The package ``nav2_common`` is part of Navigation2, but launch files of many robots use these substitutions.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from linkwright.diagnostics import foreign, phrase
from linkwright.launch.errors.places import error_at
from linkwright.launch.model.conditions import Condition
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_TRUE = ("true", "on", "1", "yes")
_POSE = dict.fromkeys(("x", "y", "z", "roll", "pitch", "yaw"), 0.0)
_PARAMETERS = "ros__parameters"


class _YamlFileSubstitution(Substitution):
    """The base class of substitutions on a YAML file."""

    def __init__(self, source_file: SomeSubstitutionsType) -> None:
        self._source_file = normalize_to_list_of_substitutions(source_file)

    @property
    def name(self) -> list[Substitution]:
        """The path of the file, as substitutions."""
        return self._source_file

    def describe(self) -> str:
        """Return a text with the path of the file."""
        return f"{type(self).__name__}({describe(self._source_file)})"

    def _read(self, context: LaunchContext) -> tuple[Path, str]:
        path = Path(perform_substitutions(context, self._source_file))
        try:
            return path, path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else error.reason
            message = phrase(
                "{name}: file '{path}' cannot be read: {reason}",
                name=type(self).__name__,
                path=path,
                reason=foreign(reason),
            )
            raise error_at(self.place, "LAUNCH152", message, ros_error=error) from error

    def _load(self, context: LaunchContext) -> Any:
        import yaml

        path, text = self._read(context)
        try:
            return yaml.safe_load(text)
        except yaml.YAMLError as error:
            message = phrase(
                "{name}: file '{path}' is not YAML: {error}",
                name=type(self).__name__,
                path=path,
                error=foreign(error),
            )
            raise error_at(self.place, "LAUNCH152", message, ros_error=error) from error


class RewrittenYaml(_YamlFileSubstitution):
    """The path of a new parameter file, which is a copy with replaced values.

    Args:
        source_file: the file to copy.
        param_rewrites: name -> value for all parameters with that name, or path with dots -> value for one parameter. A
            path that contains ``ros__parameters`` is added if the file has no such parameter.
        root_key: a root key under which the entire content is nested.
        key_rewrites: name -> new name of keys.
        value_rewrites: text -> new text of values.
        convert_types: whether values that look like numbers become numbers; ``true`` and ``false`` are always
            converted.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        param_rewrites: Mapping[str, SomeSubstitutionsType],
        root_key: SomeSubstitutionsType | None = None,
        key_rewrites: Mapping[str, SomeSubstitutionsType] | None = None,
        value_rewrites: Mapping[str, SomeSubstitutionsType] | None = None,
        convert_types: bool = False,
    ) -> None:
        super().__init__(source_file)
        self._values = _normalized(param_rewrites)
        self._root_key = None if root_key is None else normalize_to_list_of_substitutions(root_key)
        self._keys = _normalized(key_rewrites or {})
        self._texts = _normalized(value_rewrites or {})
        self._convert_types = convert_types

    def perform(self, context: LaunchContext) -> str:
        """Write the new file, and return its path.

        Raises:
            LinkwrightError: LAUNCH152, the file cannot be read.
        """
        import yaml

        content = self._load(context)
        values = {name: self._converted(text) for name, text in _performed(context, self._values).items()}
        content = _replace_texts(content, _performed(context, self._texts))
        present = {".".join(path) for path in _value_paths(content)}
        content = _replace_values(content, values, ())
        for path, value in values.items():
            if path not in present and _PARAMETERS in path.split("."):
                _add(content, path.split("."), value)
        content = _replace_keys(content, _performed(context, self._keys))
        root = "" if self._root_key is None else perform_substitutions(context, self._root_key)
        return _write_file(context, yaml.dump({root: content} if root else content), ".yaml")

    def _converted(self, text: str) -> Any:
        if text.lower() in ("true", "false"):
            return text.lower() == "true"
        if self._convert_types:
            for kind in (int, float):
                try:
                    return kind(text)
                except ValueError:  # noqa: PERF203 - there are two tries
                    continue
        return text


def _value_paths(content: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Yield the path of each value in nested dictionaries and lists, as a tuple of keys."""
    if isinstance(content, dict):
        items: Any = content.items()
    elif isinstance(content, list):
        items = enumerate(content)
    else:
        yield path
        return
    for key, value in items:
        yield from _value_paths(value, (*path, str(key)))


def _replace_values(content: Any, values: Mapping[str, Any], path: tuple[str, ...]) -> Any:
    """Return the content with values replaced.

    Args:
        content: the content.
        values: key or full path with dots -> new value.
        path: the keys above the content.
    """
    if isinstance(content, list):
        return [_replace_values(item, values, (*path, str(number))) for number, item in enumerate(content)]
    if isinstance(content, dict):
        made = {}
        for key, value in content.items():
            name = str(key)
            is_group = isinstance(value, dict)
            made[key] = (
                values[name] if name in values and not is_group else _replace_values(value, values, (*path, name))
            )
        return made
    return values.get(".".join(path), content)


def _replace_keys(content: Any, keys: Mapping[str, str]) -> Any:
    if not isinstance(content, dict):
        return content
    return {keys.get(key, key): _replace_keys(value, keys) for key, value in content.items()}


def _replace_texts(content: Any, texts: Mapping[str, str]) -> Any:
    if isinstance(content, dict):
        return {key: _replace_texts(value, texts) for key, value in content.items()}
    if isinstance(content, list):
        return [_replace_texts(item, texts) for item in content]
    return texts.get(content, content) if isinstance(content, str) else content


def _add(content: Any, path: list[str], value: Any) -> None:
    *above, last = path
    for key in above:
        content = content.setdefault(key, {})
    content[last] = value


class ReplaceString(_YamlFileSubstitution):
    """The path of a new file, which is a copy with replaced texts.

    Args:
        source_file: the file to copy.
        replacements: text -> replacement.
        condition: the condition under which texts are replaced. If it does not hold, the result is the path of the file
            itself.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        replacements: Mapping[str, SomeSubstitutionsType],
        condition: Condition | None = None,
    ) -> None:
        super().__init__(source_file)
        self._replacements = _normalized(replacements)
        self._condition = condition

    @property
    def condition(self) -> Condition | None:
        """The condition under which texts are replaced, or None."""
        return self._condition

    def perform(self, context: LaunchContext) -> str:
        """Write the new file if the condition holds, and return its path.

        If the condition does not hold, return the path of the original file.

        Raises:
            LinkwrightError: LAUNCH152, the file cannot be read.
        """
        if self._condition is not None and not self._condition.evaluate(context):
            return perform_substitutions(context, self._source_file)
        path, text = self._read(context)
        for old, new in _performed(context, self._replacements).items():
            text = text.replace(old, new)
        return _write_file(context, text, path.suffix)


class HasNodeParams(_YamlFileSubstitution):
    """A test whether a parameter file has parameters for a node: ``True`` or ``False``."""

    def __init__(self, source_file: SomeSubstitutionsType, node_name: str) -> None:
        super().__init__(source_file)
        self._node_name = node_name

    def perform(self, context: LaunchContext) -> str:
        """Return ``True`` if the file has parameters for the node, else ``False``.

        Raises:
            LinkwrightError: LAUNCH152, the file cannot be read.
        """
        content = self._load(context)
        return str(isinstance(content, dict) and self._node_name in content)


class LaunchConfigAsBool(Substitution):
    """A launch configuration converted to ``True`` or ``False``.

    The values ``on`` and ``yes`` also count as true.
    """

    def __init__(self, name: str) -> None:
        from linkwright.launch.model.substitutions import LaunchConfiguration

        self._configuration = LaunchConfiguration(name)

    def describe(self) -> str:
        """Return a text with the name of the launch configuration."""
        return f"LaunchConfigAsBool({self._configuration.describe()})"

    def perform(self, context: LaunchContext) -> str:
        """Return ``True`` if the value of the launch configuration is true, else ``False``."""
        return str(self._configuration.perform(context).strip().lower() in _TRUE)


class ParseMultiRobotPose(Substitution):
    """The poses of robots, written as ``robot1={x: 1.0, yaw: 0.5}; robot2={...}``.

    Args:
        robots_argument: a substitution for the text, or the name of a launch argument, which `value` reads from the
            command line.
    """

    def __init__(self, robots_argument: Any) -> None:
        self._argument = robots_argument

    def describe(self) -> str:
        """Return a text with the argument."""
        words = self._argument if isinstance(self._argument, str) else self._argument.describe()
        return f"ParseMultiRobotPose({words})"

    def value(self) -> dict[str, dict[str, float]]:
        """Parse the launch argument on the command line, and return the pose of each robot by name."""
        start = f"{self._argument}:="
        return self._parsed(next((word[len(start) :] for word in sys.argv if word.startswith(start)), ""))

    def perform(self, context: LaunchContext) -> Any:
        """Return the pose of each robot by name.

        Unlike other substitutions, this one does not return a text.
        """
        if isinstance(self._argument, str):
            return self._parsed(str(context.launch_configurations.get(self._argument, "")))
        return self._parsed(self._argument.perform(context))

    def _parsed(self, text: str) -> dict[str, dict[str, float]]:
        import yaml

        robots: dict[str, dict[str, float]] = {}
        for entry in text.split(";"):
            name, sign, pose = entry.partition("=")
            if not sign:
                continue
            try:
                given = yaml.safe_load(pose)
            except yaml.YAMLError:
                given = None
            if not isinstance(given, dict):
                message = phrase(
                    "pose '{pose}' of robot '{name}' is not a mapping such as {{x: 1.0, yaw: 0.5}}",
                    pose=pose.strip(),
                    name=name.strip(),
                )
                raise error_at(self.place, "LAUNCH152", message)
            robots[name.strip()] = {**_POSE, **given}
        return robots


def _normalized(rewrites: Mapping[str, SomeSubstitutionsType]) -> dict[str, list[Substitution]]:
    return {str(key): normalize_to_list_of_substitutions(_plain(value)) for key, value in rewrites.items()}


def _plain(value: Any) -> Any:
    return str(value) if isinstance(value, (bool, int, float)) else value


def _performed(context: LaunchContext, rewrites: Mapping[str, list[Substitution]]) -> dict[str, str]:
    return {key: perform_substitutions(context, value) for key, value in rewrites.items()}


def _write_file(context: LaunchContext, text: str, suffix: str) -> str:
    """Write a new file, and return its path.

    If a launch is running, the file is deleted after it.
    """
    folder = context.session.scratch_folder if context.is_running else None
    with tempfile.NamedTemporaryFile("w", suffix=suffix, dir=folder, delete=False, encoding="utf-8") as file:
        file.write(text)
    return file.name
