"""The types of parameters of well-known nodes and plugins in reviews of parameter files."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

PATH = "arm/config/nav.yaml"
NAVIGATOR = "bt_navigator:\n  ros__parameters:\n    default_server_timeout: {}\n"
CONTROLLER = """controller_server:
  ros__parameters:
    FollowPath:
      plugin: {}
      max_vel_x: {}
"""
DWB = "dwb_core::DWBLocalPlanner"
REASON = "a node that declares the parameter as {} does not accept {}"


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (NAVIGATOR.format("20.0"), NAVIGATOR.format("20"), None),
        (NAVIGATOR.format("20"), NAVIGATOR.format("20.0"), REASON.format("integer", "double")),
        (
            NAVIGATOR.replace("bt_", "my_").format("20.0"),
            NAVIGATOR.replace("bt_", "my_").format("20"),
            REASON.format("double", "integer"),
        ),
        (CONTROLLER.format(DWB, "1"), CONTROLLER.format(DWB, "1.0"), None),
        (CONTROLLER.format(DWB, "1.0"), CONTROLLER.format(DWB, "1"), REASON.format("double", "integer")),
        (CONTROLLER.format("my::Own", "1"), CONTROLLER.format("my::Own", "1.0"), REASON.format("integer", "double")),
    ],
)
def test_the_type_that_a_well_known_node_or_plugin_declares_is_not_breaking(repository, compare, old, new, reason):
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: old})
    repository.write({PATH: new})
    (change,) = subject(compare(repository), PATH).changes
    assert (None if change.reason is None else str(change.reason)) == reason
