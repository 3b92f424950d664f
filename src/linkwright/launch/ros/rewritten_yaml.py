"""The substitutions of ``nav2_common.launch`` that rewrite and query parameter files.

The package ``nav2_common`` is part of Nav2, but the launch files of many robots use these substitutions.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from linkwright.diagnostics import foreign, phrase
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.conditions import Condition
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_TRUE_TEXTS = ("true", "on", "1", "yes")
_DEFAULT_POSE = dict.fromkeys(("x", "y", "z", "roll", "pitch", "yaw"), 0.0)
_PARAMETERS_KEY = "ros__parameters"


class _YamlFileSubstitution(Substitution):
    """The base class of substitutions that read a YAML file."""

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
            raise error_at(self.source_location, "LAUNCH152", message, ros_error=error) from error

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
            raise error_at(self.source_location, "LAUNCH152", message, ros_error=error) from error


class RewrittenYaml(_YamlFileSubstitution):
    """A substitution that evaluates to the path of a copy of a parameter file.

    The copy has new values.

    Args:
        source_file: the file to copy.
        param_rewrites: maps the name of parameters, or the dotted path of one parameter, to a new value. A path
            that contains ``ros__parameters`` is added if the file has no such parameter.
        root_key: a key under which the entire content is nested; None to keep the content at the top.
        key_rewrites: maps keys to new keys.
        value_rewrites: maps the texts of values to new texts.
        convert_types: whether texts of numbers become numbers; ``true`` and ``false`` always become booleans.
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
        self._values = _normalize_rewrites(param_rewrites)
        self._root_key = None if root_key is None else normalize_to_list_of_substitutions(root_key)
        self._key_rewrites = _normalize_rewrites(key_rewrites)
        self._text_rewrites = _normalize_rewrites(value_rewrites)
        self._convert_types = convert_types

    def perform(self, context: LaunchContext) -> str:
        """Write the new file, and return its path.

        Raises:
            LinkwrightError: LAUNCH152, the file cannot be read.
        """
        import yaml

        content = self._load(context)
        values = {name: self._convert_text(text) for name, text in _evaluate_rewrites(context, self._values).items()}
        content = _replace_texts(content, _evaluate_rewrites(context, self._text_rewrites))
        present_paths = {".".join(path) for path in _find_value_paths(content)}
        content = _replace_values(content, values, ())
        for path, value in values.items():
            if path not in present_paths and _PARAMETERS_KEY in path.split("."):
                _add_value(content, path.split("."), value)
        content = _replace_keys(content, _evaluate_rewrites(context, self._key_rewrites))
        root = "" if self._root_key is None else perform_substitutions(context, self._root_key)
        return _write_file(context, yaml.dump({root: content} if root else content), ".yaml")

    def _convert_text(self, text: str) -> Any:
        if text.lower() in ("true", "false"):
            return text.lower() == "true"
        if self._convert_types:
            for number_type in (int, float):
                try:
                    return number_type(text)
                except ValueError:  # noqa: PERF203 - there are only two attempts
                    continue
        return text


def _find_value_paths(content: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Yield the path of each value in nested dictionaries and lists.

    A path is a tuple of keys and indices.
    """
    if isinstance(content, dict):
        items: Any = content.items()
    elif isinstance(content, list):
        items = enumerate(content)
    else:
        yield path
        return
    for key, value in items:
        yield from _find_value_paths(value, (*path, str(key)))


def _replace_values(content: Any, values: Mapping[str, Any], path: tuple[str, ...]) -> Any:
    """Return nested dictionaries and lists with some values replaced.

    Args:
        content: the nested dictionaries and lists of a YAML file.
        values: maps a key, or a full path with dots, to a new value.
        path: the keys that lead to the content.
    """
    if isinstance(content, list):
        return [_replace_values(item, values, (*path, str(index))) for index, item in enumerate(content)]
    if isinstance(content, dict):
        new_content = {}
        for key, value in content.items():
            name = str(key)
            is_group = isinstance(value, dict)
            new_content[key] = (
                values[name] if name in values and not is_group else _replace_values(value, values, (*path, name))
            )
        return new_content
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


def _add_value(content: Any, path: list[str], value: Any) -> None:
    *parent_keys, last_key = path
    for key in parent_keys:
        content = content.setdefault(key, {})
    content[last_key] = value


class ReplaceString(_YamlFileSubstitution):
    """A substitution that copies a file with replaced texts, and evaluates to the copy's path.

    Args:
        source_file: the file to copy.
        replacements: maps texts to their replacements.
        condition: the condition under which texts are replaced. If it does not hold, the result is the path of the
            original file.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        replacements: Mapping[str, SomeSubstitutionsType],
        condition: Condition | None = None,
    ) -> None:
        super().__init__(source_file)
        self._replacements = _normalize_rewrites(replacements)
        self._condition = condition

    @property
    def condition(self) -> Condition | None:
        """The condition under which texts are replaced, or None."""
        return self._condition

    def perform(self, context: LaunchContext) -> str:
        """Write the new file and return its path, or return the path of the original file.

        The new file is written only if the condition holds.

        Raises:
            LinkwrightError: LAUNCH152, the file cannot be read.
        """
        if self._condition is not None and not self._condition.evaluate(context):
            return perform_substitutions(context, self._source_file)
        path, text = self._read(context)
        for old, new in _evaluate_rewrites(context, self._replacements).items():
            text = text.replace(old, new)
        return _write_file(context, text, path.suffix)


