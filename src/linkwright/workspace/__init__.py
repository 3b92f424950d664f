"""Where ROS packages are: environment, colcon workspaces, source trees, and the ones shipped with us."""

from linkwright.workspace.active import current_finder, use_finder
from linkwright.workspace.errors import PackageNotFoundError
from linkwright.workspace.finder import PackageFinder
from linkwright.workspace.manifest import enclosing_package, package_name

__all__ = [
    "PackageFinder",
    "PackageNotFoundError",
    "current_finder",
    "enclosing_package",
    "package_name",
    "use_finder",
]
