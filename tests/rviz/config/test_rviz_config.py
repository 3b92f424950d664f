"""Configurations: defaults, sizes that fit a model, and files."""

from __future__ import annotations

import difflib
from pathlib import Path

import pytest
import yaml

from linkwright.diagnostics import LinkwrightError
from linkwright.rviz import RvizConfig
from linkwright.rviz.config.views import ModelSize
from tests.corpora import CORPORA
from tests.places import TUTORIAL_PACKAGES

FILES = [
    file
    for folder in (*(corpus.robots for corpus in CORPORA), *TUTORIAL_PACKAGES)
    for file in sorted(folder.rglob("*.rviz"))
]

NESTED = """\
Panels: []
Visualization Manager:
  Displays:
    - Class: rviz/Grid
      Enabled: true
    - Class: rviz_common/Group
      Name: Sensors
      Enabled: false
      Displays:
        - Class: rviz_default_plugins/LaserScan
          Name: Laser
          Value: true
    - Name: broken
  Global Options:
    Fixed Frame: /odom
    Frame Rate: 10
    Background Color: 1; 2; 300
  Unknown: {keep: me}
Window Geometry:
  QMainWindow State: 000000ff00000000fd
"""


def test_default_configuration_matches_rviz():
    config = RvizConfig.default()
    assert [(display.cls, display.enabled) for display in config.displays] == [("rviz_default_plugins/Grid", True)]
    assert config.options.text("Fixed Frame") == "map"
    assert config.options.number("Frame Rate") == 30
    assert config.options.text("Background Color") == "#303030"
    assert config.views.current.values["Distance"] == 10.0


def test_configuration_for_model_has_grid_robot_model_and_tf():
    config = RvizConfig.for_model("base_link")
    assert [display.name for display in config.displays] == ["Grid", "RobotModel", "TF"]
    assert all(display.enabled for display in config.displays)
    reread = RvizConfig.parse(config.text())
    assert [display.cls for display in reread.displays] == [display.cls for display in config.displays]
    assert (reread.options.text("Fixed Frame"), reread.views.current.values["Distance"]) == ("base_link", 3.0)


@pytest.mark.parametrize(
    ("size", "cell", "marker_scale", "distance"),
    [
        (ModelSize(0.05, 0.01), 0.01, 0.025, 0.1),
        (ModelSize(0.34, 0.1), 0.1, 0.17, 0.68),
        (ModelSize(1.9, 0.05), 1.0, 0.24, 3.8),
        (ModelSize(20.0, 4.0), 10.0, 10.0, 40.0),
    ],
)
def test_grid_and_axes_scale_with_model_size(size, cell, marker_scale, distance):
    config = RvizConfig.for_model("base_link", size=size)
    reread = RvizConfig.parse(config.text())
    grid, _, tf = reread.displays
    assert grid.section.scalar("Cell Size").text == f"{cell:g}"
    assert tf.section.scalar("Marker Scale").text == f"{marker_scale:g}"
    assert reread.views.current.values["Distance"] == distance
    assert reread.views.current.values["Focal Shape Size"] <= min(0.05, size.diagonal / 10)


def resize_config(config, diagonal, ground=0.0):
    return {(display.name, *path): value for display, path, value in config.take_sizes(diagonal, ground)}


def test_grid_and_axes_are_resized_for_mesh_size():
    size = ModelSize(0.5, 0.2)
    sizes = {("Grid", "Cell Size"): 100.0, ("TF", "Marker Scale"): 12.0}
    assert resize_config(RvizConfig.for_model("base_link", size=size), 100.0) == sizes
    # Without `size`, a model that is one link with a mesh has no size.
    assert resize_config(RvizConfig.for_model("base_link"), 100.0) == {**sizes, ("TF", "Marker Scale"): 50.0}
    config = RvizConfig.for_model("base_link", size=size)
    assert resize_config(config.copy(), 100.0) == sizes
    assert resize_config(config, 100.0) == sizes
    assert resize_config(config, 200.0) == {}  # only once, because the user may have changed the view


@pytest.mark.parametrize("diagonal", [0.0, -1.0, float("nan"), float("inf")])
def test_model_without_size_resizes_nothing(diagonal):
    assert resize_config(RvizConfig.for_model("base_link"), diagonal) == {}


