"""The wheels in uv.lock: ``linkwright[all]`` can be installed without a compiler."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest
from packaging.markers import Marker
from packaging.tags import Tag, compatible_tags, cpython_tags, mac_platforms
from packaging.utils import parse_wheel_filename

from tests.places import REPOSITORY
from tests.toml_files import read_toml

PYTHONS = ("3.10", "3.11", "3.12", "3.13", "3.14", "3.15")
SYSTEMS = {
    "Linux x86_64": ("linux", "x86_64", [f"manylinux_2_{minor}_x86_64" for minor in range(28, 4, -1)]),
    "Linux aarch64": (
        "linux",
        "aarch64",
        ["manylinux2014_aarch64", *(f"manylinux_2_{minor}_aarch64" for minor in range(28, 16, -1))],
    ),
    "macOS arm64": ("darwin", "arm64", list(mac_platforms((15, 0), "arm64"))),
    "macOS x86_64": ("darwin", "x86_64", list(mac_platforms((15, 0), "x86_64"))),
    "Windows": ("win32", "AMD64", ["win_amd64"]),
}
PURE_PYTHON = {"empy", "srt"}
"""Pure Python packages without wheels: their installation needs no compiler."""
PURE_PYTHON_IF_NEEDED = {"pyyaml": "3.15"}
"""Packages that work without their compiled part, and the Python from which on they have no wheels."""


@pytest.fixture(scope="module")
def lock() -> dict[str, list[dict[str, Any]]]:
    packages: dict[str, list[dict[str, Any]]] = {}
    for package in read_toml((REPOSITORY / "uv.lock").read_text(encoding="utf-8"))["package"]:
        packages.setdefault(package["name"], []).append(package)
    return packages


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize("system", SYSTEMS)
def test_all_dependencies_install_without_compiler(
    system: str, python: str, lock: dict[str, list[dict[str, Any]]]
) -> None:
    allowed = PURE_PYTHON | {
        name for name, since in PURE_PYTHON_IF_NEEDED.items() if PYTHONS.index(python) >= PYTHONS.index(since)
    }
    required_packages = {package["name"]: package for package in _needed(lock, _environment(system, python))}
    tags = _tags(system, python)
    packages_without_wheel = {name for name, package in required_packages.items() if not _has_wheel(package, tags)}
    assert {"aiohttp", "numpy", "pillow", "vosk"} <= set(required_packages)  # packages of the base and of extras
    assert packages_without_wheel - allowed == set()
    assert packages_without_wheel >= PURE_PYTHON, "packages with wheels must be removed from the exceptions"


def test_exceptions_for_new_python_versions_are_needed(lock: dict[str, list[dict[str, Any]]]) -> None:
    for name, since in PURE_PYTHON_IF_NEEDED.items():
        assert not _has_wheel(lock[name][0], _tags("Linux x86_64", since)), name


def test_python_versions_of_workflows_are_covered() -> None:
    text = (REPOSITORY / ".github" / "workflows" / "tests.yml").read_text(encoding="utf-8")
    named = set(re.findall(r'"(3\.\d+)"', text))
    assert {"3.10", "3.14"} <= named <= set(PYTHONS)


def _environment(system: str, python: str) -> dict[str, str]:
    platform, machine, _ = SYSTEMS[system]
    return {
        "extra": "",
        "implementation_name": "cpython",
        "os_name": "nt" if platform == "win32" else "posix",
        "platform_machine": machine,
        "platform_python_implementation": "CPython",
        "platform_system": {"linux": "Linux", "darwin": "Darwin", "win32": "Windows"}[platform],
        "python_full_version": f"{python}.9",
        "python_version": python,
        "sys_platform": platform,
    }


def _tags(system: str, python: str) -> set[Tag]:
    version, platforms = [int(part) for part in python.split(".")], SYSTEMS[system][2]
    interpreter = f"cp{''.join(python.split('.'))}"
    return {*cpython_tags(version, platforms=platforms), *compatible_tags(version, interpreter, platforms)}


def _has_wheel(package: dict[str, Any], tags: set[Tag]) -> bool:
    return any(parse_wheel_filename(wheel["path"])[3] & tags for wheel in package.get("wheels", ()))


def _needed(lock: dict[str, list[dict[str, Any]]], environment: dict[str, str]) -> Iterator[dict[str, Any]]:
    """Return the packages that ``linkwright[all]`` needs in an environment."""
    (root,) = lock["linkwright"]
    pending = [*root["dependencies"], *root["optional-dependencies"]["all"]]
    visited: set[tuple[str, str, str]] = set()
    while pending:
        dependency = pending.pop()
        if "marker" in dependency and not Marker(dependency["marker"]).evaluate(environment):
            continue
        package = _chosen(lock, dependency, environment)
        for extra in ("", *dependency.get("extra", ())):
            key = (package["name"], package.get("version", ""), extra)
            if key in visited:
                continue
            visited.add(key)
            pending += (
                package.get("optional-dependencies", {}).get(extra, ()) if extra else package.get("dependencies", ())
            )
        if "registry" in package["source"]:  # the package is from an index
            yield package


def _chosen(
    lock: dict[str, list[dict[str, Any]]], dependency: dict[str, Any], environment: dict[str, str]
) -> dict[str, Any]:
    """Return the version of a package in the lock for a machine."""
    (package,) = [
        package
        for package in lock[dependency["name"]]
        if dependency.get("version", package.get("version")) == package.get("version")
        and any(
            Marker(marker).evaluate(environment)
            for marker in package.get("resolution-markers", ("python_version > '3'",))
        )
    ]
    return package
