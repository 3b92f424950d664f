"""The names of interfaces: ``sensor_msgs/msg/JointState``, and the Python and file names made of them."""

from __future__ import annotations

from typing import NamedTuple

KINDS = ("msg", "srv", "action")


class InterfaceName(NamedTuple):
    """An interface's name in its parts; `kind` is None where the text left it out (``sensor_msgs/JointState``)."""

    package: str
    kind: str | None
    name: str

    def __str__(self) -> str:
        return "/".join(part for part in self if part)


def split_name(text: str) -> InterfaceName | None:
    """The parts of ``package/kind/Name`` or ``package/Name``; None when the text is neither."""
    parts = text.split("/")
    if len(parts) == 3 and parts[1] in KINDS:
        package, kind, name = parts
    elif len(parts) == 2:
        package, name = parts
        kind = None
    else:
        return None
    return InterfaceName(package, kind, name) if is_package_name(package) and is_interface_name(name) else None


def is_package_name(text: str) -> bool:
    """Whether a package of interfaces may have this name (lower case, digits, single underscores)."""
    return _is_words(text) and text == text.lower()


def is_interface_name(text: str) -> bool:
    """Whether an interface may have this name (CamelCase); parts made by rosidl, as ``SetBool_Request``, too."""
    return text.isascii() and all(part.isalnum() and part[0].isupper() for part in text.split("_"))


def is_field_name(text: str) -> bool:
    """Whether a field may have this name (lower case, digits, single underscores)."""
    return is_package_name(text)


def is_constant_name(text: str) -> bool:
    """Whether a constant may have this name (upper case, digits, single underscores)."""
    return _is_words(text) and text == text.upper()


def _is_words(text: str) -> bool:
    # Not regular expressions: compiling them takes longer than all names of a process.
    return text.isascii() and text[:1].isalpha() and all(word.isalnum() for word in text.split("_"))


def snake_case(name: str) -> str:
    """The module name of an interface: ``JointState`` gives ``joint_state``, ``TFMessage`` ``tf_message`` (rosidl)."""
    words: list[str] = []
    for at, letter in enumerate(name):
        if letter.isupper() and at:
            before, after = name[at - 1], name[at + 1 : at + 2]
            if before.islower() or before.isdigit() or after.islower():
                words.append("_")
        words.append(letter.lower())
    return "".join(words)


def python_module(type_name: str) -> str:
    """The module that rosidl_generator_py puts a class into: ``std_srvs.srv._set_bool`` for all of SetBool's."""
    package, kind, name = type_name.split("/")
    return f"{package}.{kind}._{snake_case(name.split('_')[0])}"
