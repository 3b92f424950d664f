"""Rules about names that joints share with links, and about the name of the robot."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, phrase
from linkwright.lint.fix import replace_value
from linkwright.lint.rule import Rule
from linkwright.lint.rules.names_text import iterate_named_elements
from linkwright.lint.subject import Subject


class JointNameIsLinkName(Rule):
    """A joint and a link have the same name.

    ## Why

    URDF allows the same name, but Gazebo converts the description to SDF. In SDF, all parts of a model must have
    different names, so Gazebo refuses or renames parts with the same name.

    ## Example

    ```xml
    <link name="left_wheel"/>
    <joint name="left_wheel" type="continuous">
    ```

    ## Use instead

    ```xml
    <link name="left_wheel_link"/>
    <joint name="left_wheel_joint" type="continuous">
    ```
    """

    code = "LW609"
    name = "joint-name-is-link-name"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        links = {name: element for kind, name, element in iterate_named_elements(subject) if kind == "link"}
        for kind, name, element in iterate_named_elements(subject):
            if kind == "joint" and name in links:
                note = Note(phrase("the link is defined here"), links[name].attribute_span("name"))
                hint = phrase("name the joint '{name}_joint'", name=name.removesuffix("_link"))
                message = phrase("a joint and a link are both named '{name}', which SDF does not allow", name=name)
                yield self.report(message, element, "name", notes=[note], hint=hint)


class RobotNameUnusual(Rule):
    """The name of the robot has spaces or other characters that ROS names do not allow.

    ## Why

    Tools derive file names, namespaces and parameter names from the robot's name, such as the name of the package that
    MoveIt's Setup Assistant generates, and of the model in Gazebo. Pedantic: nothing in ROS looks up robots by name.

    ## Example

    ```xml
    <robot name="My Robot (v2)">
    ```

    ## Use instead

    ```xml
    <robot name="my_robot_v2">
    ```
    """

    code = "LW611"
    name = "robot-name-unusual"
    default = False

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        name = subject.root.attributes.get("name", "")
        if not name or re.fullmatch(r"[A-Za-z0-9_\-]+", name):
            return
        suggestion = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
        hint = (
            phrase("use a name such as '{suggestion}'", suggestion=suggestion)
            if suggestion
            else phrase("use letters a to z, digits and underscores")
        )
        fix = replace_value(subject.root, "name", suggestion, safe=False) if suggestion else None
        message = phrase("the name of the robot '{name}' has characters that ROS names do not allow", name=name)
        yield self.report(message, subject.root, "name", hint=hint, fix=fix)
