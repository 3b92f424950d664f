"""The lines of a review about messages that get the frame of another message or variable."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CPP = "void Arm::handle(const Image & image, const Info & info) {{\n  {}\n  use(image, info);\n}}\n"
PYTHON = """class Arm:
    def handle(self, image):
        if self.is_ready:
            marker.header.frame_id = {}
        else:
            marker.header.frame_id = {}
        self.use(image)
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            "m.header.frame_id = image.header.frame_id;",
            "m.header.frame_id = info.header.frame_id;",
            ["frame_id of 'm': image.header.frame_id -> info.header.frame_id"],
        ),
        (
            "m->header.frame_id = frame_;  n.header.frame_id = frame_;",
            "m->header.frame_id = image.header.frame_id;  n.header.frame_id = image.header.frame_id;",
            ["frame_id of 'm', 'n': frame_ -> image.header.frame_id"],
        ),
        ("m.header.frame_id = frame_;", "m.header.frame_id = params_.frame;", []),  # may be the same frame
        ("m.header.frame_id = image.header.frame_id;", "m.header.frame_id = picture.header.frame_id;", []),
        ("m.header.frame_id = image.header.frame_id;", "m.header.frame_id = image.header.frame_id; m.x = 1;", []),
    ],
)
def test_messages_with_the_frame_of_something_else_in_cpp(repository, compare, old, new, expected):
    texts = [CPP.format(text) for text in (old, new)]
    if "picture" in new:
        texts[1] = texts[1].replace("image", "picture")
    repository.commit({**MANIFEST, "arm/src/arm.cpp": texts[0]})
    repository.write({"arm/src/arm.cpp": texts[1]})
    result = compare(repository)
    lines = [line for subject in result.subjects for line in sentences(subject)]
    assert [line for line in lines if line.startswith("frame_id of")] == expected
    assert not breaking(result)


def test_messages_with_the_frame_of_something_else_in_python(repository, compare):
    image = "image.header.frame_id"
    repository.commit({**MANIFEST, "arm/arm/arm.py": PYTHON.format(image, image)})
    repository.write({"arm/arm/arm.py": PYTHON.format("self.frame", "self.info.header.frame_id")})
    (subject,) = compare(repository).subjects
    assert sentences(subject)[0] == (
        "frame_id of 'marker': image.header.frame_id -> self.frame | self.info.header.frame_id"
    )
