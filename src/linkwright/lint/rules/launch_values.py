"""Rules about values in launch files, such as ``robot_description`` and arguments."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import lru_cache

from linkwright.descriptions import examine
from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    Severity,
    SourceText,
    Span,
    foreign,
    nearest,
    phrase,
    quoted,
)
from linkwright.diagnostics.misspellings import find_misspelled
from linkwright.lint.fix import Edit, Fix
from linkwright.lint.rule import Rule, Scope
from linkwright.lint.rules.launch_files import LaunchRule
from linkwright.lint.rules.package_manifest import PackageRule
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext
    from linkwright.packages.readers.launch_files import LaunchFile

_FIXED_FRAME = lazy_pattern(r"^( *)Fixed Frame:[ \t]*(?P<name>\S[^\n#]*?)[ \t]*\r?$", re.MULTILINE)
_USUAL_FRAMES = frozenset({"map", "odom", "world", "earth", "base_link", "base_footprint"})


class CommandWithoutBlank(LaunchRule):
    """There is no space between the program and its argument in a ``Command``.

    ## Why

    `Command` concatenates its parts. Without a space at the end of `'xacro'`, the program and the path become one word,
    and the launch fails with "file not found".

    ## Example

    ```python
    Command(['xacro', LaunchConfiguration('model')])
    ```

    ## Use instead

    ```python
    Command(['xacro ', LaunchConfiguration('model')])
    ```
    """

    code = "LW845"
    name = "command-without-blank"
    severity = Severity.ERROR

    def check_launch(self, file: LaunchFile) -> Iterator[Diagnostic]:
        """Yield a finding for each ``Command`` without a space after the program."""
        python_file = file.python_file
        if python_file is None:
            return
        for call in python_file.calls("Command"):
            arguments = python_file.resolved(call.args[0]) if call.args else argument_of(call, "command")
            if not isinstance(arguments, (ast.List, ast.Tuple)) or len(arguments.elts) < 2:
                continue
            program, argument = arguments.elts[0], arguments.elts[1]
            if not _is_program(program, python_file) or _begins_with_blank(argument, python_file):
                continue
            message = phrase("there is no space between the program and its argument")
            hint = phrase("Command joins its parts without spaces: write 'xacro ' with a space at the end")
            yield self.report(
                message,
                span=python_file.span(program),
                source=file.source,
                hint=hint,
                fix=_make_blank_fix(program, python_file),
            )


class DescriptionNotTyped(Rule):
    """``robot_description`` comes from a command, is not marked as text, and cannot be read as YAML.

    ## Why

    launch parses the output of a command as YAML. Most descriptions are valid plain text in YAML. However, a colon
    followed by a space, usually in a comment, causes the error "Unable to parse the value of parameter
    robot_description as yaml". To detect this error, the rule expands the descriptions that the launch file names.

    ## Example

    ```python
    parameters=[{'robot_description': Command(['xacro ', model])}]
    ```

    for a model with `<!-- wheels: left and right -->` in its first element.

    ## Use instead

    ```python
    parameters=[{'robot_description': ParameterValue(Command(['xacro ', model]), value_type=str)}]
    ```
    """

    code = "LW846"
    name = "description-not-typed"
    scope = Scope.PACKAGE

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        """Yield a finding for each untyped ``robot_description`` that is not valid YAML."""
        package = subject.package
        if package is None:
            return
        for file in package.launch_files.values():
            descriptions = [] if file.python_file is None else list(_find_untyped_descriptions(file.python_file))
            invalid_description = _find_invalid_yaml_description(file, package, subject) if descriptions else None
            if invalid_description is None:
                continue
            path, reason = invalid_description
            message = phrase(
                "launch reads this description as YAML, but '{path}' is not valid YAML: {reason}",
                path=path,
                reason=foreign(reason),
            )
            for description in descriptions:
                yield self.report(
                    message, span=description.span, source=file.source, hint=description.hint, fix=description.fix
                )


class LaunchArgumentUndeclared(LaunchRule):
    """A ``LaunchConfiguration`` probably misspells the name of a declared argument.

    ## Why

    The launch fails with "launch configuration does not exist".

    ## Example

    ```python
    DeclareLaunchArgument('model', default_value=path),
    Command(['xacro ', LaunchConfiguration('modle')])
    ```

    ## Use instead

    ```python
    Command(['xacro ', LaunchConfiguration('model')])
    ```
    """

    code = "LW847"
    name = "launch-argument-undeclared"

    def check_launch(self, file: LaunchFile) -> Iterator[Diagnostic]:
        """Yield a finding for each misspelled launch configuration in a launch file."""
        python_file = file.python_file
        if python_file is None:
            return
        declared_names: set[str] = set()
        for call in python_file.calls("DeclareLaunchArgument", "SetLaunchConfiguration"):
            name_argument = call.args[0] if call.args else argument_of(call, "name")
            name = python_file.text(name_argument)
            if name is None:
                return  # not all declared names are known, so no name can be called undeclared
            declared_names.add(name)
        for call in python_file.calls("LaunchConfiguration"):
            if len(call.args) != 1 or call.keywords:
                continue
            name = python_file.text(call.args[0])
            if name is None or name in declared_names:
                continue
            similar_name = next(iter(nearest(name, declared_names, 1)), None)
            if similar_name is not None and _is_typo(name, similar_name):
                message = phrase("the launch argument '{name}' is not declared", name=name)
                span = python_file.span(call.args[0])
                yield self.report(
                    message,
                    span=span,
                    source=file.source,
                    hint=phrase("did you mean {names}?", names=quoted(similar_name)),
                )


class FixedFrameUnknown(PackageRule):
    """The fixed frame of an RViz configuration is not a link of any robot in the package.

    ## Why

    RViz only shows "Frame does not exist" until the user chooses another frame.

    ## Example

    ```yaml
    Global Options:
      Fixed Frame: base_lnk
    ```

    ## Use instead

    ```yaml
    Global Options:
      Fixed Frame: base_link
    ```
    """

    code = "LW849"
    name = "fixed-frame-unknown"

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for each RViz configuration of a package with an unknown fixed frame."""
        files = [file for file in package.files if file.endswith(".rviz")]
        if not files or not package.descriptions:
            return
        names, patterns = _find_link_names(package)
        if not names:
            return
        for file in files:
            source = package.text(file)
            match = _FIXED_FRAME.search(source.text) if source is not None else None
            if source is None or match is None:
                continue
            frame = match["name"].strip("'\"")
            if (
                frame in names
                or frame in _USUAL_FRAMES
                or any(_matches_pattern(frame, pattern) for pattern in patterns)
            ):
                continue
            similar_name = find_misspelled(frame, names)
            if similar_name is not None:
                message = phrase(
                    "no robot in this package has a link '{frame}', the fixed frame of '{file}'", frame=frame, file=file
                )
                span = source.span(*match.span("name"))
                yield self.report(
                    message, span=span, source=source, hint=phrase("did you mean {names}?", names=quoted(similar_name))
                )


