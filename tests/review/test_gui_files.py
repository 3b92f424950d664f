"""The lines of a review about configurations of Gazebo's window."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/config/gui.config"
CONFIG = """<?xml version="1.0"?>

<window>
  <width>800</width>
</window>
<plugin filename="MinimalScene" name="3D View">
  <gz-gui>
    <property key="x" type="double">0</property>
  </gz-gui>
  <engine>ogre2</engine>
</plugin>
<plugin filename="Teleop">
  <topic>/cmd_vel</topic>
  <gz-gui/>
</plugin>
"""
TELEOP = CONFIG[CONFIG.index('<plugin filename="Teleop"') :]


@pytest.fixture
def review_config(repository, compare):
    def run(old, new):
        repository.commit({"arm/package.xml": PACKAGE_XML, PATH: old})
        repository.write({PATH: new})
        return compare(repository)

    return run


@pytest.mark.parametrize(
    ("old", "new", "expected", "line"),
    [
        ("/cmd_vel", "/manual/cmd_vel", "plugin 'Teleop': topic /cmd_vel -> /manual/cmd_vel", 12),
        (TELEOP, "", "plugins removed: 'Teleop'", 12),
        (TELEOP, TELEOP + TELEOP, "plugins added: 'Teleop 2'", 16),
        ("<engine>ogre2</engine>", "", "plugin 'MinimalScene': engine ogre2 -> ''", 6),
    ],
)
def test_changed_plugins_are_told(review_config, old, new, expected, line):
    (change,) = subject(review_config(CONFIG, CONFIG.replace(old, new)), PATH).changes
    assert (str(change.sentence), change.reason) == (expected, None)
    assert change.location is not None
    assert change.location.line == line


@pytest.mark.parametrize(("old", "new"), [("800", "900"), ('"double">0', '"double">5'), ('"3D View"', '"View"')])
def test_the_layout_of_the_window_is_not_compared(review_config, old, new):
    assert review_config(CONFIG, CONFIG.replace(old, new)).subjects == []


def test_added_and_removed_files(repository, compare):
    repository.commit(
        {"arm/package.xml": PACKAGE_XML, PATH: CONFIG, "arm/model.config": "<model><name>a</name></model>"}
    )
    (repository.root / PATH).unlink()
    repository.write({"arm/config/other.config": TELEOP, "arm/model.config": "<model><name>b</name></model>"})
    result = compare(repository)
    assert sentences(subject(result, "arm/config/other.config")) == [
        "configuration of Gazebo's window added: plugins Teleop"
    ]
    assert breaking(result) == ["configuration of Gazebo's window removed"]
