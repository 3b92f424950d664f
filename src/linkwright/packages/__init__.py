"""The search for ROS packages in the environment, workspaces, sources and Linkwright."""

from linkwright.packages.active import current_finder, use_finder
from linkwright.packages.ament import install_prefix, is_installed
from linkwright.packages.ament_functions import (
    get_package_prefix,
    get_package_share_directory,
    get_package_share_path,
    get_packages_with_prefixes,
)
from linkwright.packages.finder import PackageFinder, PackageNotFoundError
from linkwright.packages.manifest import MANIFEST, enclosing_package, package_name
from linkwright.packages.share_layout import is_substitute

__all__ = [
    "MANIFEST",
    "PackageFinder",
    "PackageNotFoundError",
    "current_finder",
    "enclosing_package",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
    "install_prefix",
    "is_installed",
    "is_substitute",
    "package_name",
    "use_finder",
]
