"""Read text constants of included headers and imported Python modules."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import SourceText
from linkwright.files.git_repository import ChangedFile
from linkwright.packages import enclosing_package
from linkwright.packages.readers.python_values import PythonFile
from linkwright.review.caching import cached_in_review
from linkwright.review.sources.cpp.values import read_initial_values
from linkwright.review.sources.names import CPP_SUFFIXES, HEADER_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_CONSTANT = re.compile(
    r"\b(?:const|constexpr)\b[^;={}()\"]*?\b(?P<name>\w+)\s*(?:\[\s*\])?\s*(?:=|\{|\()\s*\"(?P<text>[^\"\\]*)\"\s*[)}]?\s*;|"
    r"^[ \t]*#[ \t]*define[ \t]+(?P<macro>\w+)[ \t]+\(?\"(?P<value>[^\"\\]*)\"\)?[ \t]*$",
    re.MULTILINE,
)
_PACKAGE_FILE = "__init__.py"
_MAX_BYTES = 1 << 20
_MAX_USERS = 50
"""The maximum number of unchanged sources that are compared because of a changed constant."""


def read_header_constants(texts: Sequence[str]) -> dict[str, str]:
    """Return the text constants of headers by name. A name with several values is left out.

    Args:
        texts: the texts of the headers without comments.
    """
    values_by_name: dict[str, set[str]] = {}
    for text in texts:
        for match in _CONSTANT.finditer(text):
            value = match["text"] if match["name"] else match["value"]
            values_by_name.setdefault(match["name"] or match["macro"], set()).add(value)
    return {name: values.pop() for name, values in values_by_name.items() if len(values) == 1}


def read_imported_constants(path: Path, tree: ast.Module) -> dict[str, ast.expr]:
    """Return the text constants that a source imports from its folder or package.

    The keys are the names in the source, such as ``SCAN``, or ``topics.SCAN`` for a constant of an imported module.
    """
    constants: dict[str, ast.expr] = {}
    for node in tree.body:
        if isinstance(node, ast.ImportFrom):
            own = _read_module_constants(path, node.module or "", node.level)
            for alias in node.names:
                local = alias.asname or alias.name
                if alias.name in own:
                    constants[local] = own[alias.name]
                    continue
                members = {name: value for name, value in own.items() if name.startswith(f"{alias.name}.")}
                constants |= {f"{local}{name.removeprefix(alias.name)}": value for name, value in members.items()}
                module = f"{node.module}.{alias.name}" if node.module else alias.name
                inner = _read_module_constants(path, module, node.level)
                constants |= {f"{local}.{name}": value for name, value in inner.items()}
        elif isinstance(node, ast.Import):
            for alias in node.names:
                own = _read_module_constants(path, alias.name, 0)
                constants |= {f"{alias.asname or alias.name}.{name}": value for name, value in own.items()}
    return constants


def _read_module_constants(path: Path, module: str, level: int) -> Mapping[str, ast.expr]:
    """Return the text constants of a module that a source imports.

    The result is empty for a module outside of the package.
    """
    file = find_own_module(path, module, level)
    return {} if file is None else _read_python_constants(str(file), file.stat().st_mtime_ns)


def find_own_module(path: Path, module: str, level: int) -> Path | None:
    """Return the file of a module of the same package, or None for a module outside of it.

    Targets of links that leave the folder of the package, and ``..`` that leaves the package, are outside.

    Args:
        path: the path of the source that imports the module.
        module: the name of the module without leading dots.
        level: the number of dots before the name.
    """
    parts = module.split(".") if module else []
    beside = path.parents[level - 1] if 0 < level <= len(path.parents) else path.parent
    bases = [beside.joinpath(*parts)]
    package = enclosing_package(path.parent)
    root = path.parent if package is None else package[1]
    base = root.resolve()
    if not level and parts:
        bases += [parent.parent.joinpath(*parts) for parent in path.parents if parent.name == parts[0]]
        folders = [root / part for part in ("", "src") if (root / part / parts[0] / "__init__.py").is_file()]
        bases += [folder.joinpath(*parts) for folder in folders]
    ends = (base_path.with_name(f"{base_path.name}{PYTHON_SUFFIX}") for base_path in bases if parts)
    files = ((file, file.resolve()) for file in (*ends, *(base_path / _PACKAGE_FILE for base_path in bases)))
    return next(
        (
            target
            for file, target in files
            if target.is_relative_to(base) or (file.is_relative_to(root) and target.is_relative_to(base.parent))
            if target.is_file()
        ),
        None,
    )


@cached_in_review(maxsize=256)
def read_module(path: str, _modified_ns: int) -> ast.Module | None:
    """Return the syntax tree of a Python file, or None if it cannot be read or parsed."""
    file = Path(path)
    try:
        if file.stat().st_size > _MAX_BYTES:
            return None
        return PythonFile(SourceText(path, file.read_text("utf-8"))).tree
    except (OSError, SyntaxError, ValueError, RecursionError):
        return None


@cached_in_review(maxsize=256)
def _read_python_constants(path: str, modified_ns: int) -> Mapping[str, ast.expr]:
    """Return the names at the top of a Python file, and in its classes, that get a text once.

    The text may be made of other such names. Names in classes are qualified, such as ``Topics.SCAN``.
    """
    tree = read_module(path, modified_ns)
    if tree is None:
        return {}
    file = PythonFile(SourceText(path, Path(path).read_text("utf-8")))
    constants: dict[str, ast.expr] = {}
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    counts = {f"{node.name}.": _count_assigned(node) for node in classes}
    counts[""] = _count_assigned(tree)
    for own in classes:
        counts[""] -= counts[f"{own.name}."]
    for scope, body in (("", tree.body), *((f"{node.name}.", node.body) for node in classes)):
        for node in body:
            text = file.text(node.value) if isinstance(node, ast.Assign) else None
            for target in node.targets if isinstance(node, ast.Assign) and text is not None else ():
                if isinstance(target, ast.Name) and counts[scope][target.id] == 1:
                    constants[f"{scope}{target.id}"] = ast.Constant(text)
    return constants


def _count_assigned(tree: ast.AST) -> Counter[str]:
    """Return how often the statements in a module or class assign each name."""
    return Counter(node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store))


def find_constant_users(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[ChangedFile]:
    """Yield the unchanged sources that use a constant or member whose value changed.

    Only sources of the same package are searched.
    """
    changed = {path for file in changed_files for path in (file.old_path, file.new_path)}
    users: dict[str, None] = {}
    for file in changed_files:
        path = PurePosixPath(file.path)
        if None in (file.old_path, file.new_path) or path.suffix not in (*HEADER_SUFFIXES, PYTHON_SUFFIX):
            continue
        old, new = (
            _read_constants(versions.old, file.old_path or ""),
            _read_constants(versions.new, file.new_path or ""),
        )
        names = [name for name, value in new.items() if name in old and old[name] != value]
        if not names:
            continue
        suffixes = (PYTHON_SUFFIX,) if path.suffix == PYTHON_SUFFIX else CPP_SUFFIXES
        word = path.stem if path.suffix == PYTHON_SUFFIX else path.name
        if path.name == _PACKAGE_FILE:
            word = path.parent.name
        pattern = re.compile(rf"\b(?:{'|'.join(map(re.escape, names))})\b")
        for user in versions.new.paths(suffixes, versions.new.package_of(file.path) or ""):
            text = versions.new.text(user)
            is_searched = user not in changed and TEST_FOLDERS.isdisjoint(PurePosixPath(user).parts)
            if is_searched and word in text and pattern.search(text) and versions.old.file(user).is_file():
                users[user] = None
    yield from (ChangedFile(user, user) for user in list(users)[:_MAX_USERS])


def _read_constants(version: Version, path: str) -> dict[str, str]:
    """Return the text constants of a header or a Python module, and the initial values of the members of a header."""
    file = version.file(path)
    if not path.endswith(PYTHON_SUFFIX):
        text = version.text(path)
        return read_initial_values(text) | read_header_constants([text])
    values = _read_python_constants(str(file), file.stat().st_mtime_ns) if file.is_file() else {}
    return {name: str(value.value) for name, value in values.items() if isinstance(value, ast.Constant)}
