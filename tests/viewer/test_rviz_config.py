from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from linkwright.diagnostics import LinkwrightError
from linkwright.viewer import RvizConfig
from tests.places import REPOSITORY, TUTORIAL

CORPUS = REPOSITORY.parent / "shared" / "corpus" / "robots"
REAL_FILES = [*sorted(CORPUS.rglob("*.rviz")), *sorted(TUTORIAL.rglob("*.rviz"))]

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


def test_the_default_is_rviz_default():
    config = RvizConfig.default()
    assert [(display.cls, display.enabled) for display in config.displays] == [("rviz_default_plugins/Grid", True)]
    assert config.options.text("Fixed Frame") == "map"
    assert config.options.number("Frame Rate") == 30
    assert config.options.text("Background Color") == "#303030"
    assert config.view.distance == 10.0


def test_a_model_gets_grid_robot_and_tf():
    config = RvizConfig.for_model("base_link", distance=2.0)
    assert [display.name for display in config.displays] == ["Grid", "RobotModel", "TF"]
    assert all(display.enabled for display in config.displays)
    again = RvizConfig.parse(config.text())
    assert [display.cls for display in again.displays] == [display.cls for display in config.displays]
    assert (again.options.text("Fixed Frame"), again.view.distance) == ("base_link", 2.0)


def test_groups_are_opened_and_old_classes_understood():
    config = RvizConfig.parse(NESTED)
    assert [(display.cls, display.name, display.enabled) for display in config.displays] == [
        ("rviz_default_plugins/Grid", "Grid", True),
        ("rviz_default_plugins/LaserScan", "Sensors / Laser", False),
    ]
    assert [warning.code for warning in config.warnings] == ["RVIZ202"]
    assert config.warnings[0].span.line == 13


def test_options_are_clamped_as_rviz_does():
    config = RvizConfig.parse(NESTED)
    assert config.options.text("Fixed Frame") == "odom"
    assert config.options.text("Background Color") == "#0102ff"


def test_changed_values_are_written_and_everything_else_is_kept():
    config = RvizConfig.parse(NESTED)
    before = yaml.safe_load(NESTED)
    config.options.set(("Frame Rate",), 20)
    config.displays[1].enabled = True
    after = yaml.safe_load(config.text())
    manager = before["Visualization Manager"]
    manager["Global Options"]["Frame Rate"] = 20
    manager["Displays"][1] |= {"Enabled": True, "Value": True}
    manager["Displays"][1]["Displays"][0] |= {"Value": True}
    assert after == before
    assert "QMainWindow State: 000000ff00000000fd" in config.text()


def test_a_value_that_cannot_be_used_is_reported_with_its_line():
    config = RvizConfig.parse("Visualization Manager:\n  Global Options:\n    Frame Rate: often\n")
    assert config.options.number("Frame Rate") == 30
    (warning,) = config.warnings
    assert (warning.code, warning.span.line, warning.severity.value) == ("RVIZ201", 3, "warning")
    assert "'often'" in warning.message


@pytest.mark.skipif(not REAL_FILES, reason="the corpus of real robots is not here")
@pytest.mark.parametrize("path", REAL_FILES, ids=lambda path: path.name)
def test_real_files_are_written_back_with_equal_data(path: Path, tmp_path):
    config = RvizConfig.load(path)
    assert config.displays
    config.view = config.view
    for store in (config.options,):
        store.rows()
    config.save(tmp_path / "saved.rviz")
    text = (tmp_path / "saved.rviz").read_text(encoding="utf-8")
    assert yaml.safe_load(text) == yaml.safe_load(path.read_text(encoding="utf-8"))


def test_save_writes_to_where_it_came_from(tmp_path):
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
def test_files_that_cannot_be_read_are_named(tmp_path, content, code):
    path = tmp_path / "x.rviz"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(LinkwrightError) as caught:
        RvizConfig.load(path)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == code
    assert str(path) in diagnostic.message or diagnostic.span.file == str(path)


def test_the_first_byte_may_be_a_byte_order_mark(tmp_path):
    path = tmp_path / "x.rviz"
    path.write_bytes(b"\xef\xbb\xbf" + NESTED.encode())
    assert RvizConfig.load(path).displays
