"""The line of a review about RViz configurations that use lost classes of plugins."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

PLUGINS = """<library path="displays">
  <class name="arm/Load" type="arm::Load" base_class_type="rviz_common::Display"/>
</library>
"""
CONFIGURATION = "Visualization Manager:\n  Displays:\n    - Class: arm/Load\n      Name: Load\n    - Class: rviz/Grid\n"
EXPORT = "pluginlib_export_plugin_description_file(rviz_common plugins.xml)\n"
LINE = "uses the class 'arm/Load', which no plugin description declares any more"


@pytest.mark.parametrize(
    ("export", "new", "configuration", "is_lost"),
    [
        (EXPORT, PLUGINS.replace("arm/Load", "arm/LoadDisplay"), CONFIGURATION, True),
        (EXPORT, PLUGINS.replace("arm/Load", "arm/LoadDisplay"), CONFIGURATION.replace("arm/Load", "arm/Loads"), False),
        (EXPORT, PLUGINS.replace("arm::Load", "arm::Loads"), CONFIGURATION, False),
        ("", PLUGINS.replace("arm/Load", "arm/LoadDisplay"), CONFIGURATION, False),
    ],
)
def test_a_configuration_with_a_lost_class_is_named(repository, compare, export, new, configuration, is_lost):
    files = {
        "arm/package.xml": PACKAGE_XML,
        "arm/CMakeLists.txt": f"project(arm)\n{export}",
        "arm/plugins.xml": PLUGINS,
        "arm/rviz/arm.rviz": configuration,
    }
    repository.commit(files)
    repository.write({"arm/plugins.xml": new})
    assert (LINE in breaking(compare(repository))) is is_lost
