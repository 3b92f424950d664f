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


CPP_SENDER = """void Arm::send(const Image & image)
{
  Stamped msg;
  msg.header.frame_id = frame_;
  pub_->publish(msg);
  while (busy_) {
    auto msg = arm::msg::Stamped();
    msg.header.frame_id = frame_;
    msg.speed = image.speed;
    pub_->publish(msg);
  }
}
"""
PYTHON_SENDER = """class Arm:
    def send(self):
        msg = Stamped()
        msg.header.frame_id = self.frame
        self.pub.publish(msg)
"""
CPP_FRAME, PYTHON_FRAME = "    msg.header.frame_id = frame_;\n", "        msg.header.frame_id = self.frame\n"
LOST = "frame_id of 'msg' is no longer set"


@pytest.mark.parametrize(
    ("text", "old", "new", "is_lost"),
    [
        (CPP_SENDER, CPP_FRAME, "", True),
        (CPP_SENDER, CPP_FRAME, "    msg.header.stamp = now();\n", True),
        (CPP_SENDER, CPP_FRAME, "    msg.header = image.header;\n", False),
        (CPP_SENDER, CPP_FRAME, "    fill(image, msg);\n", False),
        (CPP_SENDER, f"arm::msg::Stamped();\n{CPP_FRAME}", "make(image.header);\n", False),
        (CPP_SENDER, f"{CPP_FRAME}    msg.speed = image.speed;\n    pub_->publish(msg);\n", "", False),
        (PYTHON_SENDER, PYTHON_FRAME, "", True),
        (PYTHON_SENDER, PYTHON_FRAME, "        self.fill(msg)\n", False),
        (PYTHON_SENDER, f"Stamped()\n{PYTHON_FRAME}", "Stamped(header=self.header)\n", False),
        (PYTHON_SENDER, PYTHON_FRAME, "        msg = self.convert(msg)\n", False),
    ],
)
def test_published_message_without_its_frame_is_breaking(repository, compare, text, old, new, is_lost):
    path = "arm/arm/arm.py" if text is PYTHON_SENDER else "arm/src/arm.cpp"
    repository.commit({**MANIFEST, path: text})
    repository.write({path: text.replace(old, new)})
    assert text.count(old) == 1
    assert (LOST in breaking(compare(repository))) is is_lost


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ('m.header.frame_id = "map";', "m.header = image.header;",
         "frame_id of 'm': \"map\" -> image.header.frame_id", True),
        ("m.header.frame_id = image.header.frame_id;", "m.header = image.header;", None, False),
        ("m.header = image.header;", "m.header = info.header;",
         "frame_id of 'm': image.header.frame_id -> info.header.frame_id", False),
        ('m.header.frame_id = prefix() + "/" + frame_;', "m.header.frame_id = prefix();",
         "frame_id of 'm': prefix() + \"/\" + frame_ -> prefix()", False),
        ('m.header.frame_id = "map";', "m.header.frame_id = frame_;", None, False),  # a parameter may give the same
    ],
)  # fmt: skip
def test_frames_of_whole_headers_and_of_expressions(repository, compare, old, new, expected, is_breaking):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": CPP.format(old)})
    repository.write({"arm/src/arm.cpp": CPP.format(new)})
    result = compare(repository)
    lines = [line for subject in result.subjects for line in sentences(subject) if line.startswith("frame_id of")]
    assert lines == ([expected] if expected else [])
    assert breaking(result) == (lines if is_breaking else [])


TWO = """void Arm::send(const Image & image) {{
  m.header.frame_id = "{}"; {}
  send(m);
  n.header.frame_id = "{}";
  send(n);
}}
void Arm::stop() {{ k.header.frame_id = "odom"; l.header.frame_id = "map"; }}
"""


@pytest.mark.parametrize(
    ("child", "is_breaking"),
    [("", True), ('m.child_frame_id = "tool";', False)],  # the parent of a transform is no frame of data
)
def test_another_literal_frame_that_the_source_also_had_is_told(repository, compare, child, is_breaking):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": TWO.format("odom", child, "base")})
    repository.write({"arm/src/arm.cpp": TWO.format("map", child, "base")})
    result = compare(repository)
    expected = ['frame_id of \'m\': "odom" -> "map"']
    assert [line for subject in result.subjects for line in sentences(subject)] == expected
    assert breaking(result) == (expected if is_breaking else [])


ODOMETRY = """class Drive(Node):
    def step(self):
        odom = Odometry()
        odom.header.frame_id = "wheel_odom"
        odom.child_frame_id = self.base
        odom.pose.pose.position.x = self.x
        self.pub.{}(odom)
"""


@pytest.mark.parametrize(("method", "is_breaking"), [("publish", True), ("keep", False)])
@pytest.mark.parametrize("is_known", [True, False])
def test_another_literal_frame_of_a_published_message_is_one_line(repository, compare, method, is_breaking, is_known):
    other = {"arm/arm/map.py": 'def fill(m):\n    m.header.frame_id = "odom"\n'} if is_known else {}
    text = (
        f"{ODOMETRY.format(method)}\n    def open(self):\n        self.pub = self.create_publisher(Odometry, 'o', 9)\n"
    )
    repository.commit({**MANIFEST, **other, "arm/arm/drive.py": text})
    repository.write({"arm/arm/drive.py": text.replace("wheel_odom", "odom")})
    result = compare(repository)
    (line,) = [line for subject in result.subjects for line in sentences(subject)]
    if is_known:
        assert line == "frame_id of 'odom': 'wheel_odom' -> 'odom'"
        assert breaking(result) == [line] * is_breaking
    else:
        assert line == "frame of messages 'wheel_odom' renamed to 'odom'"


MEMBERS = """class Arm : public Node {{
  void start() {{ n->header.frame_id{}; {}
  }}
  void send() {{
    m->header.frame_id = {};
    pub_->{}(m);
  }}
}};
"""


@pytest.mark.parametrize(
    ("old_use", "default", "variable", "method", "is_breaking"),
    [
        (" = frame_", "", "frame_", "publish", True),
        (".assign(frame_)", "", "frame_", "publish", True),
        (' = "x"', "", "frame_", "publish", False),  # a new member, which a parameter may set
        (" = frame_", 'frame_ = "base";', "frame_", "publish", False),
        (" = frame", "", "frame", "publish", False),
        (" = frame_", "", "frame_", "keep", False),
    ],
)
def test_literal_frame_that_becomes_a_frame_of_a_member(
    repository, compare, old_use, default, variable, method, is_breaking
):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": MEMBERS.format(old_use, default, '"base"', method)})
    repository.write({"arm/src/arm.cpp": MEMBERS.format(old_use, default, variable, method)})
    expected = ["frame_id of 'm': \"base\" -> frame_"] if is_breaking else []
    assert breaking(compare(repository)) == expected
