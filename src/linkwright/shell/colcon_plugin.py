"""A colcon plugin that installs ``ament_cmake`` packages without ament, by copying files.

colcon finds the classes through the entry points of Linkwright. The plugin gives such a package a separate type, for
which the task is registered. If ament_cmake is available, the plugin has no effect.
"""

from __future__ import annotations

import os
import sysconfig
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from colcon_core.environment import create_environment_scripts  # type: ignore[import-untyped]  # it ships no types
from colcon_core.logging import colcon_logger  # type: ignore[import-untyped]  # as above
from colcon_core.shell import create_environment_hook  # type: ignore[import-untyped]  # as above
from colcon_core.task import TaskExtensionPoint, create_file, install  # type: ignore[import-untyped]  # as above
from colcon_ros.package_identification.ros import RosPackageIdentification  # type: ignore[import-untyped]  # as above

from linkwright.diagnostics import SourceText
from linkwright.packages import MANIFEST
from linkwright.packages.readers.cmake import CMakeFile, read_cmake

COPIED_TYPE = "ros.ament_cmake_copied"
"""The colcon type of packages whose files are copied."""

_LOGGER = colcon_logger.getChild(__name__)
_RESOURCE_INDEX = "share/ament_index/resource_index"


class CopiedPackageIdentification(RosPackageIdentification):  # type: ignore[misc]  # its base has no types
    """An identification of ``ament_cmake`` packages that are copied without ament_cmake."""

    PRIORITY = RosPackageIdentification.PRIORITY + 10

    def identify(self, desc: Any) -> None:
        """Identify a ROS package as colcon-ros does, with type `COPIED_TYPE` if ament_cmake is missing."""
        super().identify(desc)
        if desc.type == "ros.ament_cmake" and not _has_ament_cmake(os.environ):
            desc.type = COPIED_TYPE


class CopyingAmentCmakeTask(TaskExtensionPoint):  # type: ignore[misc]  # its base has no types
    """A build task that installs the files that an ``ament_cmake`` package copies.

    It logs the parts that it skips.
    """

    async def build(self) -> int:
        """Install the files of the package, and return the exit status.

        Other programs recognize the package by the files that every installed package has: its marker in the resource
        index, and the scripts that add its prefix to the environment.
        """
        args, package = self.context.args, self.context.pkg
        folder = Path(args.path)
        try:
            text = (folder / "CMakeLists.txt").read_text(encoding="utf-8", errors="replace")
            cmake = read_cmake(SourceText("CMakeLists.txt", text), folder)
            skipped_parts = _describe_skipped(cmake)
            if skipped_parts:
                _LOGGER.warning(
                    f"'{package.name}' is not built in full without ROS 2: {'; '.join(skipped_parts)}. "
                    "The rest is installed. Build it where ament_cmake is installed to have all of it."
                )
            _install_all(args, package.name, folder, cmake)
        except FileNotFoundError as error:
            missing_file = error.filename or error
            _LOGGER.error(f"'{package.name}' installs '{missing_file}', which does not exist")  # noqa: TRY400  # no traceback
            return 1
        hooks = create_environment_hook(
            "ament_prefix_path", Path(args.install_base), package.name, "AMENT_PREFIX_PATH", "", mode="prepend"
        )
        if cmake.modules:
            hooks += create_environment_hook(
                "pythonpath", Path(args.install_base), package.name, "PYTHONPATH", _find_site_packages(), mode="prepend"
            )
        # Hooks in the language of a shell call functions of ament. Only ``.dsv`` hooks work with colcon alone.
        hooks += [Path(hook) for hook in cmake.hooks if hook.endswith(".dsv")]
        create_environment_scripts(package, args, additional_hooks=hooks)
        return 0


def _describe_skipped(cmake: CMakeFile) -> list[str]:
    compiled_names = ", ".join(f"'{name}'" for name in dict.fromkeys(cmake.compiled))
    return [*([f"{compiled_names} would have to be compiled"] if compiled_names else []), *dict.fromkeys(cmake.unknown)]


def _install_all(args: Any, name: str, folder: Path, cmake: CMakeFile) -> None:
    create_file(args, f"{_RESOURCE_INDEX}/packages/{name}")
    install(args, MANIFEST, f"share/{name}/{MANIFEST}")
    for file in cmake.installed_files(folder):
        if file.is_generated:
            create_file(args, file.destination, content=file.text(folder))
        else:
            install(args, file.source, file.destination)
    for interface in cmake.interfaces:
        install(args, interface, f"share/{name}/{interface}")
    if cmake.interfaces:
        create_file(
            args, f"{_RESOURCE_INDEX}/rosidl_interfaces/{name}", content="\n".join(sorted(cmake.interfaces)) + "\n"
        )
    for module in cmake.modules:
        _install_module(args, folder, module)


def _install_module(args: Any, folder: Path, module: str) -> None:
    """Install a Python module, or all files of a Python package."""
    path = folder / module
    if not path.exists():
        raise FileNotFoundError(module)
    for file in [path] if path.is_file() else sorted(path.rglob("*")):
        if file.is_file() and "__pycache__" not in file.parts:
            relative_path = Path(path.name) / file.relative_to(path) if path.is_dir() else Path(path.name)
            install(args, file.relative_to(folder).as_posix(), f"{_find_site_packages()}/{relative_path.as_posix()}")


def _find_site_packages() -> str:
    """Return the folder for Python packages, relative to the install prefix."""
    paths = sysconfig.get_paths("posix_prefix" if os.name != "nt" else "nt", vars={"base": "", "platbase": ""})
    return paths["purelib"].strip("/\\").replace("\\", "/")


def _has_ament_cmake(environment: Mapping[str, str]) -> bool:
    prefixes = environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return any(prefix and (Path(prefix) / "share" / "ament_cmake").is_dir() for prefix in prefixes)
