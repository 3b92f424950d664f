"""The wheels in `uv.lock`.

Each system and Python has one for every package of the extra ``learn``.
"""

from __future__ import annotations

import importlib.util

import pytest

from linkwright.learning.packing.locked_files import find_needed_files, find_needed_packages, load_locked_packages
from linkwright.learning.packing.optional_parts import PARTS, find_missing_parts, list_package_names
from linkwright.learning.packing.targets import Target, select_targets
from tests.places import REPOSITORY

TARGETS = select_targets((), ())
pytestmark = pytest.mark.extra("learn")

SOURCE_ONLY = {"srt"}
"""Packages of pure Python without a wheel, which packs build."""
CONDITIONAL_PACKAGES = {
    "async-timeout",
    "backports-asyncio-runner",
    "cffi",
    "colorama",
    "pycparser",
    "pywinpty",
    "tomli",
}
"""Packages that some systems or versions of Python do not need."""
MISSING_PARTS = {
    "windows": {"cyclonedds": ["3.14"], "pocketsphinx": ["3.14"]},
    "macos-arm64": {"cyclonedds": ["3.14"], "embreex": "all", "pocketsphinx": ["3.14"]},
    "macos-x86_64": {
        "cyclonedds": "all",
        "mujoco": "all",
        "embreex": "all",
        "onnxruntime": ["3.14"],
        "pocketsphinx": ["3.14"],
    },
    "linux-x86_64": {"cyclonedds": ["3.14"], "pocketsphinx": ["3.14"]},
    "linux-aarch64": {"cyclonedds": "all", "embreex": "all", "pocketsphinx": ["3.10", "3.12", "3.14"]},
}
"""The documented gaps: system -> package -> versions of Python."""


@pytest.mark.parametrize("target", TARGETS, ids=lambda target: target.name)
def test_all_packages_of_course_have_wheels(target: Target) -> None:
    packages = load_locked_packages()
    files = list(find_needed_files(target, ["learn"], packages))
    needed_names = {key.partition(" ")[0] for key in find_needed_packages(target, ["learn"], packages)}
    assert {file.package for file in files} == needed_names
    assert {file.package for file in files if not file.is_wheel} <= SOURCE_ONLY
    assert {"aiohttp", "numpy", "packaging", "pip", "vosk"} <= needed_names


@pytest.mark.parametrize("target", TARGETS, ids=lambda target: target.name)
def test_missing_parts_match_table_of_system(target: Target) -> None:
    missing = {part.packages[0] for part in find_missing_parts(target, ["learn"], load_locked_packages())}
    expected_parts = MISSING_PARTS[target.system]
    assert missing == {name for name, pythons in expected_parts.items() if pythons == "all" or target.python in pythons}


def test_packages_of_some_systems_belong_to_listed_parts() -> None:
    direct = {
        edge["key"].partition(" ")[0]
        for extra in load_locked_packages()["linkwright"]["extras"].values()
        for edge in extra
    }
    names_by_target = [list_package_names(target, ["learn"], load_locked_packages()) for target in TARGETS]
    sometimes = (set.union(*names_by_target) - set.intersection(*names_by_target)) & direct
    assert sometimes - CONDITIONAL_PACKAGES == {name for part in PARTS for name in part.packages}


def test_windows_targets_need_pywinpty() -> None:
    assert all(
        ("pywinpty" in list_package_names(target, ["learn"], load_locked_packages())) == (target.system == "windows")
        for target in TARGETS
    )


def test_package_table_matches_uv_lock() -> None:
    specification = importlib.util.spec_from_file_location("pack_wheels", REPOSITORY / "tools" / "pack_wheels.py")
    assert specification is not None
    assert specification.loader is not None
    tool = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(tool)
    text = tool.TABLE_FILE.read_text(encoding="utf-8")
    assert tool.format_table(tool.LOCK.read_text(encoding="utf-8")) == text, "run python tools/pack_wheels.py"
