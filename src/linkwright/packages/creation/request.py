"""The request for a new package."""

from __future__ import annotations

from pathlib import Path

from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import Literal

BuildType = Literal["cmake", "ament_cmake", "ament_python"]
BUILD_TYPES: tuple[BuildType, ...] = ("cmake", "ament_cmake", "ament_python")

DEFAULT_DESCRIPTION = "TODO: Package description"
DEFAULT_LICENSE = "TODO: License declaration"


@dataclass(frozen=True)
class Maintainer:
    """A maintainer of a package."""

    name: str
    email: str

    def __str__(self) -> str:
        return f"{self.name} <{self.email}>"


@dataclass(frozen=True)
class PackageRequest:
    """The properties of the package to create.

    Attributes:
        destination: the folder in which the package's folder is created, as the user wrote it.
        license: an SPDX identifier or any other text; a ``LICENSE`` is written only for a known identifier.
        dependencies: the names of packages for ``<depend>``.
        node_name: the name of an initial executable, or None.
        library_name: the name of an initial library, or None.
        year: the year in the copyright line of the ``LICENSE``.
    """

    name: str
    maintainer: Maintainer
    year: int
    destination: Path = Path()
    package_format: int = 3
    build_type: BuildType = "ament_cmake"
    description: str = DEFAULT_DESCRIPTION
    license: str = DEFAULT_LICENSE
    dependencies: tuple[str, ...] = ()
    node_name: str | None = None
    library_name: str | None = None

    @property
    def node(self) -> str | None:
        """The executable's name, or None.

        If the library has the same name, a suffix is added, because both are CMake targets.
        """
        if self.node_name is not None and self.node_name == self.library_name:
            return f"{self.node_name}_node"
        return self.node_name
