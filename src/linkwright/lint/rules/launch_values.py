"""Launch files: how they make ``robot_description``, their arguments, and what RViz is told."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Severity, SourceText, nearest
from linkwright.lint.fix import Edit, Fix
from linkwright.lint.launch_reader import LaunchFile
from linkwright.lint.package import PackageContext
from linkwright.lint.python_values import PythonFile, argument_of, called_name
from linkwright.lint.rules.launch_files import LaunchRule
from linkwright.lint.rules.package_manifest import PackageRule

_FIXED_FRAME = re.compile(r"^( *)Fixed Frame:[ \t]*(?P<name>\S[^\n#]*?)[ \t]*$", re.MULTILINE)
_USUAL_FRAMES = frozenset({"map", "odom", "world", "earth", "base_link", "base_footprint"})


class CommandWithoutBlank(LaunchRule):
    """There is no blank between the program and its argument in a ``Command``.

    ## Why

    `Command` writes its parts one behind another. Without a blank at the end of `'xacro'` the program and the path
    become one word, and the launch fails with "file not found".

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
        """What the rule finds in a launch file."""
        python = file.python
        if python is None:
            return
        for call in python.calls("Command"):
            parts = python.resolved(call.args[0]) if call.args else argument_of(call, "command")
            if not isinstance(parts, (ast.List, ast.Tuple)) or len(parts.elts) < 2:
                continue
            program, following = parts.elts[0], parts.elts[1]
            if not _is_program(program, python) or _begins_with_blank(following, python):
                continue
            message = "there is no blank between the program and its argument"
            hint = "Command joins its parts as they are: write 'xacro ' with a blank at its end"
            yield self.report(
                message, span=python.span(program), source=file.source, hint=hint, fix=_blank(program, python)
            )


class DescriptionNotTyped(LaunchRule):
    """``robot_description`` is made by a command and not said to be text.

    ## Why

    launch reads the output of a command as YAML. A colon or a percent sign somewhere in the description makes that
    fail: "Unable to parse the value of parameter robot_description as yaml".

    ## Example

    ```python
    parameters=[{'robot_description': Command(['xacro ', model])}]
    ```

    ## Use instead

    ```python
    parameters=[{'robot_description': ParameterValue(Command(['xacro ', model]), value_type=str)}]
    ```
    """

    code = "LW846"
    name = "description-not-typed"

    def check_launch(self, file: LaunchFile) -> Iterator[Diagnostic]:
        """What the rule finds in a launch file."""
        python = file.python
        if python is None:
            return
        for node in ast.walk(python.tree):
            if not isinstance(node, ast.Dict):
                continue
            for key, value in zip(node.keys, node.values, strict=True):
                if isinstance(key, ast.Constant) and key.value == "robot_description":
                    yield from self._of_value(python.resolved(value), python, file)

    def _of_value(self, value: ast.expr, python: PythonFile, file: LaunchFile) -> Iterator[Diagnostic]:
        if not isinstance(value, ast.Call):
            return
        name = called_name(value).rpartition(".")[2]
        span = python.span(value)
        message = "launch reads this description as YAML, because nothing says that it is text"
        if name == "Command":
            hint = "write ParameterValue(Command(...), value_type=str), from launch_ros.parameter_descriptions"
            yield self.report(message, span=span, source=file.source, hint=hint)
        elif name == "ParameterValue" and len(value.args) == 1 and argument_of(value, "value_type") is None:
            inner = python.resolved(value.args[0])
            if isinstance(inner, ast.Call) and called_name(inner).rpartition(".")[2] == "Command":
                at = python.range(value.args[0])[1]
                fix = Fix((Edit(file.source.name, at, at, ", value_type=str"),))
                yield self.report(message, span=span, source=file.source, hint="add value_type=str", fix=fix)


