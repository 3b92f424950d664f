"""Assets for clients: the meshes and images in packages that a robot description names."""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.packages import PackageFinder, enclosing_package

_PACKAGE = re.compile(r"package://([^/\s\"'%]+)/")
_SUFFIXES = frozenset(
    (".stl", ".dae", ".obj", ".glb", ".gltf", ".mtl", ".bin", ".png", ".jpg", ".jpeg", ".bmp", ".gif", ".webp", ".tga",
     ".tif", ".tiff", ".urdf", ".xacro")
)  # fmt: skip
_MAX_SIZE = 256 << 20


class AssetRefusedError(Exception):
    """Raised when an asset is refused.

    The message gives the reason.
    """


class Assets:
    """A reader of files by their ``package://`` addresses.

    Args:
        finder: finds packages; None for the finder of the environment, which is created on demand.
    """

    def __init__(self, finder: PackageFinder | None = None) -> None:
        self._finder = finder
        self._packages: set[str] = set()

    def allow_packages_in(self, text: str) -> None:
        """Allow the packages that a robot description names."""
        self._packages.update(_PACKAGE.findall(text))

    def read(self, uri: str) -> bytes:
        """Return the content of a file.

        Raises:
            AssetRefusedError: the file may not be read, or does not exist.
        """
        match = _PACKAGE.match(uri)
        relative = PurePosixPath(uri[match.end() :]) if match else PurePosixPath()
        if match is None or match[1] not in self._packages:
            raise AssetRefusedError("only files of packages that a robot description names are served")
        if relative.suffix.lower() not in _SUFFIXES:
            raise AssetRefusedError("only meshes and images are served")
        if ".." in relative.parts or relative.is_absolute() or "\0" in uri or "\\" in uri:
            raise AssetRefusedError("the path is outside its package")
        try:
            if self._finder is None:
                self._finder = PackageFinder()
            share = self._finder.find(match[1])
            if share is None:
                raise AssetRefusedError(phrase("there is no package '{package}'", package=match[1]))
            return _read_content(match[1], share, relative)
        except LinkwrightError as error:
            raise AssetRefusedError(error.diagnostics[0].message) from None
        except OSError as error:
            raise AssetRefusedError(error.strerror or str(error)) from None


def _read_content(package: str, share: Path, relative: PurePosixPath) -> bytes:
    """Return the content of a file of a package, after following and checking links.

    colcon links some files to other folders of the package.
    """
    path = (share / relative).resolve(strict=True)
    if not path.is_relative_to(share.resolve(strict=True)):
        enclosing = enclosing_package(path.parent)
        if enclosing is None or enclosing[0] != package:
            raise AssetRefusedError("a link points outside the package")
    if not path.is_file() or path.suffix.lower() not in _SUFFIXES:
        raise AssetRefusedError("the file is neither a mesh nor an image")
    if path.stat().st_size > _MAX_SIZE:
        raise AssetRefusedError(f"the file is larger than {_MAX_SIZE // 2**20} MiB")
    return path.read_bytes()
