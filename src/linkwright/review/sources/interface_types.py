"""Find the packages of the messages, services and actions whose types sources name."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

_MODULES = r"(?:msg|srv|action)"
_PYTHON_TYPE = re.compile(rf"(?P<package>\w+)\.{_MODULES}\.(?:\w+\.)?(?P<name>\w+)")
_PYTHON_MODULE = re.compile(rf"\w+\.{_MODULES}")
_CPP_TYPE = re.compile(rf"(?P<package>\w+)::{_MODULES}::(?P<name>\w+)")
_CPP_ROS1_TYPE = re.compile(r"(?P<package>\w+)::(?P<name>\w+)")
_MAX_ALIASES = 4
"""The maximum number of names of a type that are followed."""


class PythonTypes:
    """The imported names of a Python source.

    Args:
        tree: the syntax tree of the source.
    """

    def __init__(self, tree: ast.Module) -> None:
        self._names: dict[str, str] = {}
        self._star_modules: set[str] = set()
        for node in ast.walk(tree):
            if isinstance(node, (ast.Import, ast.ImportFrom)):
                self._read_import(node)

    def find(self, node: ast.expr) -> str:
        """Return a type with its package, such as ``std_msgs/String``; empty if the package is not certain."""
        match = _PYTHON_TYPE.fullmatch(self.resolve(node))
        return f"{match['package']}/{match['name']}" if match is not None else ""

    def resolve(self, node: ast.expr) -> str:
        """Return the full dotted name of an imported object; empty for other expressions."""
        root, separator, rest = ast.unparse(node).partition(".")
        module = self._names.get(root)
        if module is None and not separator and isinstance(node, ast.Name) and len(self._star_modules) == 1:
            (star_module,) = self._star_modules
            return f"{star_module}.{root}" if _PYTHON_MODULE.fullmatch(star_module) else ""
        return f"{module}{separator}{rest}" if module else ""

    def _read_import(self, node: ast.Import | ast.ImportFrom) -> None:
        for alias in node.names:
            if isinstance(node, ast.Import):
                name = alias.asname or alias.name.partition(".")[0]
                self._add(name, alias.name if alias.asname else name)
            elif alias.name == "*":
                self._star_modules.add("." * node.level + (node.module or ""))
            else:
                self._add(alias.asname or alias.name, f"{node.module}.{alias.name}" if node.level == 0 else "")

    def _add(self, name: str, module: str) -> None:
        """Add an imported name. A name with several meanings has none."""
        self._names[name] = module if self._names.get(name, module) == module else ""


def find_cpp_type(name: str, texts: Sequence[str]) -> str:
    """Return a type with its package, such as ``std_msgs/String``; empty if the package is not certain.

    A type of ROS 1 needs an included header of its package.

    Args:
        name: the type as written, such as ``std_msgs::msg::String``.
        texts: the source and its headers, without comments.
    """
    name = re.sub(r"\s|\bconst\b", "", name).removeprefix("::")
    for _ in range(_MAX_ALIASES):
        root, separator, rest = name.partition("::")
        meanings = set(_find_aliases(root, texts, is_namespace=bool(separator)))
        if not meanings:
            break
        if len(meanings) > 1:
            return ""
        name = f"{meanings.pop()}{separator}{rest}"
    match = _CPP_TYPE.fullmatch(name)
    if match is None:
        match = _CPP_ROS1_TYPE.fullmatch(name)
        if match is None or not any(re.search(rf'#\s*include\s*["<]{match["package"]}/', text) for text in texts):
            return ""
    return f"{match['package']}/{match['name']}"


def _find_aliases(name: str, texts: Sequence[str], *, is_namespace: bool) -> Iterator[str]:
    """Yield the meanings of a name that ``using``, ``typedef`` or a namespace alias gives."""
    if not name.isidentifier():
        return
    meaning = r"(?P<meaning>(?:::)?\w+(?:::\w+)+|\w+)"
    patterns = [rf"\bnamespace\s+{name}\s*=\s*{meaning}\s*;"]
    if not is_namespace:
        patterns = [
            rf"\busing\s+{name}\s*=\s*{meaning}\s*;",
            rf"\btypedef\s+{meaning}\s+{name}\s*;",
            rf"\busing\s+(?P<meaning>(?:::)?(?:\w+::)+{name})\s*;",
        ]
    for text in texts:
        for pattern in patterns:
            for match in re.finditer(pattern, text):
                if match["meaning"] != name:
                    yield match["meaning"].removeprefix("::")