def test_grid_is_at_lowest_point_of_robot():
    sized_config = resize_config(RvizConfig.for_model("base_link", size=ModelSize(0.5, 0.2)), 1.0, -0.12345)
    assert sized_config == {("Grid", "Cell Size"): 1.0, ("TF", "Marker Scale"): 0.5, ("Grid", "Offset", "Z"): -0.1235}
    config = RvizConfig.for_model("base_link")
    config.displays[0].section.put(("Offset", "Z"), "1", nested=True)
    assert ("Grid", "Offset", "Z") not in resize_config(config, 1.0, -0.5)
    assert resize_config(RvizConfig.for_model("base_link"), 1.0, float("nan")) == {}
    assert resize_config(RvizConfig.default(), 1.0, -0.5) == {}


def test_changed_values_are_not_resized():
    config = RvizConfig.for_model("base_link", size=ModelSize(0.5, 0.2))
    config.displays[0].section.put(("Cell Size",), "3")
    assert set(resize_config(config, 100.0)) == {("TF", "Marker Scale")}
    assert resize_config(RvizConfig.default(), 100.0) == {}
    assert resize_config(RvizConfig.parse(RvizConfig.for_model("base_link").text()), 100.0) == {}


def test_tf_display_is_disabled_if_frames_would_hide_model():
    assert [display.checked for display in RvizConfig.for_model("base_link").displays] == [True, True, True]
    config = RvizConfig.for_model("base_link", frames=False)
    assert [display.checked for display in RvizConfig.parse(config.text()).displays] == [True, True, False]


def test_model_has_automatic_light_and_file_has_camera_light():
    assert RvizConfig.parse(RvizConfig.for_model("base_link").text()).options.text("Light") == "Automatic"
    assert RvizConfig.default().options.text("Light") == "Camera"
    assert "Light" not in RvizConfig.default().text()


def test_whole_robot_is_shown_until_camera_is_set():
    config = RvizConfig.for_model("base_link")
    assert config.shows_whole_robot
    assert config.copy().shows_whole_robot
    assert not RvizConfig.parse(config.text()).shows_whole_robot  # the configuration was saved, and opened as a file
    assert not RvizConfig.default().shows_whole_robot
    view = config.views.current
    view.values["Distance"] = 2.0
    config.views.current = view
    assert not config.shows_whole_robot
    assert not config.copy().shows_whole_robot
    config.propose_view({"Distance": 7.0})
    assert config.shows_whole_robot
    assert config.views.current.values["Distance"] == 7.0


def test_groups_and_rviz_1_classes_are_read():
    config = RvizConfig.parse(NESTED)
    assert [(display.cls, display.name, display.checked, display.enabled) for display in config.walk()] == [
        ("rviz_default_plugins/Grid", "Grid", True, True),
        ("rviz_common/Group", "Sensors", False, False),
        ("rviz_default_plugins/LaserScan", "Laser", True, False),
    ]
    grid, sensors = config.displays
    assert [display.group for display in sensors.displays] == [sensors]
    assert (grid.written_class, grid.group) == ("rviz/Grid", None)
    assert [warning.code for warning in config.warnings] == ["RVIZ202"]
    assert config.warnings[0].span.line == 13


def test_options_are_clamped_as_rviz_does():
    config = RvizConfig.parse(NESTED)
    assert config.options.text("Fixed Frame") == "odom"
    assert config.options.text("Background Color") == "#0102ff"


def test_changed_values_are_written_and_other_values_are_kept():
    config = RvizConfig.parse(NESTED)
    before = yaml.safe_load(NESTED)
    config.options.set(("Frame Rate",), 20)
    config.displays[1].displays[0].checked = False
    after = yaml.safe_load(config.text())
    manager = before["Visualization Manager"]
    manager["Global Options"]["Frame Rate"] = 20
    manager["Displays"][1]["Displays"][0]["Value"] = False
    assert after == before
    assert "QMainWindow State: 000000ff00000000fd" in config.text()


