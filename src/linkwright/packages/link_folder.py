"""Folders of links in the user's cache for `linkwright.packages.share_layout`."""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from linkwright.files.user_folders import PREFIXES_SUBFOLDER, SHARES_SUBFOLDER, cache_folder
from linkwright.packages.readers.installed import InstalledFile

_MAX_LINKS = 5000
_RETENTION_S = 7 * 24 * 3600.0
"""Seconds before an unused layout is deleted. Until then, a running program may still use it."""


def make_link_folder(name: str, folder: Path, moved: Mapping[str, InstalledFile]) -> Path:
    """Return a folder of links to a package's sources, with installed files at installed paths.

    Files that the build generates are written instead of linked. The folder is created if no process has created it for
    the same content before.

    Args:
        name: the name of the package, which is also the folder's name.
        folder: the source folder of the package.
        moved: path in the share folder -> file, for files whose installed path differs from the path in the sources.

    Raises:
        OSError: the folder cannot be created.
    """
    links: dict[str, str | Path] = {}
    top_names = {path.partition("/")[0] for path in moved}
    for entry in sorted(folder.iterdir()):
        if entry.name.startswith("."):
            continue
        if entry.name in top_names and entry.is_dir():
            links |= {path.relative_to(folder).as_posix(): path for path in entry.rglob("*") if path.is_file()}
        else:
            links[entry.name] = entry
    for path, file in moved.items():
        links[path] = file.text(folder) if file.is_generated else folder / file.source
    if len(links) > _MAX_LINKS:
        raise OSError("too many files")
    content_hash = hashlib.sha256(
        repr((str(folder), sorted((path, str(link)) for path, link in links.items()))).encode()
    )
    layouts = cache_folder() / SHARES_SUBFOLDER / hashlib.sha256(os.fsencode(folder)).hexdigest()[:12]
    share = layouts / content_hash.hexdigest()[:12] / name
    if share.is_dir():
        with suppress(OSError):
            os.utime(share.parent)
        return share
    layouts.mkdir(parents=True, exist_ok=True)
    _delete_old_layouts(layouts)
    new_folder = Path(tempfile.mkdtemp(dir=layouts, prefix="new-"))
    try:
        for path, link in links.items():
            target = new_folder / name / path
            target.parent.mkdir(parents=True, exist_ok=True)
            if isinstance(link, str):
                target.write_text(link, encoding="utf-8")
            else:
                target.symlink_to(link)
        with suppress(OSError):  # another process has created the folder
            new_folder.rename(share.parent)
    finally:
        shutil.rmtree(new_folder, ignore_errors=True)
    if not share.is_dir():
        raise OSError("the links were not made")
    return share


def make_prefix(name: str, share: Path) -> Path:
    """Return a folder in the user's cache in which ``share/NAME`` is a link to the share folder of a package.

    Raises:
        OSError: the folder or the link cannot be created.
    """
    share_hash = hashlib.sha256(os.fsencode(share)).hexdigest()[:12]
    prefix = cache_folder() / SHARES_SUBFOLDER / PREFIXES_SUBFOLDER / share_hash
    link = prefix / "share" / name
    if not (link.is_symlink() and link.exists()):
        link.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileExistsError):  # another process has created the link
            link.symlink_to(share, target_is_directory=True)
    return prefix


def _delete_old_layouts(layouts: Path) -> None:
    for layout in layouts.iterdir():
        with suppress(OSError):
            if time.time() - layout.stat().st_mtime > _RETENTION_S:
                shutil.rmtree(layout, ignore_errors=True)
