"""Update the tables in pages that come from the code.

They list the commands, the extras, and the systems that support extras.

Usage: python tools/page_tables.py [--check]

A table is between the comments ``<!-- table: NAME -->`` and ``<!-- end of table -->``, in the language of its page.
Commands and their texts come from the help, and packages and their markers from ``pyproject.toml``.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement

from linkwright.cli.command import collect_help_texts, create_parser, find_command_groups
from linkwright.cli.language import translate_help
from linkwright.descriptions import load
from linkwright.diagnostics.translation import set_language, translate_phrase
from linkwright.learning.packing import targets
from linkwright.learning.packing.locked_files import load_locked_packages
from linkwright.learning.packing.optional_parts import PARTS, find_missing_parts

sys.path.insert(0, str(Path(__file__).resolve().parent))
from command_reference import describe_command

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
PAGES = tuple(
    DOCS / folder / name
    for folder in ("", "zh")
    for name in ("index.md", "getting-started.md", "gallery.md", "howto-class.md")
)

tomllib: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")
PROJECT, ENGINE = (
    tomllib.loads((folder / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for folder in (ROOT, ROOT / "core")
)

_TABLE = re.compile(r"(?<=<!-- table: )(\w+) -->\n.*?(?=<!-- end of table -->)", re.DOTALL)


@dataclass(frozen=True)
class Extra:
    """The purpose of an extra.

    Attributes:
        main: the package without which the extra is useless.
        english: its purpose, as a phrase.
        chinese: the same in Chinese.
    """

    main: str
    english: str
    chinese: str


EXTRAS = {
    "dds": Extra(
        "cyclonedds",
        "other processes: `linkwright topic`, `node`, `service`, executables of your packages, ROS 2 robots",
        "与其他进程通信：`linkwright topic`、`node`、`service` 等命令，自己功能包的可执行文件，运行 ROS 2 的机器人",
    ),
    "zenoh": Extra(
        "eclipse-zenoh",
        "the same over Zenoh, as `rmw_zenoh_cpp`, and where DDS has no wheel",
        "同样的通信，但经由 Zenoh，与 `rmw_zenoh_cpp` 相同；也用于 DDS 没有 wheel 的系统",
    ),
    "sim": Extra(
        "mujoco", "simulation: `linkwright sim`, `drive`, `dataset`", "仿真：`linkwright sim`、`drive`、`dataset`"
    ),
    "arm": Extra("ompl", "motions of arms", "机械臂的运动规划"),
    "navigation": Extra("scipy", "mapping, localization, planning", "建图、定位、路径规划"),
    "vision": Extra("onnxruntime", "object detectors", "目标检测"),
    "voice": Extra("vosk", "speech engines, the system's microphone", "语音引擎、系统麦克风"),
    "bag": Extra(
        "rosbags", "recordings: `linkwright bag`, recordings in the page", "录制：`linkwright bag`，在页面里回放"
    ),
    "learn": Extra(
        "markdown-it-py",
        "courses: `linkwright learn`, with all that they need",
        "课程 `linkwright learn`，以及课程需要的一切",
    ),
    "lsp": Extra("pygls", "the language server: `linkwright lsp`", "语言服务器：`linkwright lsp`"),
    "image": Extra(
        "pillow", "compressed images in the page, textures in exports", "页面里的压缩图像，导出文件里的纹理"
    ),
    "mesh": Extra(
        "trimesh",
        "exports; glTF and unusual mesh files in `linkwright inertia` and `check`",
        "导出；`linkwright inertia` 和 `check` 读取 glTF 和少见的网格文件",
    ),
    "diagram": Extra("pygraphviz", "PDF and SVG of `linkwright diagram`", "`linkwright diagram` 的 PDF 和 SVG"),
    "colcon": Extra(
        "colcon-common-extensions",
        "`colcon build` in `linkwright shell`",
        "在 `linkwright shell` 里运行 `colcon build`",
    ),
    "parquet": Extra("pyarrow", "Parquet tables of `linkwright sweep`", "`linkwright sweep` 的 Parquet 表格"),
    "ray": Extra("ray", "`linkwright sweep` on a cluster", "在集群上运行 `linkwright sweep`"),
    "train": Extra("torch", "`linkwright vision train`", "`linkwright vision train`"),
}
"""The extras, in the order of the table."""

ROBOTS = {
    "arm": ("Arm with a gripper", "带夹爪的机械臂"),
    "scara": ("SCARA", "SCARA 机械臂"),
    "delta": ("Delta robot", "并联机器人"),
    "hand": ("Hand with five fingers", "五指灵巧手"),
    "printer": ("3D printer", "3D 打印机"),
    "camera_tower": ("Pan-tilt camera tower", "云台摄像塔"),
    "mobile_manipulator": ("Mobile manipulator", "移动机械臂"),
    "mecanum_platform": ("Platform with mecanum wheels", "麦克纳姆轮平台"),
    "balancer": ("Self-balancing robot", "两轮自平衡机器人"),
    "car": ("Car with Ackermann steering", "阿克曼转向小车"),
    "rover": ("Rover with rockers and bogies", "摇臂式火星车"),
    "forklift": ("Forklift", "叉车"),
    "excavator": ("Excavator", "挖掘机"),
    "snake": ("Snake robot", "蛇形机器人"),
    "quadruped": ("Quadruped", "四足机器人"),
    "hexapod": ("Hexapod", "六足机器人"),
    "humanoid": ("Humanoid", "人形机器人"),
    "quadrotor": ("Quadrotor", "四旋翼"),
    "plane": ("Fixed-wing plane", "固定翼飞机"),
    "underwater_vehicle": ("Underwater vehicle", "水下机器人"),
}
"""The robots of the gallery: maps the name of a file to the titles in English and in Chinese."""

COLUMNS = 4

SYSTEMS = {
    "Linux x86-64": ("linux", "x86_64"),
    "Linux ARM64": ("linux", "aarch64"),
    "macOS Apple silicon": ("darwin", "arm64"),
    "macOS Intel": ("darwin", "x86_64"),
    "Windows": ("win32", "AMD64"),
}
"""Maps the name of a system to its ``sys_platform`` and ``platform_machine``."""

PYTHONS = [words[-1] for line in PROJECT["classifiers"] if re.fullmatch(r"3\.\d+", (words := line.split(" :: "))[-1])]
"""The versions of Python that Linkwright supports, oldest first."""


def refresh_page(page: str, chinese: bool) -> str:
    """Return the text of a page with current tables."""
    return _TABLE.sub(lambda match: f"{match[1]} -->\n\n{TABLES[match[1]](chinese)}\n\n", page)


def commands(chinese: bool) -> str:
    """Return the table of commands by group, with help texts and links to the reference."""
    set_language("zh" if chinese else "en")
    try:
        title = "用途" if chinese else "what it does"
        return "\n\n".join(
            "\n".join(
                [f"| {_capitalize(translate_help(group))} | {title} |", "| --- | --- |", *map(_format_command, verbs)]
            )
            for group, verbs in find_command_groups().items()
        )
    finally:
        set_language(None)


def extras(chinese: bool) -> str:
    """Return the table of extras, with their purposes and packages."""
    rows = ["| 可选部分 | 用途 | 安装的包 |" if chinese else "| extra | for | brings |", "| --- | --- | --- |"]
    together = {name for requirement in _iterate_requirements("all") for name in requirement.extras}
    apart = "；不在 `all` 里" if chinese else "; not in `all`"
    for name, extra in EXTRAS.items():
        purpose = (extra.chinese if chinese else extra.english) + ("" if name in together else apart)
        brought = dict.fromkeys(
            requirement.name for requirement in _iterate_requirements(name) if requirement.name != PROJECT["name"]
        )
        engine_extras = [
            f"`{other}`" for requirement in _iterate_requirements(name) for other in sorted(requirement.extras)
        ]
        rows.append(f"| `{name}` | {purpose} | {('、' if chinese else ', ').join([*engine_extras, *brought])} |")
    return "\n".join(rows)


def systems(chinese: bool) -> str:
    """Return the table of Python versions for extras that are not available everywhere."""
    rows = [f"| {'可选部分' if chinese else 'extra'} | {' | '.join(SYSTEMS)} |", f"| --- |{' --- |' * len(SYSTEMS)}"]
    every = f"{PYTHONS[0]}–{PYTHONS[-1]}"
    for name, extra in EXTRAS.items():
        cells = [_find_python_span(extra.main, *system) for system in SYSTEMS.values()]
        if set(cells) != {every}:
            rows.append(f"| `{name}` | {' | '.join(cells)} |")
    return "\n".join(rows)


def gallery(chinese: bool) -> str:
    """Return the rows of the gallery: images with titles and numbers of moving joints."""
    folder = "../gallery" if chinese else "gallery"
    images = {}
    for name, titles in ROBOTS.items():
        title = titles[chinese]
        joints = sum(joint.type != "fixed" for joint in load(DOCS / "gallery" / f"{name}.xacro").joints.values())
        text = f"，{joints} 个活动关节" if chinese else f", {joints} moving joints"
        images[f"![{title}]({folder}/{name}.webp)"] = f"[{title}]({folder}/{name}.xacro){text}"
    rows = [list(images)[first : first + COLUMNS] for first in range(0, len(images), COLUMNS)]
    return "\n\n".join(
        "\n".join((_format_row(row), _format_row(["---"] * len(row)), _format_row([images[image] for image in row])))
        for row in rows
    )


def pack(chinese: bool) -> str:
    """Return the table of a course's parts that some packs lack.

    For each system, it has the Python versions with the part.
    """
    language = "zh" if chinese else "en"
    labels = [system.label for system in targets.SYSTEMS.values()]
    rows = [f"| {'部分' if chinese else 'part'} | {' | '.join(labels)} |", f"| --- |{' --- |' * len(labels)}"]
    for part in PARTS:
        cells = []
        for system in targets.SYSTEMS:
            have = [
                target.python
                for target in targets.select_targets([system], ())
                if part not in find_missing_parts(target, ["learn"], load_locked_packages())
            ]
            is_span = have == list(targets.PYTHONS[: len(have)])
            cells.append(f"{have[0]}–{have[-1]}" if have and is_span else ("、" if chinese else ", ").join(have) or "–")
        rows.append(f"| {_capitalize(translate_phrase(part.purpose, language))} | {' | '.join(cells)} |")
    return "\n".join(rows)


TABLES: dict[str, Callable[[bool], str]] = {
    "commands": commands,
    "extras": extras,
    "systems": systems,
    "gallery": gallery,
    "pack": pack,
}


def _format_command(name: str) -> str:
    first = next(describe_command(create_parser(name), "")).partition("\n")[0].removeprefix("## ").strip()
    help_text = translate_help(collect_help_texts()[name])
    return f"| [`linkwright {name}`](commands.md#{first.replace(' ', '-')}) | {help_text} |"


def _format_row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _capitalize(text: str) -> str:
    return text[:1].upper() + text[1:]


def _iterate_requirements(extra: str) -> Iterator[Requirement]:
    """Yield the requirements of an extra in order.

    The engine's extras are replaced with their requirements.
    """
    for requirement in map(Requirement, PROJECT["optional-dependencies"][extra]):
        if requirement.name == ENGINE["name"]:
            for name in requirement.extras:
                yield from map(Requirement, ENGINE["optional-dependencies"][name])
        else:
            yield requirement


def _find_python_span(main: str, platform: str, machine: str) -> str:
    """Return the Python versions that require a package on a system, such as ``3.10–3.13``."""
    requirements = [
        requirement
        for extra in EXTRAS
        for requirement in _iterate_requirements(extra)
        if requirement.name == main or requirement.name.startswith(f"{main}-")
    ]
    versions = [
        version
        for version in PYTHONS
        if any(
            requirement.marker is None
            or requirement.marker.evaluate(
                {"python_version": version, "sys_platform": platform, "platform_machine": machine}
            )
            for requirement in requirements
        )
    ]
    return f"{versions[0]}–{versions[-1]}" if versions else "–"


def main(words: Sequence[str]) -> int:
    """Write the pages, or with ``--check`` report whether they are current."""
    status = 0
    for page in PAGES:
        old_text = page.read_text(encoding="utf-8")
        new_text = refresh_page(old_text, page.parent.name == "zh")
        if old_text != new_text and "--check" in words:
            print(f"{page} is stale: run python tools/page_tables.py", file=sys.stderr)
            status = 1
        elif old_text != new_text:
            page.write_text(new_text, encoding="utf-8", newline="\n")
    return status


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
