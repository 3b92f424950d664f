"""YAML files that configure robots, in packages and in other folders, and those of other tools."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

PATH = "deploy/lamp.yaml"
SETTINGS = "lamps:\n- name: front\n  brightness: 0.5\nport: /dev/lamp\nmode: slow\n"
READER = 'import yaml\nsettings = yaml.safe_load(open("deploy/lamp.yaml"))\n'


def review_brightness(repository, compare, text, files, path=PATH):
    assert "0.5" in text
    repository.commit({"p/package.xml": PACKAGE_XML, **files, path: text})
    repository.write({path: text.replace("0.5", "0.75")})
    return compare(repository)


@pytest.mark.parametrize(
    ("text", "files"),
    [
        (f"{SETTINGS}state_topic: /lamp/state\n", {}),
        (f"{SETTINGS}display:\n- topic: /lamp/state # shown\n", {}),
        (f"{SETTINGS}camera:\n  frame_id: lamp_camera\n", {}),
        (f"joint_names:\n- pan\n{SETTINGS}", {}),
        (SETTINGS, {"lamps/reader.py": READER}),
        (SETTINGS, {"lamps/reader.py": READER.replace("deploy/", "").replace('open("', 'open(folder / "')}),
        (SETTINGS, {"deploy/rear.yaml": f"{SETTINGS}state_topic: /lamp/state\n"}),
    ],
)
def test_yaml_file_outside_packages_that_configures_a_robot_is_compared(repository, compare, text, files):
    result = review_brightness(repository, compare, text, files)
    assert sentences(subject(result, PATH)) == ["lamps[front].brightness 0.5 -> 0.75"]


@pytest.mark.parametrize(
    ("text", "files"),
    [
        (SETTINGS, {}),
        (f"{SETTINGS}topic: lamps\n", {}),
        (SETTINGS, {"tests/test_lamps.py": READER}),
        (SETTINGS, {"lamps/reader.py": READER.replace("lamp.yaml", "big_lamp.yaml")}),
        (SETTINGS, {"lamps/reader.py": READER.replace("deploy/", ""), "p/config/lamp.yaml": SETTINGS}),
        (SETTINGS, {"deploy/rear.yaml": "state_topic: /lamp/state\nmode: slow\n"}),
        ("- hosts: robots\n  vars:\n    state_topic: /lamp/state\n    share: 0.5\n", {}),
        ("train: images/train\nval: images/val\nshare: 0.5\n", {"lamps/reader.py": READER}),
    ],
)
def test_other_yaml_file_outside_packages_is_another_file(repository, compare, text, files):
    result = review_brightness(repository, compare, text, files)
    assert (result.subjects, result.other_files) == ([], [PATH])


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("p/docker-compose.yml", "services:\n  lamp:\n    cpus: 0.5\n"),
        ("p/mkdocs.yml", "theme: 0.5\n"),
        ("p/docs/site.yml", "site_name: lamps\nwidth: 0.5\n"),
        ("p/environment.yml", "channels: [defaults]\ndependencies: [python=0.5]\n"),
    ],
)
def test_yaml_file_of_another_tool_in_a_package_is_another_file(repository, compare, path, text):
    result = review_brightness(repository, compare, text, {}, path)
    assert (result.subjects, result.other_files) == ([], [path])


def test_text_that_is_yaml_itself_is_compared_as_such(repository, compare):
    text = "nodes:\n- name: lamp\n  config: |\n    # Of the lamp\n    rate: 10\n    topics:\n    - /lamp/state\n"
    repository.commit({"p/package.xml": PACKAGE_XML, "p/config/nodes.yaml": text})
    repository.write({"p/config/nodes.yaml": text.replace("rate: 10", "rate: 20\n    timeout: 0.5")})
    lines = subject(compare(repository), "p/config/nodes.yaml").changes
    assert [(str(line.sentence), line.location.line, line.location.column) for line in lines] == [
        ("nodes[lamp].config.rate 10 -> 20", 5, 11),
        ("nodes[lamp].config.timeout 0.5 added", 6, 14),
    ]


@pytest.mark.parametrize(
    "text", ["node:\n  ros__parameters:\n    robot: |\n      a: 1\n      b: 2\n", "note: |\n  Note: 1\n"]
)
def test_other_texts_of_several_lines_stay_texts(repository, compare, text):
    repository.commit({"p/package.xml": PACKAGE_XML, "p/config/nodes.yaml": text})
    repository.write({"p/config/nodes.yaml": text.replace(": 1", ": 3")})
    (line,) = sentences(subject(compare(repository), "p/config/nodes.yaml"))
    assert ": 1" in line
    assert ": 3" in line
