"""Commits that are written without git, which takes two processes for each.

Whatever is not plain, such as ignored files, attributes, submodules and a merge, is left to git.
"""

from __future__ import annotations

import hashlib
import os
import stat
import struct
import sys
import time
import zlib
from collections.abc import Mapping
from pathlib import Path

_GIT_FILES = frozenset({b".git", b".gitignore", b".gitattributes", b".gitmodules"})
"""The names by which git decides what it adds, and how."""
_PLAIN_ENTRIES = frozenset({"HEAD", "config", "index", "objects", "refs"})
"""The entries of git's folder in a repository that no command of git has changed."""


class DirectCommits:
    """Writes commits of all files into a repository.

    Args:
        root: the root of the working tree.
        configuration: the text of git's configuration of the repository.
        author: the name and email of the author.
    """

    def __init__(self, root: Path, configuration: str, author: str) -> None:
        self._root = os.fsencode(root)
        self._folder = root / ".git"
        self._configuration = configuration
        self._author = author
        self._index = b""

    def commit(self, message: str) -> str | None:
        """Commit the working tree, and return the hash of the commit; None if this is left to git."""
        branch = self._find_branch()
        if branch is None or sys.platform != "linux" or not message.strip():
            return None
        files: dict[bytes, os.stat_result] = {}
        if not self._list_files(b"", files):
            return None
        hashes = {path: self._write_blob(path, status) for path, status in files.items()}
        tree = self._write_tree(_nest({path: (_mode(status), hashes[path]) for path, status in files.items()}))
        parent = f"parent {branch.read_text().strip()}\n" if branch.is_file() else ""
        person = f"{self._author} {int(time.time())} +0000"
        text = f"tree {tree.hex()}\n{parent}author {person}\ncommitter {person}\n\n{message.rstrip()}\n"
        commit = self._write_object(b"commit", text.encode()).hex()
        self._index = _make_index(files, hashes)
        (self._folder / "index").write_bytes(self._index)
        branch.write_text(f"{commit}\n")
        return commit

    def _find_branch(self) -> Path | None:
        """Return the file of the current branch, or None if git has changed the repository."""
        if any(path.name not in _PLAIN_ENTRIES for path in self._folder.iterdir()):
            return None
        index = self._folder / "index"
        if (index.read_bytes() if index.is_file() else b"") != self._index:
            return None
        if (self._folder / "config").read_text(encoding="utf-8") != self._configuration:
            return None
        kind, _, name = (self._folder / "HEAD").read_text().strip().rpartition(" ")
        return self._folder / name if kind else None

    def _list_files(self, folder: bytes, files: dict[bytes, os.stat_result]) -> bool:
        """Add the files in a folder by their path, and return whether they are plain."""
        with os.scandir(self._root + b"/" + folder) as entries:
            found = list(entries)
        for entry in found:
            path, status = folder + entry.name, entry.stat(follow_symlinks=False)
            if entry.name in _GIT_FILES:
                if path != b".git":
                    return False
            elif stat.S_ISDIR(status.st_mode):
                if not self._list_files(path + b"/", files):
                    return False
            elif stat.S_ISREG(status.st_mode) or stat.S_ISLNK(status.st_mode):
                files[path] = status
            else:
                return False
        return True

    def _write_blob(self, path: bytes, status: os.stat_result) -> bytes:
        file = Path(os.fsdecode(self._root + b"/" + path))
        is_link = stat.S_ISLNK(status.st_mode)
        return self._write_object(b"blob", os.fsencode(file.readlink()) if is_link else file.read_bytes())

    def _write_tree(self, folder: Mapping[bytes, object]) -> bytes:
        entries = []
        for name, item in folder.items():
            if isinstance(item, dict):
                entries.append((name + b"/", b"40000 " + name + b"\0" + self._write_tree(item)))
            else:
                mode, digest = item
                entries.append((name, b"%o %s\0" % (mode, name) + digest))
        return self._write_object(b"tree", b"".join(entry for _, entry in sorted(entries)))

    def _write_object(self, kind: bytes, content: bytes) -> bytes:
        data = b"%s %d\0" % (kind, len(content)) + content
        digest = hashlib.sha1(data)
        name = digest.hexdigest()
        file = self._folder / "objects" / name[:2] / name[2:]
        if not file.exists():
            file.parent.mkdir(exist_ok=True)
            file.write_bytes(zlib.compress(data, 1))
        return digest.digest()


def _mode(status: os.stat_result) -> int:
    """Return the mode of a file as git stores it."""
    if stat.S_ISLNK(status.st_mode):
        return 0o120000
    return 0o100755 if status.st_mode & stat.S_IXUSR else 0o100644


def _nest(files: Mapping[bytes, tuple[int, bytes]]) -> dict[bytes, object]:
    """Return the modes and hashes of files as a tree of folders."""
    root: dict[bytes, object] = {}
    for path, item in files.items():
        *parents, name = path.split(b"/")
        folder = root
        for parent in parents:
            folder = folder.setdefault(parent, {})  # type: ignore[assignment]
        folder[name] = item
    return root


def _make_index(files: Mapping[bytes, os.stat_result], hashes: Mapping[bytes, bytes]) -> bytes:
    """Return the index of files.

    Source: Documentation/gitformat-index.txt of git, version 2.
    """
    content = struct.pack(">4sLL", b"DIRC", 2, len(files))
    for path in sorted(files):
        status = files[path]
        times = (part for time_ns in (status.st_ctime_ns, status.st_mtime_ns) for part in divmod(time_ns, 10**9))
        numbers = (*times, status.st_dev, status.st_ino, _mode(status), status.st_uid, status.st_gid, status.st_size)
        entry = struct.pack(">10L", *(number & 0xFFFFFFFF for number in numbers))
        entry += hashes[path] + struct.pack(">H", min(len(path), 0xFFF)) + path
        content += entry.ljust(len(entry) // 8 * 8 + 8, b"\0")
    return content + hashlib.sha1(content).digest()
