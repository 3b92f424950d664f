"""The files that pages may fetch: meshes, files next to them, and generated files.

Neither a description nor a request can be trusted. Pages can read only meshes and images, only in folders that the
current descriptions name, and only if the real path, with links followed, is inside such a folder. A file generated
for a page can be fetched once, and only for a short time. Recordings of pages can be fetched as long as the program
runs.
"""

from __future__ import annotations

import hashlib
import hmac
import os
import re
import secrets
import time
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from urllib.parse import quote

from linkwright.diagnostics import LinkwrightError, Phrase, phrase
from linkwright.diagnostics.diagnostic import POINTER_HINT, POINTER_REASON, is_pointer_file
from linkwright.packages import PackageFinder, PackageNotFoundError, enclosing_package

MESH_TYPES = {
    ".stl": "model/stl",
    ".dae": "model/vnd.collada+xml",
    ".obj": "model/obj",
    ".glb": "model/gltf-binary",
    ".gltf": "model/gltf+json",
}
IMAGE_TYPES = {
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".jpeg": "image/jpeg",
    ".bmp": "image/bmp",
    ".gif": "image/gif",
    ".webp": "image/webp",
    ".tga": "image/x-tga",
    ".tif": "image/tiff",
    ".tiff": "image/tiff",
    ".dds": "image/vnd-ms.dds",
    ".ktx2": "image/ktx2",
}
CONTENT_TYPES = {**MESH_TYPES, **IMAGE_TYPES, ".mtl": "model/mtl", ".bin": "application/octet-stream"}

_SECRET = secrets.token_bytes(32)
_ADDRESS = re.compile(r"(/mesh/[A-Za-z0-9_.-]+-)([0-9a-f]{8})~[0-9a-f]{32}(/[^\"?]*)(?:\?v=[0-9a-f]+)?")

_PACKAGE_URI = re.compile(r"package://([^/%]+)/")

_MODEL_CONFIG = "model.config"
"""The file that marks the folder of a Gazebo model."""

_MAX_LOOSE_DEPTH = 2
"""The maximum number of parts of a path below the folder of a mesh outside of packages and models."""


@dataclass(frozen=True, slots=True)
class ServedFolder:
    """A folder that pages may read: a package, a Gazebo model, or the folder of another mesh.

    Attributes:
        root: the folder.
        package: the name of the package, or None if the folder is not a package.
        is_model: whether the folder is a Gazebo model, with its meshes and textures.
    """

    root: Path
    package: str | None
    is_model: bool = False

    @property
    def key(self) -> str:
        """The key of the folder in addresses: a readable name and a secret, without the path.

        The secret is needed because the image elements of textures cannot send the token. Only a page that received
        the address can fetch the file.
        """
        name = re.sub(r"[^A-Za-z0-9_.-]", "_", self.package or self.root.name)
        root = os.fsencode(self.root)
        return f"{name}-{hashlib.sha256(root).hexdigest()[:8]}~{hmac.digest(_SECRET, root, 'sha256').hex()[:32]}"


@dataclass(frozen=True, slots=True)
class FileAddress:
    """The address of a file for pages, or None and the reason why the file has no address."""

    url: str | None
    problem: Phrase | None = None


class FileRefusedError(Exception):
    """Raised when a request for a file is refused.

    Attributes:
        status: the HTTP status, 403 or 404.
    """

    def __init__(self, status: int, text: str) -> None:
        super().__init__(text)
        self.status = status


@dataclass(slots=True)
class MeshIndex:
    """A finder of the files of one description that collects their folders."""

    finder: PackageFinder
    folders: dict[str, ServedFolder] = field(default_factory=dict)
    _missing_packages: dict[str, FileAddress] = field(default_factory=dict)

    def locate(self, uri: str, base: Path | None, types: dict[str, str]) -> FileAddress:
        """Return the address of a file, and add its folder to `folders`.

        Args:
            uri: the URI in the description: ``package://``, ``file://`` or a path.
            base: the folder that relative paths refer to, which contains the file with the URI.
            types: the supported suffixes, in lower case.
        """
        package = _PACKAGE_URI.match(uri)
        if package and package[1] in self._missing_packages:
            return self._missing_packages[package[1]]  # searches are slow, and a robot names its package often
        try:
            path = Path(os.path.normpath(self.finder.resolve(uri, base)))
        except PackageNotFoundError as error:
            return self._missing_packages.setdefault(error.name, FileAddress(None, error.diagnostics[0].message))
        except LinkwrightError as error:
            return FileAddress(None, error.diagnostics[0].message)
        except ValueError:
            return FileAddress(
                None,
                phrase("the path {uri} contains a character that file names cannot have; correct it", uri=repr(uri)),
            )
        if not path.is_file():
            return FileAddress(None, phrase("there is no file '{path}'", path=path))
        if path.suffix.lower() not in types:
            supported_formats = ", ".join(sorted(suffix[1:].upper() for suffix in types))
            return FileAddress(
                None,
                phrase(
                    "the format of '{path}' is not supported; the supported formats are {known}",
                    path=path,
                    known=supported_formats,
                ),
            )
        if is_pointer_file(path):
            return FileAddress(
                None, phrase("'{path}': {problem}; {hint}", path=path, problem=POINTER_REASON, hint=POINTER_HINT)
            )
        folder = self._find_folder(uri, path)
        relative = path.relative_to(folder.root)
        try:
            resolve(folder, relative.as_posix())
        except FileRefusedError as error:
            return FileAddress(None, phrase("'{path}': {error}", path=path, error=error))
        self.folders[folder.key] = folder
        version = path.stat().st_mtime_ns
        return FileAddress(f"/mesh/{folder.key}/{quote(relative.as_posix())}?v={version:x}")

    def _find_folder(self, uri: str, path: Path) -> ServedFolder:
        package_match = _PACKAGE_URI.match(uri)
        share_folder = self.finder.find(package_match[1]) if package_match else None
        if package_match and share_folder and path.is_relative_to(share_folder):
            return ServedFolder(share_folder, package_match[1])
        package = enclosing_package(path.parent)
        if package:
            return ServedFolder(package[1], package[0])
        model = next((folder for folder in path.parents if (folder / _MODEL_CONFIG).is_file()), None)
        return ServedFolder(model, None, is_model=True) if model else ServedFolder(path.parent, None)


