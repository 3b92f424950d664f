"""The modules that use features of some systems.

Each is listed here, and runs without them in `test_other_systems`.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import linkwright
from tests.systems.sitecustomize import FUNCTIONS, MODULES, SIGNAL_FUNCTIONS, SOCKETS, WATCHING

ROOT = Path(linkwright.__file__).parent
OF_ONE_SYSTEM = {
    "os": {*FUNCTIONS.split(), "kill", "set_blocking", "startfile"},
    "select": {"epoll", "kqueue", "poll"},
    "signal": {*SIGNAL_FUNCTIONS, "SIGHUP", "SIGKILL", "SIGQUIT", "SIGUSR1", "SIGUSR2"},
    "socket": {*SOCKETS, "if_nameindex"},
    "sys": {"platform", "getwindowsversion"},
    "multiprocessing": {"get_context", "set_start_method", "Process", "Pool"},
    "ctypes": {"windll", "WinDLL", "PyDLL", "CDLL"},
}
"""The names, by module, that are missing or behave differently on some systems."""
FOLDERS = ("/proc", "/dev/", "/sys/", "/tmp", "/bin/", "/usr/")
KNOWN: dict[str, str] = {
    "cli/bag/keys.py": "add_reader getpgrp platform remove_reader tcgetpgrp termios tty",
    "cli/completion/graph_names.py": "start_new_session",
    "control/nodes/teleop/joy.py": "/dev/input/event0 /dev/input/js /dev/input/js0",
    "control/nodes/teleop/joystick_device.py": "/dev/input O_NONBLOCK add_reader fcntl platform remove_reader",
    "control/nodes/teleop/terminal.py": "add_reader msvcrt platform remove_reader termios",
    "diagnostics/installation.py": "platform",
    "doctor/report.py": "fcntl if_nameindex platform",
    "files/input_files.py": "O_NONBLOCK set_blocking",
    "files/scratch_folders.py": "O_DIRECTORY O_NOFOLLOW fcntl getuid platform",
    "graph/time/fine_alarms.py": "O_CLOEXEC O_NONBLOCK PyDLL add_reader platform",
    "hosting/viewer_host.py": "platform",
    "launch/engine/guardian.py": "killpg start_new_session",
    "launch/engine/guardian_program.py": "/proc /proc/ SIGHUP SIGKILL getpgid killpg",
    "launch/engine/process_table.py": "SIGKILL",
    "launch/engine/processes.py": "SIGKILL killpg openpty",
    "learning/checks/check_process.py": "SIGKILL killpg nice platform",
    "learning/grading/jobs.py": "O_NOFOLLOW O_NONBLOCK",
    "learning/grading/workers.py": "get_context platform",
    "learning/packing/installer/install.py": "/bin/activate'",
    "learning/sandbox/contents.py": "/dev/mqueue /dev/shm /tmp chown geteuid",
    "learning/sandbox/identity.py": "/proc /proc/self/gid_map /proc/self/uid_map geteuid platform pwd",
    "learning/sandbox/landlock.py": "O_CLOEXEC",
    "learning/sandbox/process_limits.py": "/proc /proc/self/oom_score_adj getuid nice platform resource sched_setaffinity",  # noqa: E501
    "learning/sandbox/linux.py": "/proc/self/status CDLL kill",
    "learning/sandbox/namespaces.py": "/proc /proc/self/uid_map fcntl getegid geteuid platform",
    "learning/sandbox/new_root.py": "/dev/ /dev/ptmx /dev/pts /dev/shm /proc /proc/ /proc/self/ /proc/self/fd/ /tmp O_CLOEXEC O_NOFOLLOW",  # noqa: E501
    "learning/sandbox/processes.py": "/proc /proc/ SIGKILL fork kill platform sysconf",
    "learning/sandbox/readable.py": "/proc/cpuinfo /proc/filesystems /proc/meminfo /proc/stat /proc/version /sys/devices/system",  # noqa: E501
    "learning/sandbox/run.py": "platform start_new_session",
    "learning/sandbox/seccomp.py": "AF_UNIX uname",
    "learning/sandbox/run_start.py": "/dev/ /dev/pts /dev/shm /proc /tmp SIGKILL fork geteuid platform pthread_sigmask setsid uname",  # noqa: E501
    "learning/sandbox/supervisor.py": "/proc/ /sys/ SIGKILL fork platform poll set_blocking",
    "learning/sandbox/usage.py": "getegid geteuid platform",
    "lsp/large_files.py": "get_context",
    "nodes/process.py": "SIGHUP add_signal_handler",
    "packages/readers/cmake_language.py": "platform",
    "page/access.py": "O_NOFOLLOW O_NONBLOCK getuid",
    "page/peers.py": "/proc/net/tcp /proc/net/tcp6 geteuid platform",
    "page/server.py": "O_NONBLOCK",
    "panels/terminal/environment.py": "platform",
    "panels/terminal/opening.py": "platform",
    "panels/terminal/posix_pty.py": "add_reader add_writer fcntl openpty platform remove_reader remove_writer set_blocking start_new_session termios",  # noqa: E501
    "panels/terminal/process_session.py": "/proc /proc/ /proc/self/stat SIGHUP SIGKILL kill",
    "panels/terminal/take_terminal.py": "fcntl pthread_sigmask termios",
    "process/fork_server.py": "fork setsid",
    "process/forked.py": "AF_UNIX SIGKILL kill platform start_new_session",
    "process/interruption.py": "kill platform",
    "process/patience.py": "/proc/",
    "process/processors.py": "sched_getaffinity",
    "review/reviewing.py": "get_context",
    "shell/programs.py": "platform",
    "shell/session.py": "/bin/sh /dev/tty CDLL platform preexec_fn setpgid",
    "simulation/nodes/process_list.py": "platform start_new_session",
    "simulation/rendering/opengl.py": "platform",
    "sweep/workers.py": "get_context platform pthread_sigmask",
    "vision/cameras/video.py": "/dev/",
    "vision/datasets/workers.py": "get_context",
    "vision/nodes/video_cameras.py": "/dev/video0",
    "wire/background.py": "register_at_fork",
    "wire/dds/confinement.py": "platform",
    "wire/dds/local_sockets.py": "/proc/self/fd /proc/self/net",
    "wire/dds/participant.py": "/proc/self/ns/pid",
    "wire/dds/remote.py": "/proc/ kill",
    "wire/dds/settings.py": "fcntl if_nameindex platform",
    "wire/multicast.py": "SO_REUSEPORT",
    "wire/zenoh/settings.py": "platform",
}
"""The platform-specific names that each module uses. A listed module must work without them, or not be used there."""


@pytest.mark.slow  # reads all of the source, which is the same with each Python
def test_modules_with_platform_specific_code_are_listed() -> None:
    modules_of_file = {
        path.relative_to(ROOT).as_posix(): " ".join(sorted(set(used(path)))) for path in sorted(ROOT.rglob("*.py"))
    }
    assert {path: names for path, names in modules_of_file.items() if names} == KNOWN


@pytest.mark.parametrize("path", sorted(path for path, names in KNOWN.items() if set(names.split()) & set(MODULES)))
def test_platform_specific_modules_are_imported_only_in_functions(path: str) -> None:
    """A module that imports one of them at its top cannot be imported on other systems."""
    head = ast.parse((ROOT / path).read_text(encoding="utf-8")).body
    assert not {name for node in head for name in imported(node)} & set(MODULES)


def used(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        yield from (name for name in imported(node) if name.partition(".")[0] in {*MODULES, "msvcrt", "winreg"})
        if isinstance(node, ast.ImportFrom) and node.module in OF_ONE_SYSTEM and not node.level:
            yield from (name.name for name in node.names if name.name in OF_ONE_SYSTEM[node.module])
        elif isinstance(node, ast.Attribute):
            owner = ast.unparse(node.value)
            if node.attr in OF_ONE_SYSTEM.get(owner, ()) or (node.attr in WATCHING and "loop" in owner):
                yield node.attr
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("getattr", "hasattr"):
            owner, name = ast.unparse(node.args[0]), node.args[1]
            if isinstance(name, ast.Constant) and name.value in OF_ONE_SYSTEM.get(owner, ()):
                yield str(name.value)
        elif isinstance(node, ast.keyword) and node.arg in ("start_new_session", "preexec_fn", "creationflags"):
            yield str(node.arg)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.startswith(FOLDERS):
            yield node.value.split()[0]


def imported(node: ast.AST) -> set[str]:
    if isinstance(node, ast.Import):
        return {name.name for name in node.names}
    return {node.module} if isinstance(node, ast.ImportFrom) and node.module and not node.level else set()
