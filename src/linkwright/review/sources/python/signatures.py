"""Compare the parameters of Python functions with calls and with other versions."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from dataclasses import dataclass

from linkwright.packages.readers.python_values import parse_python

_DATA_CLASS, _NAMED_TUPLE = "dataclass", "NamedTuple"
_PLAIN_OPTIONS = frozenset({"repr", "eq", "order", "unsafe_hash", "frozen", "match_args", "slots", "weakref_slot"})
"""The options of data classes that leave the parameters as they are."""
NOTHING = "None"
"""The result of a function that returns no value."""


@dataclass(frozen=True)
class Signature:
    """The parameters of a function.

    Attributes:
        text: the parameters as written, in parentheses and without annotations.
        positional: the names of the parameters that take positional arguments.
        positional_only_count: the number of positional-only parameters.
        required_count: the number of required positional parameters.
        keywords: the names of the keyword-only parameters.
        required_keywords: the names of the required keyword-only parameters.
        has_varargs: whether the function takes any number of positional arguments (``*args``).
        has_kwargs: whether the function takes any keyword argument (``**kwargs``).
    """

    text: str
    positional: tuple[str, ...]
    positional_only_count: int
    required_count: int
    keywords: tuple[str, ...]
    required_keywords: tuple[str, ...]
    has_varargs: bool
    has_kwargs: bool

    def fits(self, call: ast.Call) -> bool:
        """Return whether a call fits the function. A call with uncertain arguments fits."""
        names = [keyword.arg for keyword in call.keywords]
        if None in names or any(isinstance(argument, ast.Starred) for argument in call.args):
            return True
        count = len(call.args)
        given = set(self.positional[:count])
        named = {*self.positional[self.positional_only_count :], *self.keywords}
        is_known = all(name in named or self.has_kwargs for name in names)
        is_complete = {*self.positional[: self.required_count], *self.required_keywords} <= given | set(names)
        return (
            is_known and is_complete and given.isdisjoint(names) and (count <= len(self.positional) or self.has_varargs)
        )

    def accepts_calls_of(self, other: Signature) -> bool:
        """Return whether a function accepts all calls of another version.

        Calls with keyword arguments for positional parameters are not considered.
        """
        count = len(other.positional)
        if set(other.positional) <= set(self.positional) and self.positional[:count] != other.positional:
            return False  # a parameter before others, which get other arguments now
        has_room = len(self.positional) >= len(other.positional) or self.has_varargs
        missing_keywords = set(other.keywords) - {*self.keywords, *self.positional}
        return (
            self.required_count <= other.required_count
            and has_room
            and set(self.required_keywords) <= set(other.keywords)
            and (not missing_keywords or self.has_kwargs)
            and self.has_varargs >= other.has_varargs
            and self.has_kwargs >= other.has_kwargs
        )


_NO_PARAMETERS = Signature("()", (), 0, 0, (), (), has_varargs=False, has_kwargs=False)


def is_self_contained(definition: ast.ClassDef) -> bool:
    """Return whether a class certainly has no methods other than those in its body."""
    bases = [ast.unparse(base) for base in definition.bases]
    names = {node.name for node in definition.body if isinstance(node, ast.FunctionDef)}
    is_undecorated = not definition.decorator_list and not definition.keywords
    return is_undecorated and bases in ([], ["object"]) and "__getattr__" not in names


def read_method_signatures(
    definition: ast.ClassDef, *, with_private: bool = False
) -> Iterator[tuple[ast.FunctionDef, Signature]]:
    """Yield the undecorated methods of a class and their parameters, by default only public ones."""
    for node in definition.body:
        is_public = isinstance(node, ast.FunctionDef) and (with_private or not node.name.startswith("_"))
        if isinstance(node, ast.FunctionDef) and is_public and not node.decorator_list and node.args.args:
            yield node, _make_signature(node.args, first=1)


def read_signature(definition: ast.stmt) -> Signature | None:
    """Return the parameters of a function or class, or None if they are uncertain.

    The parameters of a class are those of its constructor.
    """
    if isinstance(definition, (ast.FunctionDef, ast.AsyncFunctionDef)) and not definition.decorator_list:
        return _make_signature(definition.args, first=0)
    if isinstance(definition, ast.ClassDef) and is_data_class(definition):
        return _make_field_signature(definition)
    if not isinstance(definition, ast.ClassDef) or definition.decorator_list or definition.keywords:
        return None
    methods = {node.name: node for node in definition.body if isinstance(node, ast.FunctionDef)}
    if "__new__" in methods:
        return None
    if "__init__" in methods:
        is_certain = not methods["__init__"].decorator_list
        return _make_signature(methods["__init__"].args, first=1) if is_certain else None
    return _NO_PARAMETERS if is_self_contained(definition) else None


def is_data_class(definition: ast.ClassDef) -> bool:
    """Return whether the fields of a class are the parameters of its constructor: a data class or named tuple."""
    bases = [ast.unparse(base).rpartition(".")[2] for base in definition.bases]
    decorators = [node.func if isinstance(node, ast.Call) else node for node in definition.decorator_list]
    names = [ast.unparse(node).rpartition(".")[2] for node in decorators]
    methods = {node.name for node in definition.body if isinstance(node, ast.FunctionDef)}
    is_plain = not definition.keywords and methods.isdisjoint(("__init__", "__new__"))
    return is_plain and (names, bases) in (([_DATA_CLASS], []), ([_DATA_CLASS], ["object"]), ([], [_NAMED_TUPLE]))


def _make_field_signature(definition: ast.ClassDef) -> Signature | None:
    """Return the parameters of a data class or named tuple, or None if they are uncertain."""
    decorators = [node for node in definition.decorator_list if isinstance(node, ast.Call)]
    if any(keyword.arg not in _PLAIN_OPTIONS for node in decorators for keyword in node.keywords):
        return None
    names: list[str] = []
    defaults: list[ast.expr] = []
    for node in definition.body:
        if not isinstance(node, ast.AnnAssign) or not isinstance(node.target, ast.Name):
            continue
        annotation, value = ast.unparse(node.annotation).rpartition(".")[2], node.value
        options: dict[str | None, ast.expr] = {}
        if isinstance(value, ast.Call) and ast.unparse(value.func).rpartition(".")[2] == "field":
            options = {keyword.arg: keyword.value for keyword in value.keywords}
            factory = options.get("default_factory")
            value = options.get("default", None if factory is None else ast.Call(factory, [], []))
        if annotation == "KW_ONLY" or None in options or "kw_only" in options:
            return None
        if "ClassVar" in annotation or ("init" in options and ast.unparse(options["init"]) == "False"):
            continue
        names.append(node.target.id)
        if value is not None:
            defaults.append(value)
        elif defaults:
            return None  # Python refuses it
    arguments = ast.arguments([], [ast.arg(name) for name in names], None, [], [], None, defaults)
    return _make_signature(arguments, first=0)


def ignores_keywords(definition: ast.stmt) -> bool:
    """Return whether a function, or the constructor of a class, takes any keyword argument but uses none of them."""
    if isinstance(definition, ast.ClassDef):
        constructors = (node for node in definition.body if getattr(node, "name", "") == "__init__")
        return any(ignores_keywords(node) for node in constructors)
    if not isinstance(definition, (ast.FunctionDef, ast.AsyncFunctionDef)) or definition.args.kwarg is None:
        return False
    name = definition.args.kwarg.arg
    names = {node.id for part in definition.body for node in ast.walk(part) if isinstance(node, ast.Name)}
    return names.isdisjoint((name, "locals"))


def find_returned(function: ast.FunctionDef) -> str | None:
    """Return the text of a result that a function returns, `NOTHING` if it returns none, or None if it is uncertain.

    A type that the function states counts before the returned expressions. Of these, calls are uncertain, because they
    may return nothing, too. A function that only raises an error or has no code may be a pattern for others.
    """
    nodes = list(_walk_function(function))
    if any(isinstance(node, (ast.Yield, ast.YieldFrom)) for node in nodes) or _is_pattern(function):
        return None
    values = [node.value for node in nodes if isinstance(node, ast.Return) and node.value is not None]
    values = [value for value in values if not (isinstance(value, ast.Constant) and value.value is None)]
    if not values:
        return NOTHING
    stated = "" if function.returns is None else ast.unparse(function.returns)
    if stated not in ("", NOTHING):
        return stated
    certain = [value for value in values if not isinstance(value, (ast.Call, ast.Await, ast.IfExp, ast.BoolOp))]
    return ast.unparse(certain[0]) if certain else None


def count_returned(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int | None:
    """Return the number of values that each ``return`` of a function lists, or None if it is uncertain."""
    nodes = list(_walk_function(function))
    values = [node.value for node in nodes if isinstance(node, ast.Return)]
    counts = {
        len(value.elts)
        if isinstance(value, ast.Tuple) and not any(isinstance(item, ast.Starred) for item in value.elts)
        else None
        for value in values
    }
    is_generator = any(isinstance(node, (ast.Yield, ast.YieldFrom)) for node in nodes)
    return counts.pop() if len(counts) == 1 and not is_generator and not function.decorator_list else None


def _is_pattern(function: ast.FunctionDef) -> bool:
    """Return whether a function has no code, or ends with an error."""
    body = function.body[ast.get_docstring(function) is not None :]
    is_empty = all(isinstance(node, ast.Pass) or ast.unparse(node) == "..." for node in body)
    return is_empty or isinstance(body[-1], ast.Raise)


def _walk_function(function: ast.FunctionDef | ast.AsyncFunctionDef) -> Iterator[ast.AST]:
    """Yield the nodes in the body of a function without those of inner functions and classes."""
    stack: list[ast.AST] = list(function.body)
    while stack:
        node = stack.pop()
        yield node
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.ClassDef)):
            stack.extend(ast.iter_child_nodes(node))


def find_argument_default(tree: ast.AST, name: ast.Name) -> ast.expr | None:
    """Return the default of a parameter in the function that uses it, or None for other names.

    A parameter that the function assigns has none.

    Args:
        tree: the syntax tree that contains the function.
        name: the use of the parameter.
    """
    functions = [
        node
        for node in ast.walk(tree)
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and any(inner is name for inner in ast.walk(node))
    ]
    if not functions:
        return None
    function = functions[-1]  # the innermost one
    arguments = function.args
    positional = [*arguments.posonlyargs, *arguments.args]
    defaults = dict(zip([item.arg for item in reversed(positional)], reversed(arguments.defaults), strict=False))
    keywords = zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
    defaults |= {item.arg: default for item, default in keywords if default is not None}
    is_assigned = any(
        isinstance(node, ast.Name) and node.id == name.id and not isinstance(node.ctx, ast.Load)
        for node in ast.walk(function)
    )
    return None if is_assigned else defaults.get(name.id)


def parse_signature(text: str) -> Signature | None:
    """Return the parameters in a parenthesized text, or None if the text is something else."""
    try:
        (definition,) = parse_python(f"def f{text}: ...").body
    except (SyntaxError, ValueError):
        return None
    return read_signature(definition)


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
