"""Templates from which programs make launch files, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/launch/core.em"
TEMPLATE = """<launch>
  <arg name="speed" default="@(speed)"/>
  <node pkg="arm" type="driver" name="driver"{}>
    <param name="speed" value="$(arg speed)"/>
  </node>
</launch>
"""
BROKEN = TEMPLATE.format("").replace("<node", '@[if eye]<node name="<"@[end if]').format("")


def review(repository, compare, old: str, new: str):
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: old})
    repository.write({PATH: new})
    return compare(repository)


def test_actions_of_a_template_are_compared(repository, compare):
    result = review(repository, compare, TEMPLATE.format(""), TEMPLATE.format(' output="screen"'))
    assert sentences(subject(result, PATH)) == ["node 'arm/driver': output screen added"]


def test_argument_that_a_template_uses_without_declaring_it_is_breaking(repository, compare):
    result = review(repository, compare, TEMPLATE.format(""), TEMPLATE.format(' output="$(arg output)"'))
    assert breaking(result) == ["node 'arm/driver' uses argument 'output', which is not declared"]
    ((_, change),) = result.breaking_changes
    assert str(change.reason) == "the launch file fails"


@pytest.mark.parametrize("new", [BROKEN, "@(text)\n"])
def test_template_that_is_not_xml_is_not_compared(repository, compare, new):
    result = review(repository, compare, TEMPLATE.format(""), new)
    assert [found.path for found in result.subjects] == []
    assert result.other_files == [PATH]


INCLUDE = """<include file="$(find arm)/launch/part.launch"><arg name="eye" value="{}"/></include>
"""
PART = '<launch><arg name="eye" default="false"/><node pkg="arm" type="eye" name="eye" if="$(arg eye)"/></launch>\n'


def test_argument_of_ros1_that_only_the_included_file_declares_is_undeclared(repository, compare):
    old = TEMPLATE.format("").replace("</launch>", INCLUDE.format("true") + "</launch>")
    repository.commit({"arm/launch/part.launch": PART})
    result = review(repository, compare, old, old.replace('"true"', '"$(arg eye)"'))
    (sentence,) = breaking(result)
    assert sentence.endswith("uses argument 'eye', which is not declared")
