"""Format substitutions of Python launch files like in XML launch files."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Sequence

from linkwright.packages.readers.launch_files import LAUNCH_FUNCTION
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name
from linkwright.review.launches.outlines import ALLOW_SUBSTITUTIONS
from linkwright.review.texts.list_changes import EMPTY

Formatter = Callable[[ast.expr | None], str]
"""A function that returns the text of an expression; empty if there is none."""
_MAX_TERMS = 30
_CONFIGURATIONS = "launch_configurations"
"""The attribute of a launch context with the values of the arguments."""
ENVIRONMENT_FUNCTION = re.compile(r"(os\.)?(environ\.get|getenv)")
"""The functions that return the value of an environment variable or a default."""
_PATH_CLASSES = ("Path", "PurePath", "PosixPath", "PurePosixPath")
_COMPARISON_SUBSTITUTIONS = {"EqualsSubstitution": "==", "NotEqualsSubstitution": "!="}
_PATH_FUNCTIONS = ("get_package_share_directory", "get_package_prefix", "join", "dirname")
_STRING_FUNCTIONS = (*_PATH_FUNCTIONS, "str", "getenv", "format")
_TEXT_METHODS = ("lstrip", "removeprefix", "removesuffix", "replace", "rstrip", "strip")
_OWN_FILE, _OWN_FOLDER = "__file__", "$(dirname)"
"""The name of a Python file in itself, and the folder of the launch file."""
_SAME_PATH_FUNCTIONS = ("abspath", "realpath", "normpath", "resolve", "absolute")
"""The functions and methods that return another form of a path."""
_PROGRAM_SEARCH = re.compile(r"^\$\(find-exec ([\w.-]+)\)")
"""A command with an explicit search for the program."""
_QUOTED_STRING = re.compile(r"""\s*(?P<quote>['"])(?P<text>[^'"\\]*)(?P=quote)\s*""")
"""An expression that is only a quoted text."""


def format_substitution(python: PythonFile, node: ast.Call, part: Formatter) -> str | None:
    """Return a substitution in the notation of XML launch files, or None for any other call."""
    function = called_name(node).rpartition(".")[2]
    arguments = get_call_arguments(node)
    first = arguments[0] if arguments else None
    if function == "LaunchConfiguration":
        default = argument_of(node, "default")
        return f"$(var {part(first)})" if default is None else f"$(var {part(first)} {part(default)})"
    if ENVIRONMENT_FUNCTION.fullmatch(called_name(node)) and len(arguments) > 1:
        return f"$(env {part(first)} {part(arguments[1]) or repr('')})"
    if function == "get" and isinstance(node.func, ast.Attribute) and is_configurations(python, node.func.value):
        return f"$(var {' '.join(map(part, arguments))})"
    if function in ("FindPackageShare", "get_package_share_directory", "get_package_share_path"):
        return f"$(find-pkg-share {part(first)})"
    if function in ("FindPackagePrefix", "get_package_prefix"):
        return f"$(find-pkg-prefix {part(first)})"
    if function == "ThisLaunchFileDir":
        return _OWN_FOLDER
    if function == "find" and isinstance(node.func, ast.Attribute):
        owner = python.resolved(node.func.value)
        is_share = isinstance(owner, ast.Call) and called_name(owner).rpartition(".")[2] == "FindPackageShare"
        return part(owner) if is_share else None
    if function in ("perform", "__str__", "as_posix") and isinstance(node.func, ast.Attribute):
        return part(node.func.value)
    if function in _SAME_PATH_FUNCTIONS:
        path = part(node.func.value if first is None and isinstance(node.func, ast.Attribute) else first)
        return path if path == _OWN_FILE or path.startswith(_OWN_FOLDER) else None
    if function == "dirname":
        return find_parent(python, part(first))
    if function == "joinpath" and isinstance(node.func, ast.Attribute):
        return _join_path([part(node.func.value), *map(part, arguments)])
    if function in _TEXT_METHODS and isinstance(node.func, ast.Attribute):
        return _format_text_method(part(node.func.value), function, node)
    if first is None:
        return None
    if function == "perform_substitution":
        return part(first)
    if function in _COMPARISON_SUBSTITUTIONS and len(arguments) > 1:
        left, right = (part(argument) or EMPTY for argument in arguments[:2])
        return f"{left} {_COMPARISON_SUBSTITUTIONS[function]} {right}"
    if function == "FindExecutable":
        return f"$(find-exec {part(first)})"
    if function in ("PathJoinSubstitution", "join"):
        if function != "join" and isinstance(python.resolved(first), ast.Call):
            return None  # it fails: only a list can be joined
        pieces = arguments if function == "join" else split_pieces(python, first)
        return _join_path(["".join(map(part, split_pieces(python, piece))) for piece in pieces])
    if function == "ParameterFile":
        return part(first) + _mark_substitutions(python, argument_of(node, ALLOW_SUBSTITUTIONS))
    if function in _PATH_CLASSES and len(node.args) > 1:
        return _join_path([part(argument) for argument in node.args])
    if function in ("TextSubstitution", "str", "ParameterValue", "PathSubstitution", *_PATH_CLASSES):
        return part(first)
    if function == "EnvironmentVariable":
        return f"$(env {' '.join(part(argument) or repr('') for argument in arguments)})"
    if function == "PythonExpression":
        return _format_expression("".join(map(part, split_pieces(python, first))))
    if function == "Command":
        return f"$(command {omit_program_search(''.join(map(part, split_pieces(python, first))))})"
    if function.endswith("LaunchDescriptionSource"):
        return "".join(map(part, split_pieces(python, first)))
    return None


def find_parent(python: PythonFile, path: str) -> str | None:
    """Return the folder around a path if it is the launch file or its folder, or None.

    Args:
        python: the file with the expression of the path.
        path: the text of the path.
    """
    functions = (node.name for node in python.tree.body if isinstance(node, ast.FunctionDef))
    if path == _OWN_FILE and LAUNCH_FUNCTION in functions:
        return _OWN_FOLDER
    return f"{path}/.." if path.startswith(_OWN_FOLDER) and path.rpartition("/")[2] in (_OWN_FOLDER, "..") else None


def omit_program_search(command: str) -> str:
    """Return a command without an explicit search for its program, which is the default."""
    return _PROGRAM_SEARCH.sub(r"\1", command)


def _format_text_method(text: str, method: str, call: ast.Call) -> str | None:
    """Return a call of a method of a substitution's text as an expression of XML launch files, or None."""
    arguments = [*call.args, *(keyword.value for keyword in call.keywords)]
    if not text.startswith("$(") or "'" in text or not all(isinstance(item, ast.Constant) for item in arguments):
        return None
    return f"$(eval '{text}'.{method}({', '.join(map(ast.unparse, arguments))}))"


def is_configurations(python: PythonFile, node: ast.expr) -> bool:
    """Return whether an expression holds the values of all arguments by name, as in ``OpaqueFunction``."""
    owner = python.resolved(node)
    return isinstance(owner, ast.Attribute) and owner.attr == _CONFIGURATIONS


def _mark_substitutions(python: PythonFile, node: ast.expr | None) -> str:
    """Return the mark of a parameter file with substitutions, from the argument that allows them."""
    node = None if node is None else python.resolved(node)
    if node is None or (isinstance(node, ast.Constant) and not node.value):
        return ""
    if isinstance(node, ast.Constant):
        return f" ({ALLOW_SUBSTITUTIONS})"
    return f" ({ALLOW_SUBSTITUTIONS} {ast.unparse(node)})"


def is_string(python: PythonFile, node: ast.expr) -> bool:
    """Return whether an expression certainly is a string, such as a sum with a string."""
    for _ in range(_MAX_TERMS):
        node = python.resolved(node)
        if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Add):
            break
        if _is_string_term(python.resolved(node.right)):
            return True
        node = node.left
    return _is_string_term(node)


