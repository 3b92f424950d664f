"""The functions of ``ament_index_python.packages`` for the current package finder."""

from __future__ import annotations

from pathlib import Path

from linkwright.packages.active import current_finder
from linkwright.packages.share_layout import find_prefix


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:  # noqa: ARG001 - as in ament
    """Return the share folder of a package.

    Raises:
        PackageNotFoundError: PKG101, there is no such package.
    """
    return current_finder().share(package_name)


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:  # noqa: ARG001 - as in ament
    """Return the share folder of a package as a string.

    Raises:
        PackageNotFoundError: PKG101, there is no such package.
    """
    return str(current_finder().share(package_name))


def get_package_prefix(package_name: str) -> str:
    """Return the install prefix of a package.

    Raises:
        PackageNotFoundError: PKG101, there is no such package.
    """
    return str(find_prefix(package_name, current_finder().share(package_name)))


def get_packages_with_prefixes() -> dict[str, str]:
    """Return the install prefixes of all packages, by name."""
    return {name: str(find_prefix(name, share)) for name, share in current_finder().packages().items()}