def _find_link_names(package: PackageContext) -> tuple[set[str], list[list[str]]]:
    """Return the literal link names of a package, and the parts of computed names.

    The parts of a name are the literal texts between its xacro expressions. Both results are empty if a description
    includes files of another package.
    """
    names: set[str] = set()
    patterns: list[list[str]] = []
    for document in package.descriptions.values():
        for element in document.root.walk():
            included_file = element.attributes.get("filename", "") if element.tag == "xacro:include" else ""
            if "$(find" in included_file and f"$(find {package.name})" not in included_file:
                return set(), []  # the other package may define links, too
            if element.tag != "link":
                continue
            name = element.attributes.get("name", "")
            if "$" not in name:
                names.add(name)
                continue
            patterns.append(re.split(r"\$\{[^}]*\}|\$\([^)]*\)", name))
    return names, patterns


def _matches_pattern(name: str, parts: list[str]) -> bool:
    """Return whether a name consists of these parts in this order, with any text between them."""
    prefix, suffix = parts[0], parts[-1]
    if len(parts) == 1:
        return name == prefix
    start, end = len(prefix), len(name) - len(suffix)
    if start > end or not (name.startswith(prefix) and name.endswith(suffix)):
        return False
    for literal_text in parts[1:-1]:
        position = name.find(literal_text, start, end)
        if position < 0:
            return False
        start = position + len(literal_text)
    return True


class _UntypedDescription(NamedTuple):
    """A value of ``robot_description`` that launch parses as YAML, with the hint and the fix."""

    span: Span
    hint: Phrase
    fix: Fix | None


