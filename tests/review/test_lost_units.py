"""Units of systemd that are gone, or start another program or with other names."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

PATH = "arm/services/arm.service"
UNIT = "[Unit]\nDescription=Arm\n[Service]\nExecStart=/bin/bash -c 'source setup.bash && {}'\n"
COMMAND = "rosrun arm driver _rate:=5 __ns:=left image:=front/image"
REASON = "if the node publishes or serves '{}', programs that use it do not find it"


def test_removed_unit_is_breaking(repository, compare):
    repository.commit({PATH: UNIT.format(COMMAND)})
    repository.commit({PATH: None})
    result = compare(repository, "HEAD~..HEAD")
    assert breaking(result) == [f"systemd unit removed: `{COMMAND}`"]
    (change,) = [change for _, change in result.breaking_changes]
    assert str(change.reason) == "computers that enable 'arm.service' do not find it"


@pytest.mark.parametrize(
    ("old", "new", "expected", "reason"),
    [
        ("arm driver", "arm pose", "starts arm/pose instead of arm/driver",
         "the topics and services of arm/driver are missing"),
        ("ns:=left", "ns:=right", "namespace left -> right", "programs that use names in 'left' do not find them"),
        (" __ns:=left", "", "namespace left -> /", "programs that use names in 'left' do not find them"),
        ("front/image", "rear/image", "remapping image: front/image -> rear/image", REASON.format("front/image")),
        ("front/image", "front/image state:=status", "remapping state: - -> status", REASON.format("state")),
    ],
)  # fmt: skip
def test_other_program_or_name_of_a_unit_is_breaking(repository, compare, old, new, expected, reason):
    text = UNIT.format(COMMAND)
    repository.commit({PATH: text})
    repository.write({PATH: text.replace(old, new)})
    result = compare(repository)
    assert [(str(change.sentence), str(change.reason)) for _, change in result.breaking_changes] == [(expected, reason)]
    lines = sentences(subject(result, PATH))
    assert any(" -> " in line and line != expected for line in lines)


@pytest.mark.parametrize(("old", "new"), [("rate:=5", "rate:=9"), ("Description=Arm", "Description=Arms")])
def test_other_values_of_a_unit_are_not_breaking(repository, compare, old, new):
    text = UNIT.format(COMMAND)
    repository.commit({PATH: text})
    repository.write({PATH: text.replace(old, new)})
    result = compare(repository)
    assert breaking(result) == []
    assert result.other_files == [PATH]