def test_invalid_value_is_reported_with_line():
    config = RvizConfig.parse("Visualization Manager:\n  Global Options:\n    Frame Rate: often\n")
    assert config.options.number("Frame Rate") == 30
    (warning,) = config.warnings
    assert (warning.code, warning.span.line, warning.severity.value) == ("RVIZ201", 3, "warning")
    assert "'often'" in warning.message


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_saved_files_have_equal_data(path: Path, tmp_path):
    config = RvizConfig.load(path)
    assert config.displays
    config.views.current = config.views.current
    config.options.rows()
    config.save(tmp_path / "saved.rviz")
    text = path.read_text(encoding="utf-8")
    assert (tmp_path / "saved.rviz").read_text(encoding="utf-8") == text
    # An edit changes one line, and the other lines keep RViz's layout.
    config.options.set(("Frame Rate",), 17)
    changes = [line for line in difflib.ndiff(text.splitlines(), config.text().splitlines()) if line[0] in "+-"]
    assert [line for line in changes if line[0] == "+"] == ["+     Frame Rate: 17"]
    assert len(changes) <= 2
    assert [warning for warning in config.warnings if warning.code not in ("RVIZ203", "RVIZ204")] == []


COMMENTED = "# mine\nPanels: []\nVisualization Manager:\n  Global Options: &o {Fixed Frame:   map}\n  Other: *o\n"


@pytest.mark.parametrize("content", [COMMENTED, COMMENTED.replace("\n", "\r\n"), "\ufeff" + COMMENTED])
def test_unchanged_file_is_written_back_byte_for_byte(tmp_path, content):
    path = tmp_path / "a.rviz"
    path.write_bytes(content.encode())
    config = RvizConfig.load(path)
    config.options.set(("Fixed Frame",), "odom")
    config.options.set(("Fixed Frame",), "map")
    config.save(tmp_path / "b.rviz")
    assert (tmp_path / "b.rviz").read_bytes() == content.encode()


def test_line_endings_and_byte_order_mark_survive_edit(tmp_path):
    path = tmp_path / "a.rviz"
    path.write_bytes(b"\xef\xbb\xbf" + COMMENTED.replace("\n", "\r\n").encode())
    config = RvizConfig.load(path)
    config.options.set(("Fixed Frame",), "odom")
    config.save()
    content = path.read_bytes()
    assert content.startswith(b"\xef\xbb\xbfPanels: []\r\n")
    assert content.count(b"\n") == content.count(b"\r\n")
    manager = yaml.safe_load(content.decode("utf-8-sig"))["Visualization Manager"]
    # The edited section had an alias. The alias keeps the old value.
    assert manager == {"Global Options": {"Fixed Frame": "odom"}, "Other": {"Fixed Frame": "map"}}


def test_configuration_without_displays_is_valid(tmp_path):
    config = RvizConfig.parse("Panels: []\n")
    assert (config.displays, config.text()) == ([], "Panels: []\n")
    config.insert(config.make_display("rviz_default_plugins/Grid", "Grid"))
    assert yaml.safe_load(config.text()) == {
        "Panels": [],
        "Visualization Manager": {
            "Displays": [{"Class": "rviz_default_plugins/Grid", "Enabled": True, "Name": "Grid", "Value": True}]
        },
    }


def test_displays_are_added_removed_and_moved():
    config = RvizConfig.parse(NESTED)
    before, text = config.arrangement(), config.text()
    grid, sensors = config.displays
    (laser,) = sensors.displays
    config.remove(grid)
    config.insert(grid, sensors, 0)
    duplicate = config.duplicate(laser)
    config.insert(duplicate, None, 0)
    group = config.make_group("New")
    config.insert(group, sensors)
    assert [display.name for display in config.walk()] == ["Laser", "Sensors", "Grid", "Laser", "New"]
    assert [display.name for display in RvizConfig.parse(config.text()).walk()] == [
        display.name for display in config.walk()
    ]
    for place in (group, grid):
        with pytest.raises(ValueError, match="cannot be put into"):
            config.insert(sensors, place)
    config.arrange(before)
    assert (config.displays, sensors.displays) == ([grid, sensors], [laser])
    assert config.text() == text


