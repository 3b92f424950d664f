"""The functions of ros2cli that programs use (``ros2pkg.api``, ``ros2run.api``, ``ros2topic.api``)."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import KeysView, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from linkwright.messages import get_message
from linkwright.packages import (
    PackageNotFoundError,
    get_package_prefix,
    get_package_share_directory,
    get_packages_with_prefixes,
    is_installed,
)
from linkwright.packages.programs.source_programs import find_source_programs
from linkwright.standins.rclpy_api.naming import expand_topic_name, topic_or_service_is_hidden, validate_full_topic_name
from linkwright.standins.rclpy_api.session import ok

_POLL_INTERVAL_S = 0.1
_RUN_PREFIX = "[ros2run]:"


class PackageNotFound(Exception):
    """Raised when a package does not exist."""

    def __init__(self, package_name: str) -> None:
        super().__init__(package_name)
        self.package_name = package_name


def get_package_names() -> KeysView[str]:
    """Return the names of all installed packages."""
    return get_packages_with_prefixes().keys()


def get_prefix_path(package_name: str) -> str | None:
    """Return the install prefix of a package, or None if there is no such package."""
    try:
        return get_package_prefix(package_name)
    except PackageNotFoundError:
        return None


class MultipleExecutables(Exception):
    """Raised when a package has several executables with a name."""

    def __init__(self, paths: Sequence[str]) -> None:
        super().__init__(paths)
        self.paths = paths


def get_executable_path(*, package_name: str, executable_name: str) -> str | None:
    """Return the path of a package's executable, or None if there is none.

    Raises:
        PackageNotFound: there is no such package.
        MultipleExecutables: several executables have the name.
    """
    paths = get_executable_paths(package_name=package_name)
    matches = [path for path in paths if os.path.basename(path) == executable_name]  # noqa: PTH119 - strings
    if len(matches) > 1:
        raise MultipleExecutables(matches)
    return matches[0] if matches else None


def run_executable(*, path: str | None, argv: Sequence[str], prefix: Sequence[str] | None = None) -> int:
    """Run a program, wait until it ends, and return its exit status.

    A failure is printed. In ROS, None as the path raises a TypeError; here it is a failure that is explained.

    Args:
        path: the path of the program, or None if `get_executable_path` found none.
        argv: the arguments of the program.
        prefix: a command that runs the program, such as a debugger.
    """
    if path is None:
        print(f"{_RUN_PREFIX} the program was not found: it is not built here, or its package has no such program")
        return 1
    process = subprocess.Popen([*(prefix or ()), path, *argv])  # noqa: S603 - the caller's own program
    while process.returncode is None:
        with suppress(KeyboardInterrupt):  # the program receives the signal as well
            process.wait()
    status = process.returncode
    if status != 0:
        is_signal = os.name == "posix" and -status in signal.valid_signals()
        print(_RUN_PREFIX, signal.strsignal(-status) if is_signal else f"Process exited with failure {status}")
    return status


def get_executable_paths(*, package_name: str) -> list[str]:
    """Return the paths of a package's executables in the folder ``lib`` of its install prefix.

    For a package in sources, the paths are those of the scripts that a build would install.

    Raises:
        PackageNotFound: there is no such package.
    """
    prefix = get_prefix_path(package_name)
    if prefix is None:
        raise PackageNotFound(package_name)
    share = Path(get_package_share_directory(package_name))
    if not is_installed(share):
        return sorted(str(script) for script in find_source_programs(share).scripts.values())
    executables: list[str] = []
    for folder, subfolders, files in os.walk(os.path.join(prefix, "lib", package_name)):  # noqa: PTH118 - strings, as in ros2pkg
        subfolders[:] = sorted(subfolder for subfolder in subfolders if not subfolder.startswith("."))
        paths = (os.path.join(folder, name) for name in sorted(files))  # noqa: PTH118
        executables += [path for path in paths if os.access(path, os.X_OK)]
    return executables


def get_topic_names_and_types(*, node: Any, include_hidden_topics: bool = False) -> list[tuple[str, list[str]]]:
    """Return the topics that a node has discovered, with their types."""
    topics: list[tuple[str, list[str]]] = node.get_topic_names_and_types()
    return [topic for topic in topics if include_hidden_topics or not topic_or_service_is_hidden(topic[0])]


def get_topic_names(*, node: Any, include_hidden_topics: bool = False) -> list[str]:
    """Return the names of the topics that a node has discovered."""
    return [name for name, _ in get_topic_names_and_types(node=node, include_hidden_topics=include_hidden_topics)]


def get_msg_class(node: Any, topic: str, blocking: bool = False, include_hidden_topics: bool = False) -> Any:
    """Return the message class of a topic.

    If the topic does not have a type yet, wait for one if `blocking` is True, and otherwise return None.

    Raises:
        RuntimeError: the name is invalid, or the topic has several types.
    """
    message_class = _get_msg_class(node, topic, include_hidden_topics)
    if message_class is None:
        print(f"WARNING: topic [{topic}] does not appear to be published yet")
    while message_class is None and blocking and ok():
        time.sleep(_POLL_INTERVAL_S)
        message_class = _get_msg_class(node, topic, include_hidden_topics)
    return message_class


def _get_msg_class(node: Any, topic: str, include_hidden_topics: bool) -> Any:
    try:
        name = expand_topic_name(topic, node.get_name(), node.get_namespace())
        validate_full_topic_name(name)
    except ValueError as error:
        raise RuntimeError(error) from error
    topics = dict(get_topic_names_and_types(node=node, include_hidden_topics=include_hidden_topics))
    types = topics.get(name)
    if types is None:
        return None
    if len(types) > 1:
        type_names = ", ".join(types)
        raise RuntimeError(f"Cannot echo topic '{topic}', as it contains more than one type: [{type_names}]")
    return get_message(types[0])


def unsigned_int(string: str) -> int:
    """Parse a non-negative integer from the command line.

    Raises:
        ArgumentTypeError: the number is negative.
        ValueError: the string is not an integer.
    """
    return _parse_bounded_int(0, string, "value must be non-negative integer")


def positive_int(string: str) -> int:
    """Parse a positive integer from the command line.

    Raises:
        ArgumentTypeError: the number is not positive.
        ValueError: the string is not an integer.
    """
    return _parse_bounded_int(1, string, "value must be a positive integer")


def _parse_bounded_int(minimum: int, string: str, error_message: str) -> int:
    from argparse import ArgumentTypeError

    value = int(string)
    if value < minimum:
        raise ArgumentTypeError(error_message)
    return value
