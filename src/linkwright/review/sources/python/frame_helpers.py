"""Find the functions of a Python source that write their arguments into the frames of messages."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple


class FrameArgument(NamedTuple):
    """An argument of a function that becomes the frame of a message.

    Attributes:
        field: the field of the message, such as ``child_frame_id``.
        position: the index of the argument, without the object of a method.
        name: the name of the argument.
    """

    field: str
    position: int
    name: str


def find_frame_arguments(tree: ast.Module, fields: Collection[str]) -> Mapping[str, list[FrameArgument]]:
    """Return the arguments that become frames, by the name of the function.

    Functions that share their name are left out, as are arguments to which the function assigns another value.

    Args:
        tree: the syntax tree of the source.
        fields: the names of the fields with frames.
    """
    functions: dict[str, list[FrameArgument]] = {}
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            functions[node.name] = [] if node.name in names else list(_read_function(node, fields))
            names.add(node.name)
    return functions


def _read_function(
    function: ast.FunctionDef | ast.AsyncFunctionDef, fields: Collection[str]
) -> Iterator[FrameArgument]:
    arguments = [argument.arg for argument in (*function.args.posonlyargs, *function.args.args)]
    if arguments[:1] == ["self"]:
        del arguments[0]
    nodes = list(ast.walk(function))
    assigned = {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    for node in nodes:
        if not isinstance(node, ast.Assign) or not isinstance(node.value, ast.Name):
            continue
        name = node.value.id
        for target in node.targets:
            is_frame = isinstance(target, ast.Attribute) and target.attr in fields
            if is_frame and isinstance(target, ast.Attribute) and name in arguments and name not in assigned:
                yield FrameArgument(target.attr, arguments.index(name), name)