@pytest.mark.parametrize(
    "text",
    [
        "Panels: []\n",
        "Panels: []\nVisualization Manager:\n",
        "Panels: []\nVisualization Manager: nothing\n",
        "Visualization Manager:\n  Displays:\n  Name: root\n",
        "Visualization Manager:\n  Displays: ~\n",
        "Visualization Manager:\n  Displays: none\n",
        "Visualization Manager:\n  Displays: []\n",
        "Visualization Manager:\n  Displays:\n    - Class: rviz_common/Group\n      Displays: ~\n",
    ],
)
def test_undo_of_first_display_restores_file(text):
    config = RvizConfig.parse(text)
    before, count = config.arrangement(), len(list(config.walk()))
    config.insert(config.make_display("rviz_default_plugins/Axes", "Axes"), config.displays[0] if count else None)
    after, changed = config.arrangement(), config.text()
    assert len(list(RvizConfig.parse(changed).walk())) == count + 1
    for _ in range(2):
        config.arrange(before)
        assert config.text() == text
        config.arrange(after)
        assert config.text() == changed


@pytest.mark.parametrize(
    ("lines", "is_enabled"),
    [
        ("Enabled: true", True),
        ("Enabled: TRUE", True),
        ("Enabled: 1", True),
        ("Enabled: no", True),
        ("Enabled: off", True),
        ("Enabled: False", False),
        ("Enabled: 0", False),
        ("Enabled: ''", False),
        ("Enabled: ~", False),
        ("Value: yes", True),
        ("Value: false", False),
        ("Value: true, Enabled: false", False),
        ("Name: x", False),
    ],
)
def test_enabled_values_are_parsed_like_rviz(lines, is_enabled):
    config = RvizConfig.parse(f"Visualization Manager:\n  Displays:\n    - {{Class: rviz/Grid, {lines}}}\n")
    assert config.displays[0].checked is is_enabled


def test_entry_that_is_not_a_display_keeps_its_position():
    config = RvizConfig.parse(NESTED)
    config.remove(config.displays[0])
    items = yaml.safe_load(config.text())["Visualization Manager"]["Displays"]
    assert [item["Name"] for item in items] == ["Sensors", "broken"]


def test_saving_is_atomic_and_keeps_symlink_and_permissions(tmp_path):
    real, link = tmp_path / "real.rviz", tmp_path / "link.rviz"
    real.write_text(NESTED, encoding="utf-8")
    real.chmod(0o640)
    link.symlink_to(real)
    config = RvizConfig.load(link)
    assert not config.changed_on_disk
    config.options.set(("Fixed Frame",), "odom2")
    config.save()
    assert link.is_symlink()
    assert real.stat().st_mode & 0o777 == 0o640
    assert RvizConfig.load(real).options.text("Fixed Frame") == "odom2"
    assert not config.changed_on_disk
    real.write_text(NESTED + "# by another\n", encoding="utf-8")
    assert config.changed_on_disk
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link.rviz", "real.rviz"]


def test_save_writes_to_loaded_path(tmp_path):
    path = tmp_path / "a.rviz"
    path.write_text(NESTED, encoding="utf-8")
    config = RvizConfig.load(path)
    config.options.set(("Fixed Frame",), "map")
    config.save()
    assert RvizConfig.load(path).options.text("Fixed Frame") == "map"
    with pytest.raises(ValueError, match="no file"):
        RvizConfig.default().save()
    with pytest.raises(LinkwrightError) as caught:
        config.save(tmp_path / "missing" / "a.rviz")
    assert caught.value.diagnostics[0].code == "RVIZ104"


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (None, "RVIZ101"),
        (b"\xff\xfe\x00a", "RVIZ101"),
        (b"a: [1\n", "RVIZ102"),
        (b"robot_state_publisher:\n  ros__parameters: {}\n", "RVIZ103"),
    ],
)
def test_unreadable_files_are_reported(tmp_path, content, code):
    path = tmp_path / "x.rviz"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(LinkwrightError) as caught:
        RvizConfig.load(path)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == code
    assert str(path) in diagnostic.message or diagnostic.span.file == str(path)


def test_file_may_begin_with_byte_order_mark(tmp_path):
    path = tmp_path / "x.rviz"
    path.write_bytes(b"\xef\xbb\xbf" + NESTED.encode())
    assert RvizConfig.load(path).displays
