"""A Python without the features that another system lacks.

It is for processes with this folder on ``PYTHONPATH``.

With ``LINKWRIGHT_TESTS_SYSTEM=windows``, the modules, functions, signals and sockets of POSIX are missing, event loops
watch neither files nor signals, and ``sys.platform`` is ``win32``. With ``macos``, the features of Linux are missing:
``/proc``, epoll and affinities. Not simulated: paths with drives, which `pathlib` lacks here, and the end of processes.
"""

from __future__ import annotations

import os
import sys

MODULES = ("curses", "fcntl", "grp", "posix", "pty", "pwd", "readline", "resource", "syslog", "termios", "tty")
FUNCTIONS = """
    O_CLOEXEC O_DIRECTORY O_NOFOLLOW O_NONBLOCK chown ctermid eventfd fchmod fchown fork forkpty getegid geteuid getgid
    getgroups getloadavg getpgid getpgrp getuid getxattr killpg lchown memfd_create mkfifo nice openpty pidfd_open
    posix_spawn pread preadv register_at_fork sched_getaffinity sched_setaffinity setgid setpgid setsid setuid statvfs
    sync sysconf tcgetpgrp tcsetpgrp ttyname uname wait wait3 wait4
"""
SIGNALS = ("SIGABRT", "SIGFPE", "SIGILL", "SIGINT", "SIGSEGV", "SIGTERM")
"""The signals that Windows can send and handle."""
SIGNAL_FUNCTIONS = (
    "alarm",
    "pause",
    "pthread_kill",
    "pthread_sigmask",
    "setitimer",
    "siginterrupt",
    "sigpending",
    "sigwait",
)
SOCKETS = ("AF_NETLINK", "AF_PACKET", "AF_UNIX", "MSG_DONTWAIT", "SCM_RIGHTS", "SO_PEERCRED", "SO_REUSEPORT")
WATCHING = ("add_reader", "add_signal_handler", "add_writer", "create_unix_connection", "create_unix_server",
            "remove_reader", "remove_signal_handler", "remove_writer")  # fmt: skip


def windows() -> None:
    """Remove the features that Windows lacks.

    The standard library has already imported modules that need them here.
    """
    import asyncio
    import ctypes.util  # noqa: F401 - looks at the system when it is imported
    import importlib.abc
    import multiprocessing.connection
    import multiprocessing.popen_fork
    import multiprocessing.popen_spawn_posix
    import multiprocessing.resource_tracker
    import pathlib  # noqa: F401 - the same
    import platform
    import select
    import selectors
    import shutil  # noqa: F401 - the same
    import signal
    import socket
    import ssl
    import subprocess
    import sysconfig
    import tempfile  # noqa: F401 - the same
    import urllib.request  # noqa: F401 - the same

    asyncio.new_event_loop().close()  # the event loops of Windows cannot be imported here
    sysconfig.get_config_vars()
    platform.uname()
    kill, pair = signal.SIGKILL, socket.socketpair
    subprocess.Popen.kill = lambda self: self.send_signal(kill)
    multiprocessing.popen_fork.Popen.kill = lambda self: self._send_signal(kill)
    socket.socketpair = lambda family=1, kind=socket.SOCK_STREAM, protocol=0: pair(family, kind, protocol)
    ssl.enum_certificates = ssl.enum_crls = lambda store: []

    class NotThere(importlib.abc.MetaPathFinder):
        def find_spec(self, name, path=None, target=None):
            if name in MODULES:
                raise ModuleNotFoundError(f"No module named '{name}'", name=name)

    sys.meta_path.insert(0, NotThere())
    for name in MODULES:
        sys.modules.pop(name, None)
    remove(os, FUNCTIONS.split())
    subprocess._CAN_USE_PIDFD_OPEN = False  # Python 3.15 has set it by asking the system
    posix_signals = [name for name in dir(signal) if name.startswith("SIG") and name[3] != "_" and name not in SIGNALS]
    remove(signal, [*posix_signals, *SIGNAL_FUNCTIONS, "SIG_BLOCK", "SIG_SETMASK", "SIG_UNBLOCK"])
    remove(socket, SOCKETS)
    remove(select, ["epoll", "poll"])
    selectors.DefaultSelector = selectors.SelectSelector

    def refuse(*_words, **_named):
        raise NotImplementedError

    for name in WATCHING:  # the default loop of Windows cannot watch files
        setattr(asyncio.SelectorEventLoop, name, refuse)
    sys.platform = "win32"


def macos() -> None:
    """Remove the features that only Linux has."""
    import asyncio  # noqa: F401 - looks at the system when it is imported
    import ctypes.util  # noqa: F401 - the same
    import platform
    import select
    import selectors
    import socket
    import subprocess
    import sysconfig
    import urllib.request  # noqa: F401 - the same

    sysconfig.get_config_vars()
    platform.uname()
    subprocess._CAN_USE_PIDFD_OPEN = False  # Python 3.15 has set it by asking the system
    remove(os, ["eventfd", "memfd_create", "pidfd_open", "sched_getaffinity", "sched_setaffinity", "timerfd_create"])
    remove(socket, ["AF_NETLINK", "AF_PACKET", "SO_PEERCRED", "SO_BINDTODEVICE"])
    remove(select, ["epoll"])
    selectors.DefaultSelector = selectors.PollSelector

    def hide(event, arguments):
        if event in ("open", "os.listdir", "os.scandir") and str(arguments[0]).startswith(("/proc/", "/sys/")):
            raise FileNotFoundError(2, "No such file or directory", arguments[0])

    sys.addaudithook(hide)
    sys.platform = "darwin"


def remove(module, names) -> None:
    """Remove names from a module if it has them."""
    if module is os and hasattr(os, "process_cpu_count"):  # `process_cpu_count` uses a removed function
        os.process_cpu_count = os.cpu_count
    for name in names:
        if hasattr(module, name):
            delattr(module, name)


if os.environ.get("LINKWRIGHT_TESTS_SYSTEM"):
    {"windows": windows, "macos": macos}[os.environ["LINKWRIGHT_TESTS_SYSTEM"]]()
