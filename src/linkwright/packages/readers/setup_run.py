"""An interpreter for a ``setup.py`` that computes ``data_files`` with loops and functions.

Python does not run the file. The interpreter implements the necessary part of the language: assignments, loops,
conditions, functions, and the library functions in `linkwright.packages.readers.setup_library`. An unknown value is
`_UNKNOWN`, and no decision may depend on it.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path, PurePosixPath

from linkwright.loading.lean_typing import Any
from linkwright.packages.readers.installed import InstalledFile
from linkwright.packages.readers.python_values import PYTHON_COMPARISONS
from linkwright.packages.readers.setup_library import (
    METHODS_BY_TYPE,
    PATH_ATTRIBUTES,
    NotKnownError,
    PackageLibrary,
    check_size,
    compute_weight,
    format_template,
    percent_format,
)

_MAX_STEPS = 300_000
_MAX_WEIGHT = 100_000
_WEIGHT_PER_STEP = 32
_MAX_DEPTH = 40
_BUILTINS: dict[str, Callable[..., Any]] = {
    **{call.__name__: call for call in (len, list, tuple, set, dict, str, zip, sorted, any, all, bool, int, min, max)},
    **{call.__name__: call for call in (enumerate, reversed, map, filter)},
    "range": lambda *numbers: check_size(list(range(*numbers)[:20_001])),
    "sum": lambda items, start=0: [entry for item in items for entry in item] if start == [] else sum(items, start),
    "print": lambda *_, **__: None,
}


class _Unknown:
    """The type of `_UNKNOWN`, the value of an expression that cannot be evaluated."""


_UNKNOWN = _Unknown()


class _ModuleMember:
    """A member of a module that is identified by its full name."""

    def __init__(self, name: str) -> None:
        self.name = name


class _CannotContinueError(Exception):
    """Raised when the execution depends on a value that is unknown or too slow to compute."""


class _ExitError(Exception):
    """Raised to execute ``break``, ``continue`` or ``return`` with the returned `value`."""

    def __init__(self, kind: str, value: Any = None) -> None:
        super().__init__(kind)
        self.kind = kind
        self.value = value


class _SetupCalledError(Exception):
    """Raised with the data files when ``setup`` is called."""

    def __init__(self, data_files: Any) -> None:
        super().__init__()
        self.data_files = data_files


def run_setup(tree: ast.Module, folder: Path) -> list[InstalledFile] | None:
    """Return the files that a ``setup.py`` installs as ``data_files``.

    The result is None if the file cannot be interpreted.

    Args:
        tree: the syntax tree of the file.
        folder: the folder of the package.
    """
    library = PackageLibrary(folder)
    try:
        _Interpreter(library).body(tree.body)
    except _SetupCalledError as called:
        return list(_iterate_installed_files(called.data_files, library))
    except Exception:  # noqa: BLE001 - the user's expressions may raise anything
        return None
    return None


def _iterate_installed_files(data_files: Any, library: PackageLibrary) -> Iterator[InstalledFile]:
    for entry in data_files if isinstance(data_files, (list, tuple)) else ():
        if not isinstance(entry, (list, tuple)) or len(entry) != 2 or not isinstance(entry[1], (list, tuple)):
            continue
        for file in entry[1]:
            try:
                source = library.relative(file)
            except NotKnownError:
                continue
            if isinstance(entry[0], (str, PurePosixPath)) and library.functions["os.path.isfile"](source):
                yield InstalledFile(source, str(PurePosixPath(entry[0]) / PurePosixPath(source).name))


class _Interpreter:
    def __init__(self, library: PackageLibrary) -> None:
        self._library = library
        self._scopes: list[dict[str, Any]] = [{"__file__": "setup.py", "__name__": "__main__"}]
        self._defined_functions: set[Any] = set()  # the functions that the file defines
        self._steps = self._depth = 0

    # --- statements --------------------------------------------------------------------------------------------------

    def body(self, statements: Iterable[ast.stmt]) -> None:
        for statement in statements:
            self._count_step()
            self._run_statement(statement)

    def _count_step(self) -> None:
        self._steps += 1
        if self._steps > _MAX_STEPS:
            raise _CannotContinueError

    def _run_statement(self, node: ast.stmt) -> None:
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            self._import(node)
        elif isinstance(node, ast.FunctionDef):
            self._scopes[-1][node.name] = self._make_function(node.args, node.body)
        elif isinstance(node, ast.Assign):
            value = self._evaluate(node.value)
            for target in node.targets:
                self._bind(target, value)
        elif isinstance(node, ast.AnnAssign):
            self._bind(node.target, _UNKNOWN if node.value is None else self._evaluate(node.value))
        elif isinstance(node, ast.AugAssign):
            self._augment(node)
        elif isinstance(node, ast.Expr):
            self._evaluate(node.value)
        elif isinstance(node, ast.For):
            self._loop(node)
        elif isinstance(node, ast.If):
            self.body(node.body if self._evaluate_truth(node.test) else node.orelse)
        elif isinstance(node, ast.With):
            for item in node.items:
                if item.optional_vars is not None:
                    self._bind(item.optional_vars, _UNKNOWN)
            self.body(node.body)
        elif isinstance(node, ast.Try):
            self.body([*node.body, *node.orelse, *node.finalbody])
        elif isinstance(node, ast.Return):
            raise _ExitError("return", None if node.value is None else self._evaluate(node.value))
        elif isinstance(node, (ast.Break, ast.Continue)):
            raise _ExitError("break" if isinstance(node, ast.Break) else "continue")
        elif isinstance(node, ast.ClassDef):
            self._scopes[-1][node.name] = _UNKNOWN
        elif not isinstance(node, (ast.Pass, ast.Assert, ast.Global, ast.Delete)):
            raise NotKnownError

    def _import(self, node: ast.Import | ast.ImportFrom) -> None:
        for alias in node.names:
            if isinstance(node, ast.ImportFrom):
                self._scopes[-1][alias.asname or alias.name] = _ModuleMember(f"{node.module}.{alias.name}")
            else:
                name = alias.name if alias.asname else alias.name.partition(".")[0]
                self._scopes[-1][alias.asname or name] = _ModuleMember(name)

    def _augment(self, node: ast.AugAssign) -> None:
        value = self._evaluate(ast.BinOp(_load_expression(node.target), node.op, node.value))
        old_value = self._evaluate(_load_expression(node.target))
        if isinstance(old_value, list) and isinstance(value, list):
            old_value[:] = value  # change the list in place, because other names may refer to it
        else:
            self._bind(node.target, value)

    def _loop(self, node: ast.For) -> None:
        for item in self._items(self._evaluate(node.iter)):
            self._count_step()
            self._bind(node.target, item)
            try:
                self.body(node.body)
            except _ExitError as leave:
                if leave.kind == "break":
                    return
                if leave.kind == "return":
                    raise
        self.body(node.orelse)

    def _bind(self, target: ast.expr, value: Any) -> None:
        if isinstance(target, ast.Name):
            self._scopes[-1][target.id] = value
        elif isinstance(target, (ast.Tuple, ast.List)):
            values = [_UNKNOWN] * len(target.elts) if value is _UNKNOWN else list(self._items(value))
            for element, element_value in zip(target.elts, values, strict=True):
                self._bind(element, element_value)
        elif isinstance(target, ast.Subscript):
            owner = self._evaluate(target.value)
            if isinstance(owner, list) and isinstance(target.slice, ast.Slice):
                owner[self._slice(target.slice)] = list(self._items(value))
            elif isinstance(owner, (dict, list)):
                owner[self._evaluate(target.slice)] = value

    # --- expressions -------------------------------------------------------------------------------------------------

    def _evaluate(self, node: ast.expr) -> Any:
        """Return the value of an expression, or `_UNKNOWN` if it cannot be evaluated."""
        self._count_step()
        try:
            value = check_size(self._evaluate_or_raise(node))
        except (NotKnownError, TypeError, ValueError, AttributeError, LookupError, OSError):
            return _UNKNOWN
        if isinstance(value, (list, tuple, dict, set)):
            self._count_weight(value)
        return value

    def _count_weight(self, value: Any) -> None:
        value_weight = compute_weight(value, _MAX_WEIGHT)
        self._steps += value_weight // _WEIGHT_PER_STEP
        if value_weight == _MAX_WEIGHT:
            raise _CannotContinueError

    def _evaluate_known(self, node: ast.expr) -> Any:
        value = self._evaluate(node)
        if value is _UNKNOWN:
            raise NotKnownError
        return value

    def _evaluate_truth(self, node: ast.expr) -> bool:
        value = self._evaluate(node)
        if value is _UNKNOWN:
            raise _CannotContinueError  # the next steps depend on this value
        return bool(value)

    def _items(self, value: Any) -> Iterator[Any]:
        if isinstance(value, (_Unknown, _ModuleMember)):
            raise _CannotContinueError
        yield from value

    def _evaluate_or_raise(self, node: ast.expr) -> Any:
        evaluator = _EVALUATORS.get(type(node))
        if evaluator is None:
            raise NotKnownError
        return evaluator(self, node)

    def _constant(self, node: ast.Constant) -> Any:
        return node.value

    def _name(self, node: ast.Name) -> Any:
        for scope in reversed(self._scopes):
            if node.id in scope:
                return scope[node.id]
        if node.id in _BUILTINS:
            return _BUILTINS[node.id]
        raise NotKnownError

    def _elements(self, nodes: Iterable[ast.expr]) -> list[Any]:
        values: list[Any] = []
        for node in nodes:
            if isinstance(node, ast.Starred):
                values += self._items(self._evaluate(node.value))
            else:
                values.append(self._evaluate(node))
        return values

    def _sequence(self, node: ast.List | ast.Tuple | ast.Set) -> Any:
        construct: Callable[[Any], Any] = {ast.List: list, ast.Tuple: tuple, ast.Set: set}[type(node)]
        return construct(self._elements(node.elts))

    def _dict(self, node: ast.Dict) -> dict[Any, Any]:
        mapping: dict[Any, Any] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            if key is None:
                mapping |= self._evaluate_known(value)
            else:
                mapping[self._evaluate_known(key)] = self._evaluate(value)
        return mapping

    def _f_string(self, node: ast.JoinedStr) -> str:
        texts: list[str] = []
        for piece in node.values:
            if isinstance(piece, ast.FormattedValue):
                if piece.format_spec is not None or piece.conversion not in (-1, ord("s")):
                    raise NotKnownError
                texts.append(str(self._evaluate_known(piece.value)))
            else:
                texts.append(self._evaluate_known(piece))
        return "".join(texts)

    def _operation(self, node: ast.BinOp) -> Any:
        left, right = self._evaluate_known(node.left), self._evaluate_known(node.right)
        if isinstance(node.op, ast.Add) and isinstance(left, (str, list, tuple, int)):
            return left + right
        if isinstance(node.op, ast.Sub) and isinstance(left, int):
            return left - right
        if isinstance(node.op, ast.Div) and isinstance(left, PurePosixPath):
            return left / right
        if isinstance(node.op, ast.Mod) and isinstance(left, str):
            return percent_format(left, right)
        raise NotKnownError

    def _logic(self, node: ast.BoolOp) -> Any:
        value = None
        for operand in node.values:
            value = self._evaluate_known(operand)
            if bool(value) == isinstance(node.op, ast.Or):
                break
        return value

    def _unary(self, node: ast.UnaryOp) -> Any:
        value = self._evaluate_known(node.operand)
        if isinstance(node.op, ast.Not):
            return not value
        if isinstance(node.op, ast.USub) and isinstance(value, int):
            return -value
        raise NotKnownError

    def _comparison(self, node: ast.Compare) -> bool:
        left = self._evaluate_known(node.left)
        for operation, right in zip(node.ops, map(self._evaluate_known, node.comparators), strict=True):
            if not PYTHON_COMPARISONS[type(operation)](left, right):
                return False
            left = right
        return True

    def _conditional(self, node: ast.IfExp) -> Any:
        return self._evaluate(node.body if self._evaluate_truth(node.test) else node.orelse)

    def _comprehension(self, node: ast.ListComp | ast.GeneratorExp | ast.SetComp) -> Any:
        self._scopes.append({})
        try:
            items = list(self._evaluate_generators(node.generators, lambda: self._evaluate(node.elt)))
        finally:
            self._scopes.pop()
        return set(items) if isinstance(node, ast.SetComp) else items

    def _evaluate_generators(self, generators: list[ast.comprehension], value: Callable[[], Any]) -> Iterator[Any]:
        if not generators:
            yield value()
            return
        generator, *remaining_generators = generators
        for item in self._items(self._evaluate(generator.iter)):
            self._count_step()
            self._bind(generator.target, item)
            if all(self._evaluate_truth(condition) for condition in generator.ifs):
                yield from self._evaluate_generators(remaining_generators, value)

    def _subscript(self, node: ast.Subscript) -> Any:
        owner = self._evaluate_known(node.value)
        key = self._slice(node.slice) if isinstance(node.slice, ast.Slice) else self._evaluate_known(node.slice)
        if not isinstance(owner, (str, list, tuple, dict)):
            raise NotKnownError
        return owner[key]

    def _slice(self, node: ast.Slice) -> slice:
        return slice(
            *(None if part is None else self._evaluate_known(part) for part in (node.lower, node.upper, node.step))
        )

    def _attribute(self, node: ast.Attribute) -> Any:
        owner = self._evaluate_known(node.value)
        if isinstance(owner, _ModuleMember):
            return "/" if owner.name == "os" and node.attr == "sep" else _ModuleMember(f"{owner.name}.{node.attr}")
        if isinstance(owner, PurePosixPath) and node.attr in PATH_ATTRIBUTES:
            return getattr(owner, node.attr)
        return self._method(owner, node.attr)

    def _method(self, owner: Any, name: str) -> Callable[..., Any]:
        if isinstance(owner, str) and name == "format":
            return lambda *arguments, **keywords: format_template(owner, *arguments, **keywords)
        if isinstance(owner, PurePosixPath) and name in self._library.path_methods:
            return lambda *arguments, **keywords: self._library.path_methods[name](owner, *arguments, **keywords)
        if any(isinstance(owner, kind) and name in names for kind, names in METHODS_BY_TYPE.items()):
            method: Callable[..., Any] = getattr(owner, name)
            return method
        raise NotKnownError

    def _lambda(self, node: ast.Lambda) -> Callable[..., Any]:
        return self._make_function(node.args, [ast.Return(node.body)])

    # --- calls -------------------------------------------------------------------------------------------------------

    def _call(self, node: ast.Call) -> Any:
        function = self._evaluate_known(node.func)
        keyword_arguments: dict[str, Any] = {}
        for keyword in node.keywords:
            if keyword.arg is None:
                keyword_arguments |= self._evaluate_known(keyword.value)
            else:
                keyword_arguments[keyword.arg] = self._evaluate(keyword.value)
        arguments = self._elements(node.args)
        if isinstance(function, _ModuleMember):
            if function.name.rpartition(".")[2] == "setup":
                raise _SetupCalledError(keyword_arguments.get("data_files"))
            function = self._find_library_function(function.name)
        if not callable(function):
            raise NotKnownError
        accepts_unknown = (
            getattr(function, "__name__", "") in ("append", "insert", "setdefault", "add")
            or function in self._defined_functions
        )
        if not accepts_unknown and any(value is _UNKNOWN for value in (*arguments, *keyword_arguments.values())):
            raise NotKnownError
        result = function(*(self._resolve_function(value) for value in arguments), **keyword_arguments)
        return (
            list(result)
            if isinstance(result, (map, filter, zip, enumerate, Mapping)) and not isinstance(result, dict)
            else result
        )

    def _resolve_function(self, value: Any) -> Any:
        return self._find_library_function(value.name) if isinstance(value, _ModuleMember) else value

    def _find_library_function(self, name: str) -> Callable[..., Any]:
        try:
            return self._library.functions[name]
        except KeyError:
            raise NotKnownError from None

    def _make_function(self, parameters: ast.arguments, body: list[ast.stmt]) -> Callable[..., Any]:
        names = [parameter.arg for parameter in (*parameters.posonlyargs, *parameters.args)]
        defaults = dict(zip(reversed(names), reversed(self._elements(parameters.defaults)), strict=False))
        keyword_only = {
            parameter.arg: _UNKNOWN if default is None else self._evaluate(default)
            for parameter, default in zip(parameters.kwonlyargs, parameters.kw_defaults, strict=True)
        }
        outer = self._scopes[1:]

        def called(*arguments: Any, **keyword_arguments: Any) -> Any:
            scope = {**defaults, **keyword_only, **dict(zip(names, arguments, strict=False)), **keyword_arguments}
            if parameters.vararg is not None:
                scope[parameters.vararg.arg] = arguments[len(names) :]
            outer_scopes, self._scopes = self._scopes, [self._scopes[0], *outer, scope]
            self._depth += 1
            try:
                if self._depth > _MAX_DEPTH:
                    raise _CannotContinueError
                self.body(body)
            except _ExitError as leave:
                return leave.value
            finally:
                self._depth -= 1
                self._scopes = outer_scopes
            return None

        self._defined_functions.add(called)
        return called


def _load_expression(target: ast.expr) -> ast.expr:
    """Return an expression that reads the target of an assignment."""
    return ast.Name(target.id, ast.Load()) if isinstance(target, ast.Name) else target


_EVALUATORS: dict[type[ast.expr], Callable[[_Interpreter, Any], Any]] = {
    ast.Constant: _Interpreter._constant,
    ast.Name: _Interpreter._name,
    **dict.fromkeys((ast.List, ast.Tuple, ast.Set), _Interpreter._sequence),
    ast.Dict: _Interpreter._dict,
    ast.JoinedStr: _Interpreter._f_string,
    ast.BinOp: _Interpreter._operation,
    ast.BoolOp: _Interpreter._logic,
    ast.UnaryOp: _Interpreter._unary,
    ast.Compare: _Interpreter._comparison,
    ast.IfExp: _Interpreter._conditional,
    **dict.fromkeys((ast.ListComp, ast.GeneratorExp, ast.SetComp), _Interpreter._comprehension),
    ast.Subscript: _Interpreter._subscript,
    ast.Attribute: _Interpreter._attribute,
    ast.Lambda: _Interpreter._lambda,
    ast.Call: _Interpreter._call,
}
