"""Find Python files that use functions which a changed module no longer offers."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, SourceText, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.python.methods import is_defined_by_others
from linkwright.review.sources.python.objects import FailingUse, KnownClass, find_failing_uses, read_classes
from linkwright.review.sources.python.own_calls import find_own_calls, read_methods
from linkwright.review.sources.python.package_imports import PACKAGE_FILE
from linkwright.review.sources.python.signatures import Signature, count_returned, read_signature
from linkwright.review.sources.python.undefined_names import find_bound_names
from linkwright.review.sources.python_names import parse_source
from linkwright.review.sources.reading import is_generated, try_read_source
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_PATH_EXTENSION = re.compile(r"^\s*sys\.path\.(?:append|insert|extend)\(", re.MULTILINE)
"""A statement with which a file can import modules of other folders by their names."""
_CLASS = re.compile(r"^class\s+(?P<name>\w+)", re.MULTILINE)
_MAX_DEPTH = 3
"""The maximum number of ``__init__.py`` files that lead to a class."""


@dataclass(frozen=True)
class _Module:
    """The names of a module.

    Attributes:
        names: all names that the module binds.
        defined: the names of its functions and classes.
        signatures: the parameters of these functions and classes, if these are certain.
        is_complete: whether the module certainly has no other names.
        counts: the numbers of values that functions return, if these are certain.
        methods: the parameters of methods, as ``Class.method``, if these are certain.
    """

    names: frozenset[str]
    defined: frozenset[str]
    signatures: dict[str, Signature]
    is_complete: bool
    counts: Mapping[str, int]
    methods: dict[str, Signature]


@dataclass(frozen=True)
class _LostNames:
    """The functions and classes that a module removed or changed.

    Attributes:
        path: the path of the module.
        removed: the names of the removed functions and classes.
        changed: the old and new parameters of changed functions and classes.
        is_removed: whether the whole module was removed.
        counts: the old and new numbers of values that changed functions return.
    """

    path: str
    removed: frozenset[str] = frozenset()
    changed: Mapping[str, tuple[Signature, Signature]] = field(default_factory=dict)
    is_removed: bool = False
    counts: Mapping[str, tuple[int, int]] = field(default_factory=dict)


def find_broken_callers(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files that import a removed name, or call a function with unsuitable arguments.

    Only modules of the repository that match exactly one file are searched. Methods and attributes are checked if the
    class of their object is certain.
    """
    yield from _find_failing_uses(versions, changed_files)
    for file in changed_files:
        yield from ((file.path, change) for change in _find_own_failures(versions, file))
    lost = [module for file in changed_files if (module := _find_lost(versions, file)) is not None]
    if not lost:
        return
    files = _PythonFiles(versions.new, [module.path for module in lost if module.is_removed])
    for path in files.paths:
        text = versions.new.text(path)
        candidates = [
            module for module in lost if _get_module_word(module.path) in text and _mentions_any(module, text)
        ]
        tree = _parse(versions.new, path) if candidates else None
        if tree is None:
            continue
        for module in candidates:
            if module.path != path:
                yield from ((path, change) for change in _Caller(files, path, tree, module).find_changes())


