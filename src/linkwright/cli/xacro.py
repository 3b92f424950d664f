"""``linkwright xacro``: expand a xacro file, list its arguments or explain its elements."""

from __future__ import annotations

import sys
from types import SimpleNamespace

from linkwright.cli.model_arguments import add_values
from linkwright.cli.output import write_output
from linkwright.diagnostics import Diagnostic, Severity, phrase, print_diagnostics
from linkwright.loading.lean_typing import TYPE_CHECKING, Any
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    import argparse

    from linkwright.xacro.session import Inputs


_QUIET, _PROPERTIES, _ALL_PROPERTIES = 0, 3, 4
_USAGE_ERROR = 2
_DEFAULTS: dict[str, Any] = {
    "args": False,
    "deps": False,
    "explain": None,
    "format": "text",
    "inorder": False,
    "output": None,
    "root_dir": None,
    "verbosity": 1,
}
"""The defaults of the options."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``xacro``."""
    parser.add_argument("file", metavar="FILE", help="the xacro file, or - for standard input")
    add_values(
        parser,
        values_help="values for the file's <xacro:arg>; an empty value, as in prefix:=, keeps the default",
    )
    parser.add_argument("-o", metavar="OUT", dest="output", help="write to this file instead of standard output")
    parser.add_argument(
        "--deps",
        action="store_true",
        help="print the included files and the loaded YAML files, on one line, instead of the URDF",
    )
    parser.add_argument("--args", action="store_true", help="list the file's arguments instead of the URDF")
    parser.add_argument(
        "--explain",
        metavar="LINK_OR_JOINT",
        help="show where an element of the URDF comes from: files and lines, macro calls, includes and values",
    )
    parser.add_argument(
        "--format",
        choices=("text", "json"),
        help="the output format of --args and --explain (default: text)",
    )
    parser.add_argument(
        "--root-dir", metavar="DIR", help="the folder for relative paths and $(cwd) (default: the current folder)"
    )
    parser.add_argument(
        "-i",
        "--inorder",
        action="store_true",
        help="accepted for compatibility with xacro; the file is always processed in order",
    )
    parser.add_argument(
        "-q",
        dest="verbosity",
        action="store_const",
        const=_QUIET,
        help="print only errors; the same as --verbosity 0",
    )
    parser.add_argument(
        "-v", dest="verbosity", action="count", help="print more; the same as one --verbosity level higher"
    )
    parser.add_argument(
        "--verbosity",
        metavar="LEVEL",
        type=int,
        dest="verbosity",
        help="0: only errors, 1: also warnings (default), 2: the same, 3: also log where the "
        "properties of the document are set and used, 4: also log this for the properties of "
        "macros and namespaces",
    )
    parser.set_defaults(**_DEFAULTS)


def parse_without_options(words: list[str]) -> SimpleNamespace | None:
    """Return the parsed arguments of a command line without options.

    The result is None if the command line names no file.
    """
    return SimpleNamespace(file=words[0], values=words[1:], **_DEFAULTS) if words else None


