"""The ament resource index of packages' resources (``ament_index_python.resources``).

Packages in source trees are treated as registered under the type ``packages``. Their other resources are known only
after a build.
"""

from __future__ import annotations

import os
from pathlib import Path

from linkwright.packages.active import current_finder
from linkwright.packages.ament import install_prefix, is_installed, list_environment_prefixes

RESOURCE_INDEX = Path("share", "ament_index", "resource_index")
_PACKAGES_TYPE = "packages"
_SEPARATORS = ("/", "\\")


class InvalidResourceTypeNameError(Exception):
    """Raised when the name of a resource type is empty or contains a path separator."""


class InvalidResourceNameError(Exception):
    """Raised when the name of a resource is empty or contains a path separator."""


def get_search_paths() -> list[str]:
    """Return the prefixes to search for resources, in order.

    Raises:
        LookupError: there are no such prefixes.
    """
    prefixes = [str(prefix) for prefix in _list_prefixes() if prefix.is_dir()]
    if not prefixes:
        raise LookupError("Environment variable 'AMENT_PREFIX_PATH' is not set or empty")
    return prefixes


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """Return the content of a resource, and the prefix that contains the resource.

    Raises:
        LookupError: there is no such resource.
        OSError: the resource cannot be read.
        InvalidResourceTypeNameError: the type is invalid.
        InvalidResourceNameError: the name is invalid.
    """
    prefix = _find_resource(resource_type, resource_name)
    if prefix is None:
        raise LookupError(f"Could not find the resource '{resource_name}' of type '{resource_type}'")
    marker = prefix / RESOURCE_INDEX / resource_type / resource_name
    return (marker.read_text(encoding="utf-8") if marker.is_file() else ""), str(prefix)


def has_resource(resource_type: str, resource_name: str) -> str | bool:
    """Return the prefix that contains a resource, or False if there is no such resource.

    Raises:
        InvalidResourceTypeNameError: the type is invalid.
        InvalidResourceNameError: the name is invalid.
    """
    prefix = _find_resource(resource_type, resource_name)
    return False if prefix is None else str(prefix)


def get_resources(resource_type: str) -> dict[str, str]:
    """Return the prefix of each resource of a type, by resource name.

    Raises:
        InvalidResourceTypeNameError: the type is invalid.
    """
    _check_type(resource_type)
    prefixes_by_name: dict[str, str] = {}
    for prefix in _list_prefixes():
        for name in _list_entries(prefix / RESOURCE_INDEX / resource_type):
            prefixes_by_name.setdefault(name, str(prefix))
    if resource_type == _PACKAGES_TYPE:
        for name, share in current_finder().packages().items():
            prefixes_by_name.setdefault(name, str(install_prefix(share)))
    return prefixes_by_name


def get_resource_types() -> set[str]:
    """Return the types of all resources."""
    types = {_PACKAGES_TYPE} if current_finder().packages() else set()
    for prefix in _list_prefixes():
        types.update(entry.name for entry in (prefix / RESOURCE_INDEX).glob("*") if entry.is_dir())
    return types


def _find_resource(kind: str, name: str) -> Path | None:
    _check_type(kind)
    if not name or any(separator in name for separator in _SEPARATORS):
        raise InvalidResourceNameError(f"Resource name '{name}' is empty or has a path separator in it")
    if kind == _PACKAGES_TYPE:
        share = current_finder().find(name)
        return None if share is None else install_prefix(share)
    return next((prefix for prefix in _list_prefixes() if (prefix / RESOURCE_INDEX / kind / name).is_file()), None)


def _check_type(kind: str) -> None:
    if not kind or any(separator in kind for separator in _SEPARATORS):
        raise InvalidResourceTypeNameError(f"Resource type '{kind}' is empty or has a path separator in it")


def _list_prefixes() -> list[Path]:
    """Return the prefixes of the environment, and of installed packages that are not sourced."""
    shares = current_finder().packages().values()
    unsourced = (install_prefix(share) for share in shares if is_installed(share))
    return list(dict.fromkeys([*list_environment_prefixes(os.environ), *unsourced]))


def _list_entries(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.glob("*") if path.is_file() and not path.name.startswith("."))
