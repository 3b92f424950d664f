"""The interface files of a package: ``.msg``, ``.srv``, ``.action`` and ``.idl`` files."""

from __future__ import annotations

from pathlib import Path

_EXTENSIONS = {"msg": (".msg", ".idl"), "srv": (".srv", ".idl"), "action": (".action", ".idl")}


def find_interface_files(share: Path, kind: str) -> dict[str, Path]:
    """Return the files of the interfaces of one kind that a package defines.

    An IDL file that a build generated from another interface file with the same name is left out.

    Args:
        share: the package's share folder, or its source folder.
        kind: ``msg``, ``srv`` or ``action``.

    Returns:
        Name of the interface -> file.
    """
    files: dict[str, Path] = {}
    for extension in _EXTENSIONS[kind]:
        for path in sorted(share.glob(f"{kind}/*{extension}")):
            files.setdefault(path.stem, path)
    return files


def find_interface_file(share: Path, kind: str, name: str) -> Path | None:
    """Return the file that defines an interface of a package, or None if there is no such file."""
    for extension in _EXTENSIONS[kind]:
        path = share / kind / (name + extension)
        if path.is_file():
            return path
    return None
