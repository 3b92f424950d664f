"""The robot description in a recording, or the hash of the recorded robot's description."""

from __future__ import annotations

import hashlib

import yaml

from linkwright.bag.names import METADATA_FILE
from linkwright.bag.parts import INFORMATION_KEY
from linkwright.bag.reading import BagReader
from linkwright.messages import deserialize, get_message

DESCRIPTION_TOPIC = "/robot_description"
DESCRIPTION_TYPE = "std_msgs/msg/String"
HASH_ENTRY = "robot_description_sha256"
"""The entry of a recording's metadata with the hash."""


def hash_description(text: str) -> str:
    """Return the SHA-256 hash of a description's text in hexadecimal."""
    return hashlib.sha256(text.encode()).hexdigest()


def description_from_message(data: bytes | memoryview) -> str:
    """Return the description in a serialized message of `DESCRIPTION_TOPIC`."""
    return str(deserialize(data, get_message(DESCRIPTION_TYPE)).data)


def find_recorded_description(bag: BagReader) -> str | None:
    """Return the last description in a recording, or None if its topic was not recorded.

    Raises:
        LinkwrightError: BAG102, the messages cannot be read.
    """
    if not any(
        topic.name == DESCRIPTION_TOPIC and topic.type_name == DESCRIPTION_TYPE and topic.count for topic in bag.topics
    ):
        return None
    text = None
    for _, _, data in bag.messages([DESCRIPTION_TOPIC]):
        text = description_from_message(data)
    return text


def find_recorded_hash(bag: BagReader) -> str | None:
    """Return the hash of the description of a recording, or None if it is not known.

    Raises:
        LinkwrightError: BAG102, the messages cannot be read.
    """
    text = find_recorded_description(bag)
    if text is not None:
        return hash_description(text)
    path = bag.path / METADATA_FILE
    try:
        information = yaml.safe_load(path.read_text(encoding="utf-8"))[INFORMATION_KEY]
        value = (information.get("custom_data") or {}).get(HASH_ENTRY)
    except (OSError, ValueError, LookupError, TypeError, AttributeError, yaml.YAMLError):
        return None
    return value if isinstance(value, str) else None