def without_secrets(text: str) -> str:
    """Return a text that can be shared, without the secrets in file addresses.

    Hashes of paths and times of files are also removed.

    Folders are numbered instead, in the order in which the text names them.
    """
    numbers: dict[str, int] = {}

    def remove_secrets(match: re.Match[str]) -> str:
        start, folder, path = match.groups()
        return f"{start}{numbers.setdefault(folder, len(numbers) + 1)}{path}"

    return _ADDRESS.sub(remove_secrets, text)


class MeshFolders:
    """The folders that pages may read, by key.

    Each display adds the folders of its description.
    """

    def __init__(self) -> None:
        self._folders: dict[str, dict[str, ServedFolder]] = {}

    def replace(self, owner: str, folders: dict[str, ServedFolder]) -> None:
        """Replace the folders of a display."""
        self._folders[owner] = folders

    def copy(self) -> MeshFolders:
        """Return a copy that is not affected by later changes to the displays."""
        copied = MeshFolders()
        copied._folders.update(self._folders)
        return copied

    def file(self, key: str, relative: str) -> Path:
        """Return the real path of a requested file.

        Args:
            key: the key of a folder.
            relative: the path below the folder, percent-decoded.

        Raises:
            FileRefusedError: 404 if there is no such folder or file, 403 if it may not be read.
        """
        folder = next((folders[key] for folders in self._folders.values() if key in folders), None)
        if folder is None:
            raise FileRefusedError(404, "no shown description refers to this folder")
        return resolve(folder, relative)


def resolve(folder: ServedFolder, relative: str) -> Path:
    """Return the real path of a file below a folder, with links followed and checked.

    A link may point outside the folder of a package only to a file of the same package, as in share folders that
    ``colcon build --symlink-install`` creates.

    Raises:
        FileRefusedError: 404 if there is no such file, 403 if it may not be read.
    """
    parts = relative.split("/")
    if any(part in ("", ".", "..") or "\\" in part or "\0" in part for part in parts):
        raise FileRefusedError(403, "the path points outside its folder")
    if PurePosixPath(relative).suffix.lower() not in CONTENT_TYPES:
        raise FileRefusedError(403, "only meshes and images are served")
    if folder.package is None and not folder.is_model and len(parts) > _MAX_LOOSE_DEPTH:
        raise FileRefusedError(403, "the path is too deep below the folder of a mesh outside of packages")
    try:
        real_path = _find_file_or_texture(folder.root / relative).resolve(strict=True)
        root = folder.root.resolve(strict=True)
    except (OSError, RuntimeError, ValueError):
        raise FileRefusedError(404, "no such file") from None
    if not real_path.is_file():
        raise FileRefusedError(404, "no such file")
    if real_path.suffix.lower() not in CONTENT_TYPES:
        raise FileRefusedError(403, "only meshes and images are served")
    if not real_path.is_relative_to(root) and not _is_in_package(real_path, folder.package):
        raise FileRefusedError(403, "a link points outside the package")
    return real_path


def _find_file_or_texture(path: Path) -> Path:
    """Return the path, or the path of an image of this name in a Gazebo model's texture folder.

    The texture folder is used only if there is no file at the path.
    """
    if path.suffix.lower() in IMAGE_TYPES and not path.exists():
        model = path.parent.parent
        texture = model / "materials" / "textures" / path.name
        if texture.exists() and (model / _MODEL_CONFIG).is_file():
            return texture
    return path


def _is_in_package(path: Path, name: str | None) -> bool:
    package = enclosing_package(path.parent)
    return package is not None and package[0] == name


_OFFER_LIFETIME_S = 60.0
_MAX_OFFERED = 4


@dataclass(frozen=True, slots=True)
class Download:
    """A generated file that a page can fetch once."""

    name: str
    content_type: str
    data: bytes
    created_at: float = field(default_factory=time.monotonic)


class Downloads:
    """Files that can be fetched under secret keys.

    Only the page that requested a file receives its key.
    """

    def __init__(self) -> None:
        self._files: dict[str, Download] = {}
        self._reusable_paths: dict[str, Path] = {}

    def offer_repeatedly(self, path: Path) -> str:
        """Offer a file for any number of fetches, and return its address."""
        key = secrets.token_urlsafe(16)
        self._reusable_paths[key] = path
        return f"/export/{key}/{quote(path.name)}"

    def path(self, key: str) -> Path | None:
        """Return the path of a file that `offer_repeatedly` offers under a key, or None."""
        return self._reusable_paths.get(key)

    def offer_once(self, file: Download) -> str:
        """Offer a file for one fetch, and return its address."""
        while len(self._files) >= _MAX_OFFERED:
            del self._files[next(iter(self._files))]
        key = secrets.token_urlsafe(16)
        self._files[key] = file
        return f"/export/{key}/{quote(file.name)}"

    def withdraw(self, key: str) -> Download | None:
        """Withdraw and return the file that `offer_once` offers under a key, or return None.

        Files that were offered more than a minute ago are discarded first.
        """
        now = time.monotonic()
        for old in [
            expired_key for expired_key, file in self._files.items() if now - file.created_at > _OFFER_LIFETIME_S
        ]:
            del self._files[old]
        return self._files.pop(key, None)
