"""Rules about the names of links and joints: characters, case, spaces and repetitions."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase, term
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.xmltree import Element

_USUAL_CHARACTERS = lazy_pattern(r"[A-Za-z0-9_./\- ]*")
_REPEATED_SUFFIX = lazy_pattern(r"(?:^|.*[_-])(link|joint|frame)[_-]\1$", re.IGNORECASE)


def iterate_named_elements(subject: Subject) -> Iterator[tuple[str, str, Element]]:
    """Yield the kind, name and element of every named link and joint, in source order."""
    for kind in ("link", "joint"):
        for element in subject.elements(kind):
            name = element.attributes.get("name", "")
            if name:
                yield kind, name, element


class NameEdgeBlank(Rule):
    """The name of a link or joint begins or ends with a space.

    ## Why

    The space is part of the name. A parent, a transform lookup or a joint state without the space refers to another
    link or joint, and the difference is invisible.

    ## Example

    ```xml
    <link name="base_link "/>
    ```

    ## Use instead

    ```xml
    <link name="base_link"/>
    ```
    """

    code = "LW601"
    name = "name-edge-blank"
    holds_for_parts = True
    severity = Severity.ERROR

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for kind, name, element in iterate_named_elements(subject):
            if name != name.strip():
                message = phrase(
                    "the name of the {kind} '{name}' begins or ends with a space", kind=term(kind), name=name
                )
                yield self.report(
                    message, element, "name", hint=phrase("write '{name}' in all places", name=name.strip())
                )


class NameBlank(Rule):
    """The name of a link or joint contains a space.

    ## Why

    Names of links and joints become names of frames, parameters and topics, and arguments on command lines. There,
    spaces cause problems or are not allowed.

    ## Example

    ```xml
    <link name="left wheel"/>
    ```

    ## Use instead

    ```xml
    <link name="left_wheel"/>
    ```
    """

    code = "LW602"
    name = "name-blank"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for kind, name, element in iterate_named_elements(subject):
            stripped = name.strip()
            if re.search(r"\s", stripped):
                hint = phrase("write '{name}' in all places", name=re.sub(chr(92) + "s+", "_", stripped))
                yield self.report(
                    phrase("the name of the {kind} '{name}' contains a space", kind=term(kind), name=name),
                    element,
                    "name",
                    hint=hint,
                )


class NameLeadingSlash(Rule):
    """The name of a link begins with a slash.

    ## Why

    tf2, the transform library of ROS 2, refuses names of frames that begin with a slash, so this link can never be
    looked up. The slash was customary in the first version of tf.

    ## Example

    ```xml
    <link name="/base_link"/>
    ```

    ## Use instead

    ```xml
    <link name="base_link"/>
    ```

    To distinguish several robots, set the parameter `frame_prefix` of robot_state_publisher.
    """

    code = "LW603"
    name = "name-leading-slash"
    holds_for_parts = True
    severity = Severity.ERROR

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for kind, name, element in iterate_named_elements(subject):
            if kind == "link" and name.startswith("/"):
                message = phrase("the name of the link '{name}' begins with a slash, which tf2 refuses", name=name)
                yield self.report(
                    message, element, "name", hint=phrase("write '{name}' in all places", name=name.lstrip("/"))
                )


class NameNotAscii(Rule):
    """The name of a link or joint has a non-ASCII letter.

    ## Why

    Names of topics and parameters in ROS 2 are ASCII. Names with letters that look like others, such as a Cyrillic `a`
    or a full-width underscore, are hard to type.

    ## Example

    ```xml
    <link name="räder_link"/>
    ```

    ## Use instead

    ```xml
    <link name="wheels_link"/>
    ```
    """

    code = "LW604"
    name = "name-not-ascii"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for kind, name, element in iterate_named_elements(subject):
            non_ascii = sorted({character for character in name if not character.isascii()})
            if non_ascii:
                characters_text = ", ".join(f"'{character}' (U+{ord(character):04X})" for character in non_ascii)
                message = phrase(
                    "the name of the {kind} '{name}' contains non-ASCII letters: {characters}",
                    kind=term(kind),
                    name=name,
                    characters=characters_text,
                )
                yield self.report(message, element, "name", hint=phrase("use letters a to z, digits and underscores"))


class NameUnusualCharacter(Rule):
    """A name has a character other than letters, digits, underscores, dashes, dots and slashes.

    ## Why

    Brackets, quotes, colons and similar characters have a meaning on command lines, in YAML and in the names of topics
    and parameters. A name with such a character works in one tool and fails in another.

    ## Example

    ```xml
    <joint name="wheel(left)" type="continuous"/>
    ```

    ## Use instead

    ```xml
    <joint name="left_wheel_joint" type="continuous"/>
    ```
    """

    code = "LW605"
    name = "name-unusual-character"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for kind, name, element in iterate_named_elements(subject):
            unusual = sorted(
                {character for character in name if character.isascii() and not _USUAL_CHARACTERS.fullmatch(character)}
            )
            if unusual and "${" not in name and "$(" not in name and not any(sign.isspace() for sign in unusual):
                message = phrase(
                    "the name of the {kind} '{name}' contains unusual characters: {characters}",
                    kind=term(kind),
                    name=name,
                    characters=" ".join(unusual),
                )
                yield self.report(message, element, "name", hint=phrase("use letters a to z, digits and underscores"))


class NameUpperCase(Rule):
    """The name of a link or joint has upper case letters or dashes.

    ## Why

    REP 144 requires lower case and underscores in the names of packages, and the frames of REP 103, 105 and 120 follow
    the same style. Names in one style are easier to remember. Pedantic: the joints of many arms are named after the
    axes in the manufacturer's documentation.

    ## Example

    ```xml
    <link name="LeftWheel"/>
    ```

    ## Use instead

    ```xml
    <link name="left_wheel"/>
    ```
    """

    code = "LW606"
    name = "name-upper-case"
    holds_for_parts = True
    default = False

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for kind, name, element in iterate_named_elements(subject):
            if name != name.lower() or "-" in name:
                snake_case = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).replace("-", "_").lower()
                message = phrase(
                    "the name of the {kind} '{name}' is not in lower case with underscores", kind=term(kind), name=name
                )
                yield self.report(
                    message,
                    element,
                    "name",
                    hint=phrase("write it in lower case with underscores: '{snake}'", snake=snake_case),
                )


class NamesDifferInCase(Rule):
    """Two links or two joints have names that differ only in upper and lower case.

    ## Why

    ROS distinguishes the two names, but readers hardly do, so one is easily used in place of the other. Gazebo, and the
    file systems of Windows and macOS, do not distinguish them.

    ## Example

    ```xml
    <link name="camera_link"/>
    <link name="Camera_link"/>
    ```

    ## Use instead

    ```xml
    <link name="front_camera_link"/>
    <link name="rear_camera_link"/>
    ```
    """

    code = "LW607"
    name = "names-differ-in-case"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        first_elements: dict[tuple[str, str], tuple[str, Element]] = {}
        for kind, name, element in iterate_named_elements(subject):
            first_name, first_element = first_elements.setdefault((kind, name.casefold()), (name, element))
            if first_name != name:
                message = phrase(
                    "the {kind}s '{first_name}' and '{name}' differ only in upper and lower case",
                    kind=term(kind),
                    first_name=first_name,
                    name=name,
                )
                note = Note(phrase("'{name}' is defined here", name=first_name), first_element.attribute_span("name"))
                yield self.report(message, element, "name", notes=[note], hint=phrase("give one of them another name"))


class NameSuffixDoubled(Rule):
    """The name of a link or joint ends with the same word twice, such as ``_link_link``.

    ## Why

    A macro appends `_link` to a parameter that already ends with `_link`. The name works, but is easily misspelled.

    ## Example

    ```xml
    <xacro:camera name="camera_link"/>  <!-- the macro writes <link name="${name}_link"> -->
    ```

    ## Use instead

    ```xml
    <xacro:camera name="camera"/>
    ```
    """

    code = "LW608"
    name = "name-suffix-doubled"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for kind, name, element in iterate_named_elements(subject):
            match = _REPEATED_SUFFIX.fullmatch(name)
            if match:
                message = phrase(
                    "the name of the {kind} '{name}' ends with '{suffix}' twice",
                    kind=term(kind),
                    name=name,
                    suffix=match[1],
                )
                suggestion = name[: -len(match[1]) - 1]
                yield self.report(message, element, "name", hint=phrase("write '{text}'", text=suggestion))
