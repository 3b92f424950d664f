"""Make Python modules of message types that the ROS 2 wheels of this interpreter lack.

    .build/ros/bin/python tools/ros_types.py PACKAGE=FOLDER... OUTPUT

reads the ``.idl`` files in ``msg/`` and ``srv/`` of each folder, and compiles the code that rosidl generates.
``OUTPUT`` then has ``python``, for ``PYTHONPATH``, and ``lib``, for ``LD_LIBRARY_PATH``. Needs gcc and g++.
"""

from __future__ import annotations

import importlib
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any

PREFIX = Path(sys.prefix)
FLAGS = ["-O1", "-fPIC", "-shared", "-w", "-Wl,--no-as-needed", "-Wl,--allow-shlib-undefined"]
SUPPORTS = ("rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c", "rosidl_typesupport_c")


def make(package: str, folder: Path, output: Path) -> None:
    """Generate, compile and install the types of a package."""
    with tempfile.TemporaryDirectory() as build_folder:
        generated = Path(build_folder)
        generate(package, folder, [str(path.relative_to(folder)) for path in folder.glob("*/*.idl")], generated)
        headers = generated / "include" / package
        for part in ("c", "fastrtps_c", "introspection_c"):
            shutil.copytree(generated / part, headers, dirs_exist_ok=True)
        build(package, generated, output)


def generate(package: str, folder: Path, interfaces: list[str], output: Path) -> None:
    """Generate code like ``rosidl generate``.

    That command fails here because its plug-ins are registered twice.
    """
    entry_points: Any = importlib.import_module("rosidl_cli.entry_points")
    api = importlib.import_module("rosidl_cli.command.generate.api")

    original = entry_points.get_entry_points

    entry_points.get_entry_points = lambda group, *, specs=None, **_: original(group, specs=specs, strict=False)
    api.generate(
        package_name=package,
        interface_files=[f"{folder.resolve()}:{name}" for name in interfaces],
        include_paths=[PREFIX / "share", folder.parent],
        output_path=output,
        types=["c", "py"],
        typesupports=["c", "fastrtps_c", "introspection_c"],
    )


def build(package: str, generated: Path, output: Path) -> None:
    """Compile the libraries and the modules."""
    import numpy as np

    libraries, modules = output / "lib", output / "python" / package
    libraries.mkdir(parents=True, exist_ok=True)
    shutil.copytree(generated / "py", modules, dirs_exist_ok=True)
    (modules / "__init__.py").touch()
    include = [PREFIX / "include", generated / "include", *sorted((PREFIX / "include").iterdir())]
    include += [Path(sysconfig.get_path("include")), Path(np.get_include())]
    common = [f"-I{folder}" for folder in include]
    folders = [libraries.resolve(), PREFIX / "lib"]
    paths = [f"{option}{folder}" for folder in folders for option in ("-L", "-Wl,-rpath,")]

    def compile_into(target: Path, sources: list[Path], *needed: str) -> None:
        compiler = "g++" if any(source.suffix == ".cpp" for source in sources) else "gcc"
        linked = [f"-l{name}" for name in needed]
        subprocess.run([compiler, *FLAGS, *common, *map(str, sources), "-o", str(target), *paths, *linked], check=True)

    def library(part: str, sources: list[Path], *needed: str) -> str:
        name = f"{package}__{part}"
        compile_into(libraries / f"lib{name}.so", sources, *needed, *list_libraries(part))
        return name

    values = library(
        "rosidl_generator_c", sorted((generated / "c").glob("*/detail/*.c")), "rosidl_runtime_c", "rcutils"
    )
    fast = library(
        SUPPORTS[0],
        sorted((generated / "fastrtps_c").glob("*/detail/*.cpp")),
        *(values, "rosidl_typesupport_fastrtps_c", "rosidl_typesupport_fastrtps_cpp", "fastcdr", "rmw"),
    )
    library(SUPPORTS[1], sorted((generated / "introspection_c").glob("*/detail/*.c")), values, SUPPORTS[1])
    chosen = library(SUPPORTS[2], sorted((generated / "c").glob("*/*.cpp")), values, fast, SUPPORTS[2])
    python = library("rosidl_generator_py", sorted((generated / "py").glob("*/*_s.c")), values)
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    for support, of in ((SUPPORTS[0], fast), (SUPPORTS[2], chosen)):
        source = generated / "py" / f"_{package}_s.ep.{support}.c"
        compile_into(modules / f"{package}_s__{support}{suffix}", [source], of, python, values, "rosidl_typesupport_c")


def list_libraries(part: str) -> list[str]:
    """Return the libraries of a kind in installed packages, which these types may depend on."""
    return [path.name[3:-3] for path in sorted((PREFIX / "lib").glob(f"lib*__{part}.so"))]


if __name__ == "__main__":
    *packages, target = sys.argv[1:]
    for word in packages:
        name, _, where = word.partition("=")
        make(name, Path(where), Path(target))
