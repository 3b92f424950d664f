"""Changes of the classes that plugin description files export, in a review."""

from __future__ import annotations

from tests.review.conftest import breaking, sentences, subject

PLUGINS = """<library path="arm_hardware">
  <class name="arm/Hardware" type="arm::Hardware" base_class_type="hardware_interface::SystemInterface"/>
  <class name="arm/Gripper" type="arm::Gripper" base_class_type="hardware_interface::SystemInterface"/>
</library>
"""


def test_removed_plugin_class_is_breaking(repository, compare):
    repository.commit({"a/arm_plugins.xml": PLUGINS})
    plugins = PLUGINS.replace('name="arm/Gripper" type="arm::Gripper"', 'name="arm/Hand" type="arm::Hand"')
    repository.commit({"a/arm_plugins.xml": None, "a/plugins/hardware.xml": plugins})
    result = compare(repository, "HEAD~1..HEAD")
    assert breaking(result) == ["plugin class 'arm/Gripper' removed"]
    review_subject = subject(result, "a/plugins/hardware.xml")
    assert sentences(review_subject) == ["plugin class 'arm/Hand' added"]
    assert review_subject.changes[0].location.line == 3


def test_plugin_class_with_another_name_and_the_same_type_is_renamed(repository, compare):
    repository.commit({"a/arm_plugins.xml": PLUGINS})
    repository.write({"a/arm_plugins.xml": PLUGINS.replace('name="arm/Gripper"', 'name="arm/Hand"')})
    assert breaking(compare(repository)) == ["plugin class 'arm/Gripper' renamed to 'arm/Hand'"]


def test_changed_base_class_of_plugin_is_breaking(repository, compare):
    repository.commit({"a/arm_plugins.xml": PLUGINS})
    repository.write({"a/arm_plugins.xml": PLUGINS.replace("SystemInterface", "ActuatorInterface", 1)})
    (sentence,) = breaking(compare(repository))
    interfaces = "hardware_interface::SystemInterface -> hardware_interface::ActuatorInterface"
    assert sentence == f"plugin class 'arm/Hardware': base class {interfaces}"


def test_other_library_of_a_plugin_class_is_a_change(repository, compare):
    repository.commit({"a/arm_plugins.xml": PLUGINS})
    repository.write({"a/arm_plugins.xml": PLUGINS.replace('path="arm_hardware"', 'path="lib/libarm_drivers"')})
    result = compare(repository)
    assert sentences(subject(result, "a/arm_plugins.xml")) == [
        "plugin class 'arm/Hardware': library arm_hardware -> lib/libarm_drivers",
        "plugin class 'arm/Gripper': library arm_hardware -> lib/libarm_drivers",
    ]
    repository.write({"a/arm_plugins.xml": PLUGINS.replace('path="arm_hardware"', 'path="lib/libarm_hardware"')})
    assert compare(repository).subjects == []
