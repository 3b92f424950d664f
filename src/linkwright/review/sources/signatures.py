"""Compare the parameters of Python functions: which calls fit, and which calls another version accepts."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class Signature:
    """The parameters of a function.

    Attributes:
        text: the parameters as written, in parentheses and without annotations.
        positional: the names of the parameters that take positional arguments.
        unnamed: the number of positional-only parameters.
        required: the number of required positional parameters.
        keywords: the names of the keyword-only parameters.
        required_keywords: the names of the required keyword-only parameters.
        has_rest: whether the function takes any other positional arguments (``*args``).
        has_keywords: whether the function takes any other keyword arguments (``**kwargs``).
    """

    text: str
    positional: tuple[str, ...]
    unnamed: int
    required: int
    keywords: tuple[str, ...]
    required_keywords: tuple[str, ...]
    has_rest: bool
    has_keywords: bool

    def fits(self, call: ast.Call) -> bool:
        """Return whether a call fits the function. A call with uncertain arguments fits."""
        names = [keyword.arg for keyword in call.keywords]
        if None in names or any(isinstance(argument, ast.Starred) for argument in call.args):
            return True
        count = len(call.args)
        given = set(self.positional[:count])
        named = {*self.positional[self.unnamed :], *self.keywords}
        is_known = all(name in named or self.has_keywords for name in names)
        is_complete = {*self.positional[: self.required], *self.required_keywords} <= given | set(names)
        return is_known and is_complete and given.isdisjoint(names) and (count <= len(self.positional) or self.has_rest)

    def accepts_calls_of(self, other: Signature) -> bool:
        """Return whether this version accepts all calls of another version that use no argument names."""
        has_room = len(self.positional) >= len(other.positional) or self.has_rest
        rest = set(other.keywords) - {*self.keywords, *self.positional}
        return (
            self.required <= other.required
            and has_room
            and set(self.required_keywords) <= set(other.keywords)
            and (not rest or self.has_keywords)
            and self.has_rest >= other.has_rest
            and self.has_keywords >= other.has_keywords
        )


_NONE = Signature("()", (), 0, 0, (), (), has_rest=False, has_keywords=False)


def is_plain(definition: ast.ClassDef) -> bool:
    """Return whether a class certainly has no methods besides its body."""
    bases = [ast.unparse(base) for base in definition.bases]
    names = {node.name for node in definition.body if isinstance(node, ast.FunctionDef)}
    is_bare = not definition.decorator_list and not definition.keywords
    return is_bare and bases in ([], ["object"]) and "__getattr__" not in names


def method_signatures(definition: ast.ClassDef) -> Iterator[tuple[ast.FunctionDef, Signature]]:
    """Yield the public methods, without decorators, of a class without base classes, with their parameters."""
    if not is_plain(definition):
        return
    for node in definition.body:
        is_public = isinstance(node, ast.FunctionDef) and not node.name.startswith("_")
        if isinstance(node, ast.FunctionDef) and is_public and not node.decorator_list and node.args.args:
            yield node, _make_signature(node.args, first=1)


def signature_of(definition: ast.stmt) -> Signature | None:
    """Return the parameters of a function, or of the constructor of a class, or None if they are not certain."""
    if isinstance(definition, (ast.FunctionDef, ast.AsyncFunctionDef)) and not definition.decorator_list:
        return _make_signature(definition.args, first=0)
    if not isinstance(definition, ast.ClassDef) or definition.decorator_list or definition.keywords:
        return None
    methods = {node.name: node for node in definition.body if isinstance(node, ast.FunctionDef)}
    if "__new__" in methods:
        return None
    if "__init__" in methods:
        is_certain = not methods["__init__"].decorator_list
        return _make_signature(methods["__init__"].args, first=1) if is_certain else None
    return _NONE if is_plain(definition) else None


def parse_signature(text: str) -> Signature | None:
    """Return the parameters in a parenthesized text, or None if the text is something else."""
    try:
        (definition,) = ast.parse(f"def f{text}: ...").body
    except (SyntaxError, ValueError):
        return None
    return signature_of(definition)


def _make_signature(arguments: ast.arguments, first: int) -> Signature:
    """Return the signature of a list of parameters.

    Args:
        arguments: the syntax tree of the parameters.
        first: the number of leading parameters to leave out, such as ``self``.
    """
    arguments = copy.deepcopy(arguments)
    for argument in ast.walk(arguments):
        if isinstance(argument, ast.arg):
            argument.annotation = None
    positional = [argument.arg for argument in (*arguments.posonlyargs, *arguments.args)]
    required = len(positional) - len(arguments.defaults)
    keywords = [argument.arg for argument in arguments.kwonlyargs]
    pairs = zip(keywords, arguments.kw_defaults, strict=True)
    unnamed = max(0, len(arguments.posonlyargs) - first)
    for _ in range(first):
        del (arguments.posonlyargs or arguments.args)[:1]
    return Signature(
        f"({ast.unparse(arguments)})",
        tuple(positional[first:]),
        unnamed,
        max(0, required - first),
        tuple(keywords),
        tuple(name for name, default in pairs if default is None),
        arguments.vararg is not None,
        arguments.kwarg is not None,
    )
