"""Find the parameters without which a node of rospy fails."""

from __future__ import annotations

import ast

from linkwright.packages.readers.python_values import PythonFile, called_name

_READER = "rospy.get_param"
_OTHER_USES = ("has_param", "set_param", "search_param")
_EXITS = frozenset({"exit", "_exit", "signal_shutdown"})


def is_required_parameter(python: PythonFile, call: ast.Call) -> bool:
    """Return whether a call raises an error that ends the program if the parameter is not set.

    Args:
        python: the parsed file.
        call: the call that reads the parameter.
    """
    if called_name(call) != _READER or len(call.args) != 1 or call.keywords:
        return False
    name = python.text(call.args[0])
    if any(python.text(other.args[0]) == name for other in python.calls(*_OTHER_USES) if other.args):
        return False
    return not any(_handles_errors(node, call) for node in ast.walk(python.tree) if isinstance(node, ast.Try))


def _handles_errors(node: ast.Try, call: ast.Call) -> bool:
    """Return whether the handlers of a ``try`` statement continue after an error in a call."""
    first, last = node.body[0], node.body[-1]
    if not first.lineno <= call.lineno <= (last.end_lineno or last.lineno):
        return False
    return not all(any(_ends(inner) for inner in ast.walk(handler)) for handler in node.handlers)


def _ends(node: ast.AST) -> bool:
    """Return whether a statement raises an error or ends the program."""
    is_exit = isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] in _EXITS
    return is_exit or isinstance(node, ast.Raise)
