"""Parameter files: YAML that maps node names to parameters."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, SourceText, display_path
from linkwright.launch.conditions import evaluate_condition_expression
from linkwright.launch.context import LaunchContext
from linkwright.launch.places import Place, located
from linkwright.launch.ros.text_substitutions import substitute_text
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_PARAMETERS = "ros__parameters"


class ParameterFile:
    """A parameter file for ``parameters`` of a node.

    Args:
        param_file: its path.
        allow_substs: whether ``$(var NAME)`` and the like in it are replaced.
    """

    def __init__(
        self,
        param_file: Path | SomeSubstitutionsType,
        *,
        allow_substs: bool | SomeSubstitutionsType = False,
    ) -> None:
        self._param_file = normalize_to_list_of_substitutions(param_file)
        allow = str(allow_substs).lower() if isinstance(allow_substs, bool) else allow_substs
        self._allow_substs = normalize_to_list_of_substitutions(allow)
        self.place = Place.of_caller()

    @property
    def param_file(self) -> list[Any]:
        """The path, as substitutions."""
        return self._param_file

    def read(self, context: LaunchContext) -> tuple[Path, dict[str, Any], bool]:
        """The path, what is in the file, and whether substitutions were made in it.

        Raises:
            LinkwrightError: LAUNCH133, what is wrong with the file.
        """
        path = Path(perform_substitutions(context, self._param_file))
        substitutes = evaluate_condition_expression(context, self._allow_substs)
        try:
            return path, _load(path, context if substitutes else None), substitutes
        except LinkwrightError as error:
            raise located(error, self.place) from error


def parameters_for(content: Mapping[str, Any], node: str) -> dict[str, Any]:
    """The parameters that a file has for a node, nested mappings as they stand.

    Args:
        content: what is in the file: names of nodes, or parts of such names one in another, with ``*`` for
        any one
            part and ``**`` for any number of them.
        node: the node's full name, such as ``/robot/talker``.
    """
    found: dict[str, Any] = {}
    for pattern, parameters in _sections(content, ""):
        if _matches(pattern, node):
            found.update(parameters)
    return found


def _sections(content: Mapping[str, Any], above: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    for name, value in content.items():
        path = f"{above}/{str(name).strip('/')}"
        if isinstance(value, Mapping):
            if isinstance(value.get(_PARAMETERS), Mapping):
                yield path, value[_PARAMETERS]
            yield from _sections({key: each for key, each in value.items() if key != _PARAMETERS}, path)


def _matches(pattern: str, node: str) -> bool:
    expression = re.escape(pattern).replace(r"/\*\*", "(/[^/]+)*").replace(r"\*", "[^/]+")
    return re.fullmatch(expression, node) is not None


def _load(path: Path, context: LaunchContext | None) -> dict[str, Any]:
    import yaml

    shown = display_path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise _error(f"parameter file '{shown}' does not exist") from error
    except (OSError, UnicodeDecodeError) as error:
        raise _error(f"parameter file '{shown}' cannot be read: {error}") from error
    source = SourceText(str(path), text)
    if context is not None:
        text = substitute_text(text, context, source)
    try:
        content = yaml.safe_load(text)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or str(error)
        span = source.span(source.offset(mark.line + 1, mark.column + 1)) if mark else None
        message = f"parameter file is not YAML: {problem}"
        raise LinkwrightError(Diagnostic("LAUNCH133", message, span, source=source)) from error
    if content is None:
        return {}
    if not isinstance(content, dict) or not any(True for _ in _sections(content, "")):
        message = f"parameter file '{shown}' names no node with '{_PARAMETERS}' below it"
        raise _error(message, f"write it as NODE_NAME: {{{_PARAMETERS}: {{name: value}}}}")
    return content


def _error(message: str, hint: str | None = None) -> LinkwrightError:
    return LinkwrightError(Diagnostic("LAUNCH133", message, hint=hint))
