"""Parts of .rviz files with the visible panels; for tests."""

from __future__ import annotations

from linkwright.rviz import RvizConfig

RVIZ_PANELS = """\
Panels:
  - Class: rviz_common/Displays
    Help Height: 78
    Name: Displays
    Property Tree Widget:
      Expanded:
        - /Global Options1
      Splitter Ratio: 0.5
    Tree Height: 464
  - Class: rviz_common/Selection
    Name: Selection
  - Class: rviz_common/Tool Properties
    Expanded: ~
    Name: Tool Properties
    Splitter Ratio: 0.5
  - Class: some_package/Knobs
    Level: 11
    Name: Knobs
  - Class: rviz_common/Views
    Expanded:
      - /Current View1
    Name: Views
    Splitter Ratio: 0.5
"""
"""The panels as RViz writes them, and one panel of a plugin."""


def window_state(collapsed: tuple[str, ...] = (), hide_right: bool = False, **hidden: bool) -> str:
    """Return ``Window Geometry`` with a state from Qt.

    Docks are visible except those with ``NAME=False``.
    """
    docks = {"Selection": True, "Tool Properties": True, "Displays": True, "Knobs": True, "Views": True} | hidden
    state = "000000ff00000000fd00000001000000000000013c0000025ffc02" + f"{len(docks) + 1:08x}"
    for name, shown in docks.items():
        text = name.encode("utf-16-be").hex()
        state += f"fb{len(text) // 2:08x}{text}{1 if shown else 0:02x}" + "000001e10000009b0000006400ffffff"
    # A position that a dock had earlier.
    state += "fb0000000a00560069006500770073" + "03" + "0000004e00000080000002e100000197"
    lines = ["Window Geometry:", f"  Hide Left Dock: false\n  Hide Right Dock: {str(hide_right).lower()}"]
    lines += [f"  QMainWindow State: {state}00000004000000040000000800000008fc00000000"]
    lines += [f"  {name}:\n    collapsed: {str(name in collapsed).lower()}" for name in docks]
    return "\n".join([*lines, "  Width: 1200\n"])


def open_panels(config: RvizConfig) -> list[str] | None:
    return config.panels.shown