def run(arguments: argparse.Namespace | SimpleNamespace) -> int:
    """Expand the file, or list its arguments or explain its elements.

    Findings are written to standard error, results to standard output or a file.
    """
    from linkwright.xacro.limits import Limits
    from linkwright.xacro.session import Inputs

    tokens = [arguments.file, *arguments.values]
    files = [word for word in tokens if ":=" not in word]
    if not files or (len(files) > 1 and not any("=" in word for word in files[1:])):
        file_list = f"given {len(files)}: {', '.join(files)}" if files else "given none"
        print(f"linkwright xacro: exactly one file is expected and {file_list}", file=sys.stderr)
        return _USAGE_ERROR
    if (arguments.explain is not None and (arguments.args or arguments.deps)) or (arguments.args and arguments.deps):
        print("linkwright xacro: --args, --deps and --explain cannot be combined; give one of them", file=sys.stderr)
        return _USAGE_ERROR
    verbosity = arguments.verbosity
    if arguments.inorder and verbosity > _QUIET:
        print("linkwright xacro: files are always processed in reading order; -i can be left out", file=sys.stderr)
    tokens.remove(files[0])
    values, warnings = _parse_values(tokens)
    if verbosity > _QUIET:
        print_diagnostics(warnings, sys.stderr)
    file, text = files[0], None
    if file == "-":
        file, text = "<stdin>", sys.stdin.read()
    inputs = Inputs(file, values, None, text, Limits(), arguments.root_dir or "")
    if arguments.args:
        result = _format_arguments(inputs, verbosity, arguments.format)
    elif arguments.explain is not None:
        result = _format_provenance(inputs, arguments.explain, arguments.format)
    else:
        result = _expand_text(inputs, verbosity, deps=arguments.deps)
    if arguments.output:
        from pathlib import Path

        write_output(Path(arguments.output), result)
    else:
        sys.stdout.write(result)
    return 0


def _parse_values(words: list[str]) -> tuple[dict[str, str], list[Diagnostic]]:
    """Return the xacro arguments by name, and warnings about ignored arguments.

    Empty values and ROS parameters (``_name:=``) are ignored.
    """
    values = parse_assignments(words)
    warnings = []
    for name, value in list(values.items()):
        is_ros_parameter = len(name) > 1 and name[0] == "_" and name[1] != "_"
        if value and not is_ros_parameter:
            continue
        del values[name]
        reason = phrase("its name begins with an underscore") if value else phrase("it is empty")
        message = phrase("the argument '{name}' is ignored, as in xacro: {reason}", name=name, reason=reason)
        warnings.append(Diagnostic("CLI103", message, severity=Severity.WARNING))
    return values, warnings


def _expand_text(inputs: Inputs, verbosity: int, *, deps: bool) -> str:
    from linkwright.xacro import expand

    if verbosity >= _PROPERTIES:
        from linkwright.xacro.tracing.property_log import log_properties

        log_properties(inputs, lambda line: print(line, file=sys.stderr), everywhere=verbosity >= _ALL_PROPERTIES)
    name, values, packages, text, limits, root_dir, _ = inputs
    expansion = expand(name, values, packages=packages, text=text, limits=limits, root_dir=root_dir)
    if verbosity > _QUIET:
        print_diagnostics(expansion.diagnostics, sys.stderr)
    else:
        print_diagnostics(
            [diagnostic for diagnostic in expansion.diagnostics if diagnostic.severity is Severity.ERROR], sys.stderr
        )
    return " ".join(map(str, expansion.dependencies[1:])) if deps else str(expansion)


def _format_arguments(inputs: Inputs, verbosity: int, format_name: str) -> str:
    from linkwright.xacro.tracing.arguments import arguments_data, examine_arguments
    from linkwright.xacro.tracing.arguments_text import find_incompleteness, format_arguments

    examination = examine_arguments(inputs)
    if verbosity > _QUIET:
        print_diagnostics([*find_incompleteness(examination), *examination.unused_warnings], sys.stderr)
    if format_name == "json":
        return _format_json({"arguments": arguments_data(examination.arguments)})
    return format_arguments(examination.arguments)


def _format_provenance(inputs: Inputs, name: str, format_name: str) -> str:
    from linkwright.xacro.inspection import provenance_of_named
    from linkwright.xacro.limits import recursion_limit_for
    from linkwright.xacro.tracing.provenance_text import provenance_data, provenance_text

    provenances = provenance_of_named(inputs, name)
    if format_name == "json":
        with recursion_limit_for(inputs.limits):  # elements can be nested more deeply than Python's default limit
            return _format_json({"elements": [provenance_data(provenance) for provenance in provenances]})
    return "\n".join(map(provenance_text, provenances))


def _format_json(data: object) -> str:
    import json

    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"
