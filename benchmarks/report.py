"""The pages with the figures: ``docs/benchmarks.md`` and its Chinese version.

A run with ``--write`` of some measurements keeps the figures of the others.
"""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping, Sequence
from datetime import datetime, timezone
from importlib import metadata
from pathlib import Path

from benchmarks import peers
from benchmarks.measure import ROOT, Measured
from linkwright import __version__

TITLES = {
    "xacro": ("xacro", "xacro"),
    "urdf": ("URDF", "URDF"),
    "kinematics": ("Forward kinematics", "正运动学"),
    "graph": ("Computation graph", "计算图"),
    "executors": ("Executors", "执行器"),
    "messages": ("Messages", "消息"),
    "dds": ("DDS and Zenoh", "DDS 与 Zenoh"),
    "launch": ("Launch", "启动"),
    "viewer": ("Viewer", "查看器"),
    "page": ("Page", "网页"),
    "simulation": ("Simulation", "仿真"),
    "control": ("ros2_control", "ros2_control"),
    "drives": ("Controllers of drives", "底盘控制器"),
    "mapping": ("Mapping", "建图"),
    "navigation": ("Navigation", "导航"),
    "planning": ("Arms", "机械臂"),
    "sizes": ("Sizes", "规模"),
    "voice": ("Voice", "语音"),
    "vision": ("Detectors", "检测器"),
    "contributing": ("A first test", "第一次测试"),
}
_ENGLISH = """# Benchmarks

What `make bench` measures, side by side with programs from PyPI on the same machine in the same run
({machine}). Figures are medians. In brackets stands how many times ours the other program's figure
is. The inputs are {inputs}. The other readers of URDF check less than
urdfdom does, and name no places; pinocchio reads with urdfdom, in C++. viser shows the same arm and points in the same
browser, both drawn without a graphics card, each with its own defaults.

`python -m benchmarks.peers` installs the other programs into `.build/peers`; `python -m benchmarks --write` measures
and writes this page.
"""
_CHINESE = """# 性能测试

`make bench` 的测量结果，与 PyPI 上的程序在同一台机器、同一次运行中对比（{machine}）。
数值为中位数，括号内是对方的数值为我们的多少倍。输入为 {inputs}。其他 URDF 读取程序的检查少于 urdfdom，
也不指出位置；pinocchio 通过 C++ 的 urdfdom 读取。viser 在同一个浏览器中显示同样的机械臂和点云，
两者都不用显卡绘制，各用自己的默认设置。

`python -m benchmarks.peers` 把对比程序安装到 `.build/peers`；`python -m benchmarks --write` 测量并写出本页。
"""
_TABLE_HEADS = (
    "| what | Linkwright | promised | others |\n| --- | --- | --- | --- |\n",
    "| 项目 | Linkwright | 承诺 | 其他程序 |\n| --- | --- | --- | --- |\n",
)
_SIZES_TABLE_RULE = "| --- | --- | --- | --- | --- | --- |\n"
_SIZES_TABLE_HEADS = (
    f"| command | many of what | 1 000 | 10 000 | 100 000 | ten times as many (time, memory) |\n{_SIZES_TABLE_RULE}",
    f"| 命令 | 数量变化的内容 | 1 000 | 10 000 | 100 000 | 数量增加十倍时（时间、内存） |\n{_SIZES_TABLE_RULE}",
)
_SIZES_NOTES = (
    """Time of the processor and the most memory at once, of a process for each figure. What a bound of the program
refuses is `refused`; `-` is what would take more than four minutes. The last column compares the two largest that were
measured, their times without what the command takes for a single thing. The rows are filled by
`python -m benchmarks --write sizes`, which measures as many of them at once as there are processors.

""",
    """每个数值来自一个单独的进程：处理器时间，以及同一时刻占用的最大内存。
`refused` 表示超出程序设定的上限而被拒绝，`-` 表示需要四分钟以上。
最后一列比较测到的最大两个规模，时间已减去命令处理单个对象所需的部分。
各行由 `python -m benchmarks --write sizes` 测得，有几个处理器就同时测几行。

""",
)
_INPUT_DESCRIPTIONS = {
    True: (
        "58 expansions of real robots, and robots made for measuring",
        "真实机器人的 58 次展开，以及专为测量生成的机器人",
    ),
    False: ("robots made for measuring", "专为测量生成的机器人"),
}


def write(results: Mapping[str, Sequence[Measured]], *, corpus: bool) -> list[Path]:
    """Write the pages.

    Args:
        results: the rows of each measurement, by name; the page keeps its rows of other measurements.
        corpus: whether the corpus of real robots was available.

    Returns:
        The files written.
    """
    written = []
    for place, (text, path) in enumerate(((_ENGLISH, "docs/benchmarks.md"), (_CHINESE, "docs/zh/benchmarks.md"))):
        target = ROOT / path
        head, *sections = target.read_text(encoding="utf-8").split("\n## ")
        old = {section.partition("\n")[0]: section for section in sections}
        if results.keys() == TITLES.keys():
            introduction = text.format(machine=_describe_machine(), inputs=_INPUT_DESCRIPTIONS[corpus][place])
            head = f"{introduction}\n{_list_versions()}"
        for name, rows in results.items():
            heads, about = (_SIZES_TABLE_HEADS, _SIZES_NOTES[place]) if name == "sizes" else (_TABLE_HEADS, "")
            old[TITLES[name][place]] = f"{TITLES[name][place]}\n\n{about}{_format_section(rows, heads[place])}"
        ordered = [old.pop(titles[place]) for titles in TITLES.values() if titles[place] in old]
        ordered += old.values()  # figures published by others, which are not measured here
        target.write_text("\n## ".join([head, *ordered]), encoding="utf-8")
        written.append(target)
    return written


def _format_section(rows: Sequence[Measured], head: str) -> str:
    date = datetime.now(timezone.utc).date().isoformat()
    return f"{date}\n\n{head}" + "".join("| " + " | ".join(row.cells()) + " |\n" for row in rows)


def _describe_machine() -> str:
    return f"Python {platform.python_version()}, {platform.system()} {platform.machine()}, {os.cpu_count()} CPU"


def _list_versions() -> str:
    lines = [f"- Linkwright {__version__}"]
    lines += [f"- {name} {metadata.version(name)}" for name in ("cyclonedds", "rosbags")]
    lines += [f"- {name} {peers.get_version(name) or '-'}" for name in peers.REQUIREMENTS]
    return "\n".join(lines) + "\n"