def _find_untyped_descriptions(python_file: PythonFile) -> Iterator[_UntypedDescription]:
    for node in ast.walk(python_file.tree):
        if not isinstance(node, ast.Dict):
            continue
        for key, value_node in zip(node.keys, node.values, strict=True):
            value = python_file.resolved(value_node)
            if not (isinstance(key, ast.Constant) and key.value == "robot_description" and isinstance(value, ast.Call)):
                continue
            if _is_command(value):
                hint = phrase(
                    "write ParameterValue(Command(...), value_type=str), from launch_ros.parameter_descriptions"
                )
                yield _UntypedDescription(python_file.span(value), hint, None)
            elif called_name(value).rpartition(".")[2] == "ParameterValue" and len(value.args) == 1:
                argument = python_file.resolved(value.args[0])
                if (
                    argument_of(value, "value_type") is None
                    and isinstance(argument, ast.Call)
                    and _is_command(argument)
                ):
                    offset = python_file.range(value.args[0])[1]
                    fix = Fix((Edit(python_file.source.name, offset, offset, ", value_type=str"),))
                    yield _UntypedDescription(python_file.span(value), phrase("add value_type=str"), fix)


def _is_command(call: ast.Call) -> bool:
    return called_name(call).rpartition(".")[2] == "Command"


def _find_invalid_yaml_description(
    file: LaunchFile, package: PackageContext, subject: Subject
) -> tuple[str, str] | None:
    """Return the path of the first description that is not YAML with the reason, or None.

    The launch file names the descriptions.
    """
    for shared_file in file.paths:
        share = package.folder if shared_file.package == package.name else subject.finder.find(shared_file.package)
        if (
            share is None
            or not shared_file.path.endswith((".urdf", ".xacro"))
            or not (share / shared_file.path).is_file()
        ):
            continue
        try:
            text = examine(share / shared_file.path, packages=subject.finder).text
        except LinkwrightError:
            continue  # the check of that file reports the error
        reason = _find_yaml_problem(text)
        if reason is not None:
            return shared_file.path, reason
    return None


@lru_cache(maxsize=32)
def _find_yaml_problem(text: str) -> str | None:
    """Return the reason why launch cannot parse a text as a YAML string, or None."""
    import yaml

    try:
        content = yaml.safe_load(text)  # the same function that launch uses
    except yaml.YAMLError as error:
        return str(getattr(error, "problem", None) or error)
    return None if isinstance(content, str) else phrase("it is read as {type}", type=type(content).__name__)


def _is_program(node: ast.expr, python_file: PythonFile) -> bool:
    """Return whether a part of a command is the name of a program without a trailing space."""
    text = python_file.text(node)
    if text is not None:
        return bool(re.search(r"(^|/)(xacro|cat)$", text))
    return isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] == "FindExecutable"


def _begins_with_blank(node: ast.expr, python_file: PythonFile) -> bool:
    text = python_file.text(node)
    if text is not None:
        return text[:1].isspace()
    # Only a path or a launch configuration certainly has no leading space.
    node = python_file.resolved(node)
    if isinstance(node, ast.Call):
        name = called_name(node).rpartition(".")[2]
        return name not in ("LaunchConfiguration", "PathJoinSubstitution", "str", "join", "FindPackageShare")
    return not isinstance(node, (ast.BinOp, ast.JoinedStr)) or (
        isinstance(node, ast.JoinedStr) and isinstance(node.values[0], ast.Constant)
    )


def _make_blank_fix(program: ast.expr, python_file: PythonFile) -> Fix | None:
    """Return the fix that adds a space after a program's name, or None if this is not possible.

    The space is added before the closing quote of the name, or as a separate part of the command.
    """
    start, end = python_file.range(program)
    source: SourceText = python_file.source
    program_text = source.text[start:end]
    if re.fullmatch(r"""(["'])[\w/.-]+\1""", program_text):
        return Fix((Edit(source.name, end - 1, end - 1, " "),))
    return Fix((Edit(source.name, end, end, ", ' '"),)) if isinstance(program, ast.Call) else None


def _is_typo(name: str, similar_name: str) -> bool:
    """Return whether two names differ in one letter, or only in letter order.

    Both names must have at least four letters. One letter may be added, omitted or changed.
    """
    if min(len(name), len(similar_name)) < 4 or abs(len(name) - len(similar_name)) > 1:
        return False
    if sorted(name) == sorted(similar_name):
        return True
    from difflib import SequenceMatcher

    blocks = SequenceMatcher(None, name, similar_name).get_matching_blocks()
    return sum(block.size for block in blocks) >= max(len(name), len(similar_name)) - 1
