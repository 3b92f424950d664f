"""A root folder for the run that contains its folder, programs and libraries, and nothing else."""

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
        readable: Files and whole folders that the run may read.
        folder: The folder in which the run may write.
        temporary_bytes: The size of /tmp and of /dev/shm, which are in memory and end with the run.
        own_processes: Whether this process is in a new namespace of processes.

    Raises:
        OSError: The system does not allow it.
    """
    mount("none", "/", flags=MS_REC | MS_PRIVATE)
    root = _Root(readable, folder)
    root.bind_readable()
    root.prepare_special_folders()
    make_read_only(root.base)
    root.mount_special_folders(temporary_bytes, own_processes=own_processes)
    root.bind_folder()
    change_root(root.base)


class _Root:
    """The new root while it is built, at `base`.

    The sources of mounts are opened before the base covers them.
    """

    base = _BASE

    def __init__(self, readable: list[str], folder: str) -> None:
        self._folder = folder
        self._links: dict[str, str] = {}
        self._sources: dict[str, int] = {}
        for path in readable:
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
        """Return the real path, and note the links on the way to it."""
        for _ in range(40):
            link = next((p for p in (*reversed(Path(path).parents), Path(path)) if p.is_symlink()), None)
            if link is None:
                return path if Path(path).exists() else None
            target = os.readlink(link)
            self._links[str(link)] = target
            rest = Path(path).relative_to(link)
            path = os.path.normpath(link.parent.resolve() / target / rest)
        return None

    def _at(self, path: str) -> str:
        return self.base + path

    def bind_readable(self) -> None:
        done: list[str] = []
        for real in sorted(self._sources, key=lambda path: path.count("/")):
            if not any(real == above or real.startswith(above.rstrip("/") + "/") for above in done):
                self._bind(self._sources[real], real)
                done.append(real)
        for link, target in self._links.items():
            with contextlib.suppress(FileExistsError, OSError):
                Path(self._at(link)).parent.mkdir(parents=True, exist_ok=True)
                Path(self._at(link)).symlink_to(target)

    def _bind(self, source: int, path: str, flags: int = MS_REC) -> None:
        place = self._at(path)
        if Path(f"/proc/self/fd/{source}").is_dir():
            Path(place).mkdir(parents=True, exist_ok=True)
        else:
            Path(place).parent.mkdir(parents=True, exist_ok=True)
            Path(place).touch(exist_ok=True)
        mount(f"/proc/self/fd/{source}", place, flags=MS_BIND | flags)

    def prepare_special_folders(self) -> None:
        """Create the later mount points, while the root can be written."""
        for path in ("/dev/shm", "/dev/pts", "/proc", "/tmp", "/sys"):
            Path(self._at(path)).mkdir(parents=True, exist_ok=True)
        for name in _DEVICES:
            Path(self._at(f"/dev/{name}")).touch()
        for name, target in (("fd", "fd"), ("stdin", "fd/0"), ("stdout", "fd/1"), ("stderr", "fd/2")):
            Path(self._at(f"/dev/{name}")).symlink_to(f"/proc/self/{target}")
        Path(self._at("/dev/ptmx")).symlink_to("pts/ptmx")
        if not self._folder.startswith("/tmp/"):
            with contextlib.suppress(OSError):  # it exists already, below a folder that may be read
                Path(self._at(self._folder)).mkdir(parents=True, exist_ok=True)

    def mount_special_folders(self, temporary_bytes: int, *, own_processes: bool) -> None:
        for name, source in self._devices.items():
            mount(f"/proc/self/fd/{source}", self._at(f"/dev/{name}"), flags=MS_BIND)
        options = f"mode=1777,size={temporary_bytes}"
        for path in ("/dev/shm", "/tmp"):
            mount("linkwright", self._at(path), "tmpfs", MS_NOSUID | MS_NODEV, options)
        with contextlib.suppress(OSError):  # terminals are missing then
            mount("devpts", self._at("/dev/pts"), "devpts", MS_NOSUID | MS_NOEXEC, "newinstance,ptmxmode=0666,mode=620")
        self._mount_proc(own_processes=own_processes)

    def _mount_proc(self, *, own_processes: bool) -> None:
        """Mount /proc of the new processes. Where that is not allowed, it contains only files about the machine."""
        proc = self._at("/proc")
        if own_processes:
            with contextlib.suppress(OSError):
                mount("proc", proc, "proc", MS_NOSUID | MS_NODEV | MS_NOEXEC)
                return
        mount("linkwright", proc, "tmpfs", MS_NOSUID | MS_NODEV | MS_NOEXEC, "mode=755,size=1m")
        for name in _FILES_OF_PROC:
            place = Path(proc, name)
            place.touch()
            with contextlib.suppress(OSError):
                mount(f"/proc/self/fd/{self._old_proc}/{name}", str(place), flags=MS_BIND)
                make_read_only(str(place))

    def bind_folder(self) -> None:
        Path(self._at(self._folder)).mkdir(parents=True, exist_ok=True)
        mount(f"/proc/self/fd/{self._folder_source}", self._at(self._folder), flags=MS_BIND)
