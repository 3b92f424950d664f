"""The lines of a review about declared attributes of Python classes, and about data classes."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/arm/models.py"
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/setup.py": "from setuptools import setup\nsetup(name='arm', packages=['arm'])\n",
    "arm/arm/__init__.py": "",
    "arm/arm/base.py": "class Base:\n    speed: int = 1\n",
}
REMOVED = "public members removed: 'Arm.speed'"


def review_module(repository, compare, old, new, **others):
    repository.commit({**FILES, PATH: old, **{f"arm/arm/{name}.py": text for name, text in others.items()}})
    repository.write({PATH: new})
    return compare(repository)


@pytest.mark.parametrize(
    ("head", "base", "expected"),
    [
        ("", "object", [REMOVED]),
        ("from .base import Base\n\n\n", "Base", []),  # the base class has it
        ("from other.models import Model\n\n\n", "Model", []),  # may only replace a default of the base class
    ],
)
def test_a_removed_annotated_attribute_is_breaking_unless_a_base_class_may_have_it(
    repository, compare, head, base, expected
):
    text = f"{head}class Arm({base}):\n    name: str = 'arm'\n    speed: int = 2\n"
    result = review_module(repository, compare, text, text.replace("    speed: int = 2\n", ""))
    assert breaking(result) == expected


def test_an_attribute_that_a_module_of_the_package_reads_belongs_to_the_class(repository, compare):
    text = "from other.models import Model\n\n\nclass Arm(Model):\n    name: str = 'arm'\n    speed: int = 2\n"
    user = "def drive(arm):\n    return arm.speed * 2\n"
    result = review_module(repository, compare, text, text.replace("speed:", "force:"), user=user)
    assert breaking(result) == [REMOVED]
    (change,) = [change for _, change in result.breaking_changes]
    assert str(change.reason) == "programs that set or read 'Arm.speed' fail"


@pytest.mark.parametrize("decorator", ["property", "cached_property", "functools.cached_property"])
@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ("    def speed(self):\n        return 2\n", "public member 'Arm.speed' renamed to 'Arm.speeds'"),
        ("    def __init__(self):\n        self.speeds = 2\n", REMOVED),
        ("    def __init__(self):\n        self.speed = 2\n", None),
    ],
)
def test_a_removed_property_is_breaking(repository, compare, decorator, new, expected):
    text = f"class Arm:\n    @{decorator}\n    def _a(self):\n        return 1\n\n    @{decorator}\n"
    new_text = new.replace("def speed(", "def speeds(")
    new_text = (text + new_text) if "speeds(" in new_text else text.rpartition("    @")[0] + new_text
    result = review_module(repository, compare, text + "    def speed(self):\n        return 2\n", new_text)
    assert breaking(result) == ([] if expected is None else [expected])


@pytest.mark.parametrize("new", ["self.speed = 2", "self.speed: int = 2"])
def test_an_attribute_that_the_constructor_sets_now_is_no_change(repository, compare, new):
    text = "class Arm:\n    name: str = 'arm'\n    {}\n    def __init__(self):\n        {}\n"
    result = review_module(repository, compare, text.format("speed: int", "self.speed = 1"), text.format("", new))
    assert breaking(result) == []


def test_renamed_and_private_attributes(repository, compare):
    old = "class Arm:\n    max_speed: int = 2\n    _count: int = 0\n"
    new = "class Arm:\n    max_speeds: int = 2\n    _number: int = 0\n    gain: float = 1.0\n"
    result = review_module(repository, compare, old, new)
    assert sentences(subject(result, PATH))[:2] == [
        "public member 'Arm.max_speed' renamed to 'Arm.max_speeds'",
        "public members added: 'Arm.gain'",
    ]
    assert len(breaking(result)) == 1


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("speed: int = 1", "", "(name, speed=1) -> (name)"),
        ("speed: int", "force: int", "(name, speed) -> (name, force)"),
        ("speed: int = 1", "speed: int", "(name, speed=1) -> (name, speed)"),
        ("speed: list = field(default_factory=list)", "", "(name, speed=list()) -> (name)"),
        ("speed: int = field(init=False)", "", None),
        ("speed: ClassVar[int] = 1", "", None),
    ],
)
@pytest.mark.parametrize(
    "head", ["@dataclass\nclass Arm:", "@dataclasses.dataclass(frozen=True)\nclass Arm:", "class Arm(NamedTuple):"]
)
def test_the_fields_of_a_data_class_are_its_arguments(repository, compare, head, old, new, expected):
    text = f"{head}\n    name: str\n    {{}}\n"
    result = review_module(repository, compare, text.format(old), text.format(new))
    assert breaking(result) == ([] if expected is None else [f"class 'Arm': arguments {expected}"])


def test_data_classes_with_other_options_or_base_classes_have_uncertain_arguments(repository, compare):
    text = "@dataclass(kw_only=True)\nclass Arm:\n    name: str\n    {0}\n\n\n@dataclass\nclass Leg(Part):\n    {0}\n"
    result = review_module(repository, compare, text.format("speed: int"), text.format("force: int"))
    assert not any("arguments" in sentence for sentence in breaking(result))