def _is_string_term(node: ast.expr) -> bool:
    """Return whether an expression other than a sum is a string, such as the path of a package."""
    if isinstance(node, ast.Call):
        return called_name(node).rpartition(".")[2] in _STRING_FUNCTIONS
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mod):
        node = node.left
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def split_pieces(python: PythonFile, node: ast.expr) -> list[ast.expr]:
    """Return the items of a list, which a substitution joins, or any other expression as the only piece."""
    node = python.resolved(node)
    return node.elts if isinstance(node, (ast.List, ast.Tuple)) else [node]


def _format_expression(expression: str) -> str:
    """Return a Python expression as text.

    A quoted text loses its quotes, even if it contains substitutions.
    """
    quoted = _QUOTED_STRING.fullmatch(expression)
    return f"$(eval {expression})" if quoted is None else quoted["text"]


def _join_path(parts: Sequence[str]) -> str:
    """Return the path that ``os.path.join`` makes of its parts."""
    path = ""
    for part in parts:
        separator = "" if not path or path.endswith("/") else "/"
        path = part if part.startswith("/") else f"{path}{separator}{part}"
    return path


def get_call_arguments(node: ast.Call) -> list[ast.expr]:
    """Return the arguments of a call, including those with a name."""
    return [*node.args, *(keyword.value for keyword in node.keywords if keyword.arg is not None)]
