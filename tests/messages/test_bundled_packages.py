"""The types of the packages that come with Linkwright."""

from __future__ import annotations

import pytest

from linkwright.messages import catalog, get_interface
from linkwright.messages.definitions.library import Library


@pytest.mark.parametrize("package", catalog.list_packages())
def test_all_types_of_a_package_refer_to_types_that_exist(package):
    for name in catalog.read_texts(package):
        get_interface(f"{package}/{name}")


def test_services_of_jsk_have_fields_of_other_packages():
    request = Library().definition("jsk_recognition_msgs/srv/SnapFootstep_Request")
    assert [field.name for field in request.fields] == ["input"]
    clusters = Library().definition("jsk_recognition_msgs/msg/ClusterPointIndices")
    assert [field.name for field in clusters.fields] == ["header", "cluster_indices"]
