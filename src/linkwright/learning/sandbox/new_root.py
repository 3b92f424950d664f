"""A root folder for the run that contains only its folder, programs and libraries."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

from linkwright.learning.sandbox.linux import (
    MS_BIND,
    MS_NODEV,
    MS_NOEXEC,
    MS_NOSUID,
    MS_PRIVATE,
    MS_REC,
    change_root,
    make_read_only,
    mount,
)

_BASE = "/tmp"
_DEVICES = ("null", "zero", "full", "random", "urandom")
_FILES_OF_PROC = ("cpuinfo", "meminfo", "stat", "version", "filesystems")


def enter_new_root(readable: list[str], folder: str, temporary_bytes: int, *, own_processes: bool) -> None:
    """Replace the root folder of this mount namespace.

    Args:
        readable: the files and whole folders that the run may read.
        folder: the folder in which the run may write.
        temporary_bytes: the size of /tmp and of /dev/shm in bytes; both are in memory, and are deleted with the run.
        own_processes: whether this process is in a new process namespace.

    Raises:
        OSError: The system does not allow it.
    """
    mount("none", "/", flags=MS_REC | MS_PRIVATE)
    root = _Root(readable, folder)
    root.mount_temporary_folders(temporary_bytes)
    root.mount_devices()
    root.mount_proc(own_processes=own_processes)
    root.bind_readable()
    root.bind_folder()
    make_read_only(root.base, with_mounts_below=False)
    change_root(root.base)


class _Root:
    """The new root folder, built at the path `base`.

    The sources of mounts are opened before the new root hides them.
    """

    base = _BASE

    def __init__(self, readable: list[str], folder: str) -> None:
        self._folder = folder
        self._links: dict[str, str] = {}
        self._sources: dict[str, int] = {}
        for path in readable:
            if path.startswith("/proc/"):
                continue
            real = self._follow_links(path)
            if real is not None:
                self._sources[real] = os.open(real, os.O_PATH | os.O_CLOEXEC)
        self._folder_source = os.open(folder, os.O_PATH | os.O_CLOEXEC | os.O_NOFOLLOW)
        self._devices = {
            name: os.open(f"/dev/{name}", os.O_PATH | os.O_CLOEXEC) for name in _DEVICES if Path("/dev", name).exists()
        }
        self._old_proc = os.open("/proc", os.O_PATH | os.O_CLOEXEC)
        mount("linkwright", self.base, "tmpfs", MS_NOSUID | MS_NODEV, "mode=755,size=4m")

    def _follow_links(self, path: str) -> str | None:
        """Return the real path, and record the links that lead to it."""
        for _ in range(40):
            link = next((p for p in (*reversed(Path(path).parents), Path(path)) if p.is_symlink()), None)
            if link is None:
                return path if Path(path).exists() else None
            target = os.readlink(link)
            self._links[str(link)] = target
            subpath = Path(path).relative_to(link)
            path = os.path.normpath(link.parent.resolve() / target / subpath)
        return None

    def _get_path_in_root(self, path: str) -> str:
        return self.base + path

    def _bind(self, source: int, path: str) -> str:
        """Mount an opened file or folder at its path in the new root, and return the mount point."""
        place = self._get_path_in_root(path)
        if Path(f"/proc/self/fd/{source}").is_dir():
            Path(place).mkdir(parents=True, exist_ok=True)
        else:
            Path(place).parent.mkdir(parents=True, exist_ok=True)
            Path(place).touch(exist_ok=True)
        mount(f"/proc/self/fd/{source}", place, flags=MS_BIND | MS_REC)
        return place

    def mount_temporary_folders(self, size: int) -> None:
        """Mount the in-memory folders of the run, before the mounts inside them."""
        for path in ("/dev/shm", "/tmp"):
            Path(self._get_path_in_root(path)).mkdir(parents=True)
            mount("linkwright", self._get_path_in_root(path), "tmpfs", MS_NOSUID | MS_NODEV, f"mode=1777,size={size}")

    def mount_devices(self) -> None:
        for name, source in self._devices.items():
            self._bind(source, f"/dev/{name}")
        for name, target in (("fd", "fd"), ("stdin", "fd/0"), ("stdout", "fd/1"), ("stderr", "fd/2")):
            Path(self._get_path_in_root(f"/dev/{name}")).symlink_to(f"/proc/self/{target}")
        Path(self._get_path_in_root("/dev/pts")).mkdir()
        Path(self._get_path_in_root("/dev/ptmx")).symlink_to("pts/ptmx")
        with contextlib.suppress(OSError):  # terminals are missing then
            options = "newinstance,ptmxmode=0666,mode=620"
            mount("devpts", self._get_path_in_root("/dev/pts"), "devpts", MS_NOSUID | MS_NOEXEC, options)

    def mount_proc(self, *, own_processes: bool) -> None:
        """Mount /proc of the new process namespace.

        If that is not allowed, /proc has only files about the machine.
        """
        proc = Path(self._get_path_in_root("/proc"))
        proc.mkdir()
        if own_processes:
            with contextlib.suppress(OSError):
                mount("proc", str(proc), "proc", MS_NOSUID | MS_NODEV | MS_NOEXEC)
                return
        for name in _FILES_OF_PROC:
            with contextlib.suppress(OSError):
                source = os.open(name, os.O_PATH | os.O_CLOEXEC, dir_fd=self._old_proc)
                make_read_only(self._bind(source, f"/proc/{name}"))

    def bind_readable(self) -> None:
        """Mount the files and folders that the run may read."""
        done: list[str] = []
        for real in sorted(self._sources, key=lambda path: path.count("/")):
            if not any(real == ancestor or real.startswith(ancestor.rstrip("/") + "/") for ancestor in done):
                make_read_only(self._bind(self._sources[real], real))
                done.append(real)
        for link, target in self._links.items():
            with contextlib.suppress(OSError):  # the link exists in a mounted folder
                Path(self._get_path_in_root(link)).parent.mkdir(parents=True, exist_ok=True)
                Path(self._get_path_in_root(link)).symlink_to(target)

    def bind_folder(self) -> None:
        """Mount the folder of the run, which may be inside a readable folder."""
        self._bind(self._folder_source, self._folder)