class HasNodeParams(_YamlFileSubstitution):
    """A substitution that states whether a parameter file has parameters for a node.

    It evaluates to ``True`` or ``False``.
    """

    def __init__(self, source_file: SomeSubstitutionsType, node_name: str) -> None:
        super().__init__(source_file)
        self._node_name = node_name

    def perform(self, context: LaunchContext) -> str:
        """Return ``True`` if the file has parameters for the node, otherwise ``False``.

        Raises:
            LinkwrightError: LAUNCH152, the file cannot be read.
        """
        content = self._load(context)
        return str(isinstance(content, dict) and self._node_name in content)


class LaunchConfigAsBool(Substitution):
    """A substitution that evaluates a launch configuration to ``True`` or ``False``.

    The values ``true``, ``on``, ``1`` and ``yes`` count as true.
    """

    def __init__(self, name: str) -> None:
        from linkwright.launch.model.substitutions import LaunchConfiguration

        self._configuration = LaunchConfiguration(name)

    def describe(self) -> str:
        """Return a text with the name of the launch configuration."""
        return f"LaunchConfigAsBool({self._configuration.describe()})"

    def perform(self, context: LaunchContext) -> str:
        """Return ``True`` if the value of the launch configuration is true, otherwise ``False``."""
        return str(self._configuration.perform(context).strip().lower() in _TRUE_TEXTS)


class ParseMultiRobotPose(Substitution):
    """The poses of several robots.

    They are read from a text such as ``robot1={x: 1.0, yaw: 0.5}; robot2={...}``.

    Args:
        robots_argument: a substitution that evaluates to the text, or the name of a launch argument that `value` reads
            from the command line.
    """

    def __init__(self, robots_argument: Any) -> None:
        self._argument = robots_argument

    def describe(self) -> str:
        """Return a text with the argument."""
        argument_text = self._argument if isinstance(self._argument, str) else self._argument.describe()
        return f"ParseMultiRobotPose({argument_text})"

    def value(self) -> dict[str, dict[str, float]]:
        """Return the poses of the robots by name, from the launch argument on the command line."""
        prefix = f"{self._argument}:="
        return self._parse_poses(
            next((argument[len(prefix) :] for argument in sys.argv if argument.startswith(prefix)), "")
        )

    def perform(self, context: LaunchContext) -> Any:
        """Return the poses of the robots by name.

        Unlike other substitutions, this one does not return a text.
        """
        if isinstance(self._argument, str):
            return self._parse_poses(str(context.launch_configurations.get(self._argument, "")))
        return self._parse_poses(self._argument.perform(context))

    def _parse_poses(self, text: str) -> dict[str, dict[str, float]]:
        import yaml

        robots: dict[str, dict[str, float]] = {}
        for entry in text.split(";"):
            name, separator, pose = entry.partition("=")
            if not separator:
                continue
            try:
                pose_values = yaml.safe_load(pose)
            except yaml.YAMLError:
                pose_values = None
            if not isinstance(pose_values, dict):
                message = phrase(
                    "pose '{pose}' of robot '{name}' is not a mapping such as {{x: 1.0, yaw: 0.5}}",
                    pose=pose.strip(),
                    name=name.strip(),
                )
                raise error_at(self.source_location, "LAUNCH152", message)
            robots[name.strip()] = {**_DEFAULT_POSE, **pose_values}
        return robots


def _normalize_rewrites(rewrites: Mapping[str, SomeSubstitutionsType] | None) -> dict[str, list[Substitution]]:
    if not rewrites:  # as in nav2_common, an empty text is also valid
        return {}
    return {str(key): normalize_to_list_of_substitutions(_as_text(value)) for key, value in rewrites.items()}


def _as_text(value: Any) -> Any:
    return str(value) if isinstance(value, (bool, int, float)) else value


def _evaluate_rewrites(context: LaunchContext, rewrites: Mapping[str, list[Substitution]]) -> dict[str, str]:
    return {key: perform_substitutions(context, value) for key, value in rewrites.items()}


def _write_file(context: LaunchContext, text: str, suffix: str) -> str:
    """Write a new file, and return its path.

    The file is deleted after the launch, if one is running.
    """
    folder = context.session.scratch_folder if context.is_running else None
    with tempfile.NamedTemporaryFile("w", suffix=suffix, dir=folder, delete=False, encoding="utf-8") as file:
        file.write(text)
    return file.name