def _find_failing_uses(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files that newly use an attribute or method that the class or the class of the object lacks."""
    changed = [file.new_path for file in changed_files if file.new_path and file.new_path.endswith(PYTHON_SUFFIX)]
    if not changed:
        return
    files = {version: _PythonFiles(version, ()) for version in (versions.old, versions.new)}
    old_paths = {file.new_path: file.old_path for file in changed_files}
    classes = {match["name"] for path in changed for match in _CLASS.finditer(versions.new.text(path))}
    for path in files[versions.new].paths:
        text = versions.new.text(path)
        if path not in changed and not any(name in text for name in classes):
            continue
        new = list(_list_failing_uses(files[versions.new], path))
        old_path = old_paths.get(path, path)
        old = {use[:3] for use in _list_failing_uses(files[versions.old], old_path)} if new and old_path else set()
        first_uses = {use.attribute: use for use in reversed(new) if use[:3] not in old}
        for use in sorted(first_uses.values(), key=lambda use: use.node.lineno):
            yield path, _make_use_change(path, use)


def _make_use_change(path: str, use: FailingUse) -> Change:
    names = {"name": use.attribute, "class_name": use.class_name, "file": use.path}
    location = Location(path, use.node.lineno, use.node.col_offset + 1)
    if use.is_call:
        message = phrase("calls the method '{name}', which '{class_name}' in '{file}' does not have", **names)
        return Change(message, Effect.BREAKING, phrase("the call fails"), location)
    message = phrase("uses the attribute '{name}', which '{class_name}' in '{file}' does not have", **names)
    return Change(message, Effect.BREAKING, phrase("the access fails"), location)


def _list_failing_uses(files: _PythonFiles, path: str) -> Iterator[FailingUse]:
    tree = _parse(files.version, path)
    return iter(()) if tree is None else find_failing_uses(tree, partial(_find_classes, files, path))


def _find_classes(files: _PythonFiles, path: str, name: str, level: int, depth: int = 0) -> dict[str, KnownClass]:
    """Return the known classes of a module that a file imports, with those that an ``__init__.py`` imports from it."""
    module_path = files.find_module(path, name, level)
    tree = None if module_path is None else _parse(files.version, module_path)
    if module_path is None or tree is None:
        return {}
    classes = read_classes(module_path, files.version.file(module_path), tree)
    imports = tree.body if PurePosixPath(module_path).name == PACKAGE_FILE and depth < _MAX_DEPTH else ()
    for node in imports:
        if isinstance(node, ast.ImportFrom):
            found = _find_classes(files, module_path, node.module or "", node.level, depth + 1)
            classes.update(
                {alias.asname or alias.name: found[alias.name] for alias in node.names if alias.name in found}
            )
    return classes


def _find_lost(versions: Versions, file: ChangedFile) -> _LostNames | None:
    """Return the functions and classes that a module removed or changed, or None."""
    path = file.old_path
    if path is None or not path.endswith(PYTHON_SUFFIX) or file.is_submodule:
        return None
    if path != file.new_path:
        is_built = file.new_path is None and is_generated(versions.old.text(path))
        return None if is_built else _LostNames(path, is_removed=True)
    old, new = (_read_module(version, path) for version in (versions.old, versions.new))
    if old is None or new is None:
        return None
    removed = old.defined - new.names if new.is_complete else frozenset[str]()
    common = old.signatures.keys() & new.signatures.keys()
    changed = {name: (old.signatures[name], new.signatures[name]) for name in common}
    changed = {name: pair for name, pair in changed.items() if pair[0].text != pair[1].text}
    counts = {name: (count, new.counts[name]) for name, count in old.counts.items() if name in new.counts}
    counts = {name: pair for name, pair in counts.items() if pair[0] != pair[1]}
    return _LostNames(path, removed, changed, counts=counts) if removed or changed or counts else None


def _find_own_failures(versions: Versions, file: ChangedFile) -> Iterator[Change]:
    """Yield the calls by which a changed module uses its own functions and methods with their old arguments."""
    path = file.new_path
    if path is None or not path.endswith(PYTHON_SUFFIX) or file.old_path is None or file.is_submodule:
        return
    old, new, tree = (
        _read_module(versions.old, file.old_path),
        _read_module(versions.new, path),
        _parse(versions.new, path),
    )
    if old is None or new is None or tree is None:
        return
    before, after = old.signatures | old.methods, new.signatures | new.methods
    changed = [name for name in before if name in after and before[name].text != after[name].text]
    for name, call in sorted(find_own_calls(tree, changed), key=lambda item: item[1].lineno):
        if not before[name].fits(call) or after[name].fits(call):
            continue
        class_name, _, method = name.rpartition(".")
        if not class_name or not is_defined_by_others(versions.new, path, class_name, method):
            yield _make_call_change(path, path, name, after[name], call)


def _make_call_change(path: str, module: str, name: str, signature: Signature, call: ast.Call) -> Change:
    """Return the change that a file calls a function of a module with the old arguments."""
    text = phrase(
        "calls '{name}' of '{file}' with the old arguments; the new ones are {arguments}",
        name=name,
        file=module,
        arguments=signature.text,
    )
    return Change(text, Effect.BREAKING, phrase("the call fails"), Location(path, call.lineno, call.col_offset + 1))


def _get_module_word(path: str) -> str:
    pure_path = PurePosixPath(path)
    return pure_path.parent.name if pure_path.name == PACKAGE_FILE else pure_path.stem


def _mentions_any(lost: _LostNames, text: str) -> bool:
    return lost.is_removed or any(name in text for name in (*lost.removed, *lost.changed, *lost.counts))


def _parse(version: Version, path: str) -> ast.Module | None:
    source: SourceText | None = try_read_source(version.file(path))
    try:
        return None if source is None else parse_source(source).tree
    except (SyntaxError, ValueError, RecursionError):
        return None


def _read_module(version: Version, path: str) -> _Module | None:
    tree = _parse(version, path)
    if tree is None:
        return None
    bound = list(find_bound_names(tree))
    definitions = [
        node for node in tree.body if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef))
    ]
    pairs = ((node.name, read_signature(node)) for node in definitions if bound.count(node.name) == 1)
    is_dynamic = {"__getattr__", "*"} & set(bound) or any(
        isinstance(node, ast.Name) and node.id in ("globals", "exec") for node in ast.walk(tree)
    )
    signatures = {name: signature for name, signature in pairs if signature is not None}
    counts = {
        node.name: count
        for node in definitions
        if isinstance(node, ast.FunctionDef) and node.name in signatures and (count := count_returned(node)) is not None
    }
    defined = frozenset(node.name for node in definitions)
    return _Module(frozenset(bound), defined, signatures, not is_dynamic, counts, read_methods(tree))


class _PythonFiles:
    """The Python sources of a version.

    Args:
        version: the version of the repository.
        removed: the paths of modules that only the other version has.

    Attributes:
        paths: the paths of all sources. Other files do not import those in folders of tests.
    """

    def __init__(self, version: Version, removed: Sequence[str]) -> None:
        self.paths = list(version.paths((PYTHON_SUFFIX,)))
        self._modules = [path for path in self.paths if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)]
        self._removed_paths = removed
        self.version = version

    @cached_property
    def _all_paths(self) -> frozenset[str]:
        return frozenset((*self._modules, *self._removed_paths))

    def find_module(self, path: str, name: str, level: int) -> str | None:
        """Return the path of the module that a file imports.

        The result is None unless exactly one file matches.

        Args:
            path: the path of the file.
            name: the name of the module; empty for a package.
            level: the number of dots before the name.
        """
        folder = PurePosixPath(path).parent
        part = name.replace(".", "/")
        if level:
            parents = [folder, *folder.parents]
            bases = [parents[level - 1] / part] if level <= len(parents) else []
            files = [f"{base}{end}" for base in bases for end in (PYTHON_SUFFIX, f"/{PACKAGE_FILE}")]
            return self._get_only_path(file for file in files if file in self._all_paths)
        sibling = (folder / f"{part}{PYTHON_SUFFIX}").as_posix()
        if "/" not in part:
            if sibling in self._modules:
                return sibling
            package = self._find_python_package(part)
            if package is not None:
                return package
            if not _PATH_EXTENSION.search(self.version.text(path)):
                return None  # a module that does not exist here may belong to a different package
            return self._get_only_path(
                file for file in self._modules if PurePosixPath(file).name == f"{part}{PYTHON_SUFFIX}"
            )
        ends = (f"/{part}{PYTHON_SUFFIX}", f"/{part}/{PACKAGE_FILE}")
        return self._get_only_path(file for file in self._all_paths if f"/{file}".endswith(ends))

    def _find_python_package(self, name: str) -> str | None:
        """Return the ``__init__.py`` of a Python package that the ROS package of the same name contains, or None."""
        end = f"{name}/{name}/{PACKAGE_FILE}"
        files = (file for file in self._modules if name and f"/{file}".endswith(f"/{end}"))
        path = self._get_only_path(files)
        return (
            path
            if path is not None and self.version.package_of(path) == path.removesuffix(f"/{name}/{PACKAGE_FILE}")
            else None
        )

    @staticmethod
    def _get_only_path(paths: Iterable[str]) -> str | None:
        matches = list(paths)
        return matches[0] if len(matches) == 1 else None


class _Caller:
    """Finds the imports and calls of a file that fail in the new version.

    Args:
        files: the sources of the version.
        path: the path of the file.
        tree: the syntax tree of the file.
        lost: the functions and classes that the module removed or changed.
    """

    def __init__(self, files: _PythonFiles, path: str, tree: ast.Module, lost: _LostNames) -> None:
        self._files = files
        self._path = path
        self._tree = tree
        self._lost = lost
        self._bound_names = list(find_bound_names(tree))
        try_statements = (node for node in ast.walk(tree) if isinstance(node, ast.Try))
        self._guarded_ids = {id(inner) for node in try_statements for part in node.body for inner in ast.walk(part)}

    def find_changes(self) -> Iterator[Change]:
        """Yield the imports of removed names and the calls that no longer fit."""
        functions: dict[str, str] = {}  # the local name of a function, and its name in the module
        modules: set[str] = set()  # the local names of the module, with dots
        for node in ast.walk(self._tree):
            if isinstance(node, ast.Import):
                lost = [alias for alias in node.names if self._is_lost_module(alias.name, 0)]
                modules.update(alias.asname or alias.name for alias in lost)
                if lost and self._lost.is_removed:
                    yield from self._report_import(node, None)
            elif isinstance(node, ast.ImportFrom):
                for alias in node.names:
                    yield from self._check_import(node, alias, functions, modules)
        yield from self._check_calls(functions, modules)

    def _check_import(
        self, node: ast.ImportFrom, alias: ast.alias, functions: dict[str, str], modules: set[str]
    ) -> Iterator[Change]:
        """Yield a change if an imported name was removed.

        The local name of any other import is added to `functions` or `modules`.
        """
        local = alias.asname or alias.name
        name = f"{node.module}.{alias.name}" if node.module else alias.name
        is_module = self._is_lost_module(name, node.level)
        if not is_module and not self._is_lost_module(node.module or "", node.level):
            return
        if self._lost.is_removed:
            if is_module or alias is node.names[0]:
                yield from self._report_import(node, None)
        elif is_module:
            modules.add(local)
        elif alias.name in self._lost.removed:
            yield from self._report_import(node, alias.name)
        elif alias.name in {**self._lost.changed, **self._lost.counts} and self._bound_names.count(local) == 1:
            functions[local] = alias.name

    def _report_import(self, node: ast.stmt, name: str | None) -> Iterator[Change]:
        """Yield the change that an import fails, unless the file handles the failure."""
        if id(node) in self._guarded_ids:
            return
        text = phrase("imports '{file}', which no longer exists", file=self._lost.path)
        if name is not None:
            text = phrase("imports '{name}', which '{file}' no longer has", name=name, file=self._lost.path)
        yield self._make_change(text, phrase("the import fails"), node)

    def _check_calls(self, functions: Mapping[str, str], modules: set[str]) -> Iterator[Change]:
        """Yield the calls that fit only the old parameters or results, and the calls of removed functions."""
        for node in ast.walk(self._tree):
            if isinstance(node, ast.Assign):
                yield from self._check_unpacking(node, functions, modules)
            name = self._find_function(node, functions, modules)
            if name is None or not isinstance(node, ast.Call):
                continue
            if name in self._lost.removed and id(node) not in self._guarded_ids:
                text = phrase("calls '{name}', which '{file}' no longer has", name=name, file=self._lost.path)
                yield self._make_change(text, phrase("the call fails"), node)
            elif name in self._lost.changed:
                old, new = self._lost.changed[name]
                if old.fits(node) and not new.fits(node):
                    yield _make_call_change(self._path, self._lost.path, name, new, node)

    def _check_unpacking(self, node: ast.Assign, functions: Mapping[str, str], modules: set[str]) -> Iterator[Change]:
        """Yield a change if a statement unpacks the old number of values that a function returns."""
        name = self._find_function(node.value, functions, modules)
        target = node.targets[0]
        if name is None or name not in self._lost.counts or not isinstance(target, (ast.Tuple, ast.List)):
            return
        old, new = self._lost.counts[name]
        if len(target.elts) == old and not any(isinstance(item, ast.Starred) for item in target.elts):
            text = phrase(
                "unpacks {old} values of '{name}' of '{file}', which returns {new} now",
                old=old,
                name=name,
                file=self._lost.path,
                new=new,
            )
            yield self._make_change(text, phrase("the statement fails"), node)

    def _find_function(self, node: ast.AST, functions: Mapping[str, str], modules: set[str]) -> str | None:
        """Return the name of the function of the module that a call runs, or None."""
        if not isinstance(node, ast.Call):
            return None
        if isinstance(node.func, ast.Attribute) and self._is_module(node.func.value, modules):
            return node.func.attr
        return functions.get(node.func.id) if isinstance(node.func, ast.Name) else None

    def _is_module(self, node: ast.expr, modules: set[str]) -> bool:
        text = ast.unparse(node) if isinstance(node, (ast.Name, ast.Attribute)) else ""
        return text in modules and ("." in text or self._bound_names.count(text) == 1)

    def _is_lost_module(self, name: str, level: int) -> bool:
        return self._files.find_module(self._path, name, level) == self._lost.path

    def _make_change(self, text: Phrase, reason: Phrase, node: ast.stmt | ast.expr) -> Change:
        return Change(text, Effect.BREAKING, reason, Location(self._path, node.lineno, node.col_offset + 1))
