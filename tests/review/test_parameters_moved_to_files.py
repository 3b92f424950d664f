"""Parameters of nodes that move from a launch file into a parameter file, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

OLD = '<launch><node pkg="lamp" type="lamp" name="lamp"><param name="~rate" value="30"/></node></launch>\n'
LOADING = '<rosparam command="load" file="$(find lamp)/config/lamp.yaml"/>'
NEW = OLD.replace('<param name="~rate" value="30"/>', LOADING)
PATH = "lamp/launch/lamp.launch"
LOADED = "node 'lamp/lamp': parameters [$(find lamp)/config/lamp.yaml] added"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("rate: 10.0\n", ["node 'lamp/lamp': parameter ~rate 30 -> 10.0 (config/lamp.yaml)"]),
        ("rate: 30.0\n", []),
        ("level: 1\n", ["node 'lamp/lamp': parameter ~rate 30 removed"]),
    ],
)
def test_a_parameter_that_moves_into_a_file_is_compared(repository, compare, text, told):
    manifest = PACKAGE_XML.replace("arm_description", "lamp")
    repository.commit({"lamp/package.xml": manifest, "lamp/config/other.yaml": "a: 1\n", PATH: OLD})
    repository.write({"lamp/config/lamp.yaml": text, PATH: NEW})
    assert sentences(subject(compare(repository), PATH)) == [LOADED, *told]