class LaunchArgumentUndeclared(LaunchRule):
    """A ``LaunchConfiguration`` names an argument that looks like a misspelt one of those declared.

    ## Why

    The launch fails: "launch configuration does not exist".

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
        """What the rule finds in a launch file."""
        python = file.python
        if python is None:
            return
        declared: set[str] = set()
        for call in python.calls("DeclareLaunchArgument", "SetLaunchConfiguration"):
            first = call.args[0] if call.args else argument_of(call, "name")
            name = python.text(first)
            if name is None:
                return  # one that cannot be told
            declared.add(name)
        for call in python.calls("LaunchConfiguration"):
            if len(call.args) != 1 or call.keywords:
                continue
            name = python.text(call.args[0])
            if name is None or name in declared:
                continue
            like = next(iter(nearest(name, declared, 1)), None)
            if like is not None and _is_slip(name, like):
                message = f"nothing declares the launch argument '{name}'"
                span = python.span(call.args[0])
                yield self.report(message, span=span, source=file.source, hint=f"did you mean '{like}'?")


class FixedFrameUnknown(PackageRule):
    """The fixed frame of an RViz configuration is no link of any robot in the package.

    ## Why

    RViz shows nothing but "Frame does not exist" until somebody chooses another one.

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
        """What the rule finds in a package."""
        files = [file for file in package.files if file.endswith(".rviz")]
        if not files or not package.descriptions:
            return
        names, patterns = _link_names(package)
        if not names:
            return
        for file in files:
            source = package.text(file)
            match = _FIXED_FRAME.search(source.text) if source is not None else None
            if source is None or match is None:
                continue
            frame = match["name"].strip("'\"")
            if frame in names or frame in _USUAL_FRAMES or any(_fits(frame, each) for each in patterns):
                continue
            like = next(iter(nearest(frame, names, 1)), None)
            if like is not None:
                message = f"no robot in this package has a link '{frame}', the fixed frame of '{file}'"
                span = source.span(*match.span("name"))
                yield self.report(message, span=span, source=source, hint=f"did you mean '{like}'?")


def _link_names(package: PackageContext) -> tuple[set[str], list[list[str]]]:
    """The names of links as they are written in the package's descriptions: plain ones, and the parts of others."""
    names: set[str] = set()
    patterns: list[list[str]] = []
    for document in package.descriptions.values():
        for element in document.root.walk():
            included = element.attributes.get("filename", "") if element.tag == "xacro:include" else ""
            if "$(find" in included and f"$(find {package.name})" not in included:
                return set(), []  # links from elsewhere
            if element.tag != "link":
                continue
            name = element.attributes.get("name", "")
            if "$" not in name:
                names.add(name)
                continue
            patterns.append(re.split(r"\$\{[^}]*\}|\$\([^)]*\)", name))
    return names, patterns


def _fits(name: str, parts: list[str]) -> bool:
    """Whether a name has these parts, in their order, with anything between them."""
    first, last = parts[0], parts[-1]
    if len(parts) == 1:
        return name == first
    at, end = len(first), len(name) - len(last)
    if at > end or not (name.startswith(first) and name.endswith(last)):
        return False
    for part in parts[1:-1]:
        found = name.find(part, at, end)
        if found < 0:
            return False
        at = found + len(part)
    return True


def _is_program(node: ast.expr, python: PythonFile) -> bool:
    """Whether a part of a command is a program's name without a blank behind it."""
    text = python.text(node)
    if text is not None:
        return bool(re.search(r"(^|/)(xacro|cat)$", text))
    return isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] == "FindExecutable"


def _begins_with_blank(node: ast.expr, python: PythonFile) -> bool:
    text = python.text(node)
    if text is not None:
        return text[:1].isspace()
    # What is neither a path nor a configuration may begin with one.
    node = python.resolved(node)
    if isinstance(node, ast.Call):
        name = called_name(node).rpartition(".")[2]
        return name not in ("LaunchConfiguration", "PathJoinSubstitution", "str", "join", "FindPackageShare")
    return not isinstance(node, (ast.BinOp, ast.JoinedStr)) or (
        isinstance(node, ast.JoinedStr) and isinstance(node.values[0], ast.Constant)
    )


def _blank(program: ast.expr, python: PythonFile) -> Fix | None:
    """Put the blank before the closing quote of the program's name, or behind it as a part of its own."""
    start, end = python.range(program)
    source: SourceText = python.source
    written = source.text[start:end]
    if re.fullmatch(r"""(["'])[\w/.-]+\1""", written):
        return Fix((Edit(source.name, end - 1, end - 1, " "),))
    return Fix((Edit(source.name, end, end, ", ' '"),)) if isinstance(program, ast.Call) else None


def _is_slip(name: str, like: str) -> bool:
    """Whether two names differ in one letter, added, left out or another one, or in the order of their letters."""
    if min(len(name), len(like)) < 4 or abs(len(name) - len(like)) > 1:
        return False
    if sorted(name) == sorted(like):
        return True
    from difflib import SequenceMatcher

    blocks = SequenceMatcher(None, name, like).get_matching_blocks()
    return sum(block.size for block in blocks) >= max(len(name), len(like)) - 1
