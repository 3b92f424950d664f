"""Runs of the sandbox as on other systems.

These are a container, an ordinary user, and a kernel without some features.

``python situations.py NAME`` reads a request from standard input, disables the features that the named system lacks,
and prints the outcome. It uses only the standard library, because an ordinary user may have no access to this Python.
"""

from __future__ import annotations

import ctypes
import errno
import json
import os
import resource
import shutil
import struct
import subprocess
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

from linkwright.learning.sandbox.identity import can_be_reached
from linkwright.learning.sandbox.landlock import landlock_version
from linkwright.learning.sandbox.linux import load_libc
from linkwright.learning.sandbox.outcome import Limits, Outcome, Protection
from linkwright.learning.sandbox.plan import outcome_from_json, outcome_to_json

ROOT = Path(__file__).resolve().parents[3]

_DOCKER_CAPABILITIES = 0xA80425FB
"""The capabilities of a default container: CHOWN, DAC_OVERRIDE, SETUID, SETGID, KILL and others, not SYS_ADMIN."""
_NUMBERS = {
    "x86_64": {"audit": 0xC000003E, "unshare": 272, "mount": 165},
    "aarch64": {"audit": 0xC00000B7, "unshare": 97, "mount": 40},
}
_LANDLOCK_SYSCALL = 444
_CLONE_NEWUSER = 0x10000000

# name of the system: whether the grader is root, the allowed namespaces, whether there is Landlock
SITUATIONS = {
    "root": (True, "all", True),
    "container": (True, "none", True),
    "container with namespaces": (True, "all", True),  # user namespaces; root of a container may not enter others
    "container without Landlock": (True, "none", False),
    "user": (False, "all", True),
    "user without Landlock": (False, "all", False),
    "user in Ubuntu": (False, "user", True),  # AppArmor allows a user namespace, but no other namespaces in it
    "user without namespaces": (False, "none", True),
    "user without anything": (False, "none", False),
}


def expected_protections(name: str) -> set[Protection]:
    """Return the protections that the sandbox must have in a situation."""
    is_root, namespaces, has_landlock = SITUATIONS[name]
    version = landlock_version() if has_landlock else 0
    protections = {Protection.LIMITS}
    if namespaces == "all":
        return set(Protection)
    if is_root or version >= 6:
        protections |= {Protection.ENDED, Protection.PROCESSES}
    if version >= 1:
        protections.add(Protection.READ)
    if version >= 3:
        protections.add(Protection.WRITE)
    return protections


def is_possible(name: str) -> bool:
    if os.geteuid() == 0:
        return interpreter(name) is not None
    return not SITUATIONS[name][0]


def interpreter(name: str) -> str | None:
    """Return a Python that the grader and the program of a situation can execute."""
    if name == "root" or os.geteuid() != 0:
        return sys.executable
    candidates = [sys.executable, shutil.which("python3", path="/usr/bin:/usr/local/bin")]
    for candidate in filter(None, candidates):
        if can_be_reached([candidate, os.path.realpath(candidate), str(ROOT / "src")]):
            version = subprocess.check_output([candidate, "-c", "import sys; print(sys.version_info >= (3, 10))"])
            if version.strip() == b"True":
                return candidate
    return None


def run_in_situation(name: str, arguments: list[str], folder: Path, limits: Limits, **options: Any) -> Outcome:
    """Run a program in the sandbox of a situation.

    The word PYTHON among the arguments becomes its Python.
    """
    request = {"arguments": arguments, "folder": str(folder), "limits": asdict(limits), **options}
    if os.geteuid() == 0 and not SITUATIONS[name][0]:
        for path in (folder, *folder.rglob("*")):
            os.chown(path, _user(), _user(), follow_symlinks=False)
    python = interpreter(name)
    assert python is not None
    process = subprocess.run(
        [python, str(Path(__file__)), name],
        input=json.dumps(request),
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
        env={"PATH": os.environ["PATH"], "PYTHONPATH": f"{ROOT / 'src'}:{ROOT}"},
    )
    assert process.returncode == 0, process.stderr
    return outcome_from_json(process.stdout)


def _user() -> int:
    return 20_000 + os.getpid() % 10_000


def _restrict(name: str) -> None:
    """Restrict this process as the named system does."""
    is_root, namespaces, has_landlock = SITUATIONS[name]
    if not is_root and os.geteuid() == 0:
        user = 20_000 + os.getppid() % 10_000
        os.setgroups([])
        os.setresgid(user, user, user)
        os.setresuid(user, user, user)
    if not is_root:
        resource.setrlimit(resource.RLIMIT_NPROC, (300, 300))  # protects the test machine
    elif name != "root":
        _keep_capabilities(_DOCKER_CAPABILITIES)
    denied = {}
    if namespaces != "all":
        denied = {"unshare": errno.EPERM, "mount": errno.EPERM}
    _deny(denied, allow_user_namespace=namespaces == "user", deny_landlock=not has_landlock)


def _keep_capabilities(mask: int) -> None:
    for number in range(41):
        if not mask >> number & 1:
            load_libc().prctl(24, ctypes.c_ulong(number), 0, 0, 0)
    header = (ctypes.c_uint32 * 2)(0x20080522, 0)
    low, high = mask & 0xFFFFFFFF, mask >> 32
    data = (ctypes.c_uint32 * 6)(low, low, 0, high, high, 0)
    assert load_libc().capset(ctypes.byref(header), ctypes.byref(data)) == 0


def _deny(denied: dict[str, int], *, allow_user_namespace: bool, deny_landlock: bool) -> None:
    """Let system calls fail by a seccomp filter, as in containers."""
    numbers = _NUMBERS[os.uname().machine]
    rules = [(numbers[name], error) for name, error in denied.items()]
    if deny_landlock:
        rules.append((_LANDLOCK_SYSCALL, errno.ENOSYS))
    program: list[tuple[int, int, int, int]] = [(0x20, 0, 0, 0)]
    for number, error in rules:
        if number == numbers["unshare"] and allow_user_namespace:
            program += [
                (0x15, 0, 4, number),
                (0x20, 0, 0, 16),
                (0x15, 0, 1, _CLONE_NEWUSER),
                (0x06, 0, 0, 0x7FFF0000),
                (0x06, 0, 0, 0x00050000 | error),
            ]
        else:
            program += [(0x15, 0, 1, number), (0x06, 0, 0, 0x00050000 | error)]
    program.append((0x06, 0, 0, 0x7FFF0000))
    code = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *line) for line in program))
    filter_program = struct.pack("HxxxxxxQ", len(program), ctypes.addressof(code))
    load_libc().prctl(38, 1, 0, 0, 0)  # without this, only root may add a filter
    assert load_libc().prctl(22, 2, ctypes.create_string_buffer(filter_program), 0, 0) == 0 or not rules


def _main() -> None:
    from linkwright.learning.sandbox import run_in_sandbox

    request = json.load(sys.stdin)
    _restrict(sys.argv[1])
    outcome = run_in_sandbox(
        [sys.executable if word == "PYTHON" else word for word in request["arguments"]],
        folder=Path(request["folder"]),
        limits=Limits(**request["limits"]),
        environment=request.get("environment"),
    )
    time.sleep(request.get("wait", 0))
    print(outcome_to_json(outcome))


if __name__ == "__main__":
    _main()
