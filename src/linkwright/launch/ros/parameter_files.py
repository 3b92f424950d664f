"""Parameter files for nodes (``launch_ros.parameter_descriptions.ParameterFile``)."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    SourceText,
    display_path,
    foreign,
    missing_file_hint,
    phrase,
)
from linkwright.files.input_files import read_text
from linkwright.launch.errors.exceptions import SubstitutionFailure
from linkwright.launch.errors.locations import Located, MarkupLocation, SourceLocation, error_at, with_location
from linkwright.launch.frontend.grammar import parse_substitution
from linkwright.launch.frontend.parser import Parser
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.entity import LocatedText
from linkwright.launch.model.markup.values import normalize_typed_substitution, perform_typed_substitution
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.packages.share_layout import find_source

if TYPE_CHECKING:
    from linkwright.graph.parameters.parameter import ParameterRules


class ParameterFile(Located):
    """A file with parameters for nodes.

    Args:
        param_file: the path of the file.
        allow_substs: whether substitutions in the file, such as ``$(var NAME)``, are evaluated.
    """

    def __init__(
        self,
        param_file: os.PathLike[str] | SomeSubstitutionsType,
        *,
        allow_substs: bool | SomeSubstitutionsType = False,
    ) -> None:
        self._evaluated_path: Path | None = None
        self._allows_substitutions: bool | None = None
        self._source: SourceText | None = None
        self._is_temporary = False
        self._rules: ParameterRules | None = None
        path = os.fspath(param_file) if isinstance(param_file, os.PathLike) else param_file
        try:
            self._param_file = normalize_to_list_of_substitutions(path)
            self._allow_substs = normalize_typed_substitution(allow_substs, bool)
        except (TypeError, ValueError) as error:
            raise error_at(
                self.source_location,
                "LAUNCH133",
                phrase("the arguments of ParameterFile are not valid: {error}", error=foreign(error)),
                ros_error=error,
            ) from error

    @property
    def param_file(self) -> list[Substitution] | Path:
        """The path of the file as substitutions, or the path that `evaluate` returned."""
        return self._param_file if self._evaluated_path is None else self._evaluated_path

    @property
    def allow_substs(self) -> Any:
        """Whether substitutions in the file are evaluated.

        Before `evaluate`, the value may be a list of substitutions. Afterwards, it is a boolean.
        """
        return self._allow_substs if self._allows_substitutions is None else self._allows_substitutions

    def evaluate(self, context: LaunchContext) -> Path:
        """Return the path of the file, or of a temporary copy with evaluated substitutions.

        Raises:
            LinkwrightError: LAUNCH133, a file with substitutions has errors; the error is also a SubstitutionFailure.
        """
        if self._evaluated_path is None:
            path = Path(perform_substitutions(context, self._param_file))
            self._allows_substitutions = bool(perform_typed_substitution(context, self._allow_substs, bool))
            self._evaluated_path = self._write_evaluated_copy(path, context) if self._allows_substitutions else path
        return self._evaluated_path

    def read_rules(self, context: LaunchContext) -> ParameterRules:
        """Return the parameter rules of the file.

        Raises:
            LinkwrightError: LAUNCH133, the file has errors.
        """
        from linkwright.graph.parameters.files import parse_parameters

        if self._rules is None:
            path = self.evaluate(context)
            source = self._source or _read_source(path, self.source_location)
            try:
                self._rules = parse_parameters(source)
                self._rules.files.append(str(path))
            except LinkwrightError as error:
                raise with_location(error, self.source_location) from error
        return self._rules

    def cleanup(self) -> None:
        """Delete the temporary copy of the file, if there is one."""
        if self._is_temporary and self._evaluated_path is not None:
            with suppress(OSError):
                self._evaluated_path.unlink()
            self._evaluated_path, self._rules, self._is_temporary = None, None, False

    def __del__(self) -> None:
        if getattr(self, "_is_temporary", False):
            self.cleanup()

    def _write_evaluated_copy(self, path: Path, context: LaunchContext) -> Path:
        import tempfile

        from linkwright.launch.ros.parameter_files import substitute_text

        source = _read_source(path, self.source_location)
        try:
            text = substitute_text(source, context)
        except LinkwrightError as error:
            raise with_location(error, self.source_location) from error
        self._check_yaml(SourceText(source.name, text))
        self._source = SourceText(source.name, text)
        folder = context.session.scratch_folder if context.is_running else None
        descriptor, name = tempfile.mkstemp(prefix="launch_params_", suffix=".yaml", dir=folder)
        with os.fdopen(descriptor, "w", encoding="utf-8") as file:
            file.write(text)
        self._is_temporary = True
        return Path(name)

    def _check_yaml(self, source: SourceText) -> None:
        import yaml

        try:
            for _ in yaml.parse(source.text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
                pass
        except yaml.YAMLError as error:
            mark = getattr(error, "problem_mark", None)
            reason = getattr(error, "problem", None) or str(error)
            span = source.span(source.offset(mark.line + 1, mark.column + 1)) if mark else None
            message = phrase(
                "the parameter file is not valid YAML after its substitutions were evaluated: {problem}",
                problem=foreign(reason),
            )
            failure = SubstitutionFailure("The substituted parameter file is not a valid yaml file")
            located_error = error_at(None, "LAUNCH133", message, ros_error=failure)
            located_error.diagnostics = (Diagnostic("LAUNCH133", message, span, source=source),)
            raise with_location(located_error, self.source_location) from error


def _read_source(path: Path, location: SourceLocation | None) -> SourceText:
    name = find_source(str(path))
    shown_path = display_path(name)
    try:
        return SourceText(name, read_text(path))
    except FileNotFoundError as error:
        message, hint = phrase("parameter file '{path}' does not exist", path=shown_path), missing_file_hint(path)
        raise error_at(location, "LAUNCH133", message, hint, ros_error=error) from error
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise error_at(
            location,
            "LAUNCH133",
            phrase("parameter file '{path}' cannot be read: {reason}", path=shown_path, reason=foreign(reason)),
        ) from error


_SUBSTITUTION_START = re.compile(r"(?<!\\)\$\(")
_COMMENT = re.compile(r"(?:^|(?<=\s))#[^\n]*", re.MULTILINE)
_QUOTED_TEXT = re.compile(r"\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\n]|'')*'")


def substitute_text(source: SourceText, context: LaunchContext) -> str:
    """Return the text of a YAML file, with substitutions evaluated except in comments.

    Raises:
        LinkwrightError: LAUNCH119 and others, a substitution is unknown or has no value; the error has its location.
    """
    Parser.load_launch_extensions()
    text = source.text
    comments = list(_find_comment_spans(text))
    chunks: list[str] = []
    end_offset = 0
    for match in _SUBSTITUTION_START.finditer(text):
        start = match.start()
        if start < end_offset or any(begin <= start < end for begin, end in comments):
            continue
        end = _find_substitution_end(text, start)
        location = MarkupLocation(source, start, end)
        try:
            value = perform_substitutions(context, parse_substitution(LocatedText(text[start:end], location)))
        except LinkwrightError as error:
            raise with_location(error, location) from error
        chunks += [text[end_offset:start], value]
        end_offset = end
    return "".join([*chunks, text[end_offset:]])


def _find_substitution_end(text: str, start: int) -> int:
    """Return the end offset of the substitution that starts at a given offset.

    If it has no closing parenthesis, the result is the end of the line.
    """
    depth = 0
    for offset in range(start, len(text)):
        if text[offset] == "(":
            depth += 1
        elif text[offset] == ")":
            depth -= 1
            if depth == 0:
                return offset + 1
    line_end = text.find("\n", start)
    return line_end if line_end >= 0 else len(text)


def _find_comment_spans(text: str) -> Iterator[tuple[int, int]]:
    quoted_spans = [match.span() for match in _QUOTED_TEXT.finditer(text)]
    for comment in _COMMENT.finditer(text):
        if not any(begin < comment.start() < end for begin, end in quoted_spans):
            yield comment.span()
