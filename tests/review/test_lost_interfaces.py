"""The lines of a review about sources that use removed interfaces, fields and constants."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking

MANIFEST = "<package><name>{name}</name><version>1.0.0</version></package>\n"
MESSAGE = "uint8 OFF=0\nuint8 ON=1\nuint8 level\nstring label\n"
SERVICE = "string label\nstring text\n---\nbool done\n"
IMPORT = "from lamp_msgs.msg import Light\n"
CLASS = "class Lamp:\n    def __init__(self, node):\n        node.create_{start}\n    def react(self, data{more}):\n"
INCLUDE = "#include <lamp_msgs/msg/light.hpp>\n"


def review_source(repository, compare, name, text, files):
    """Return the breaking lines about a source after interfaces have changed."""
    repository.commit(
        {
            "lamp_msgs/package.xml": MANIFEST.format(name="lamp_msgs"),
            "lamp/package.xml": MANIFEST.format(name="lamp"),
            "lamp_msgs/msg/Light.msg": MESSAGE,
            "lamp_msgs/srv/Name.srv": SERVICE,
            f"lamp/src/{name}": text,
        }
    )
    for path, content in files.items():
        if content:
            repository.write({path: content})
        else:
            (repository.root / path).unlink()
    return [line for line in breaking(compare(repository)) if line.startswith("uses")]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        (IMPORT + "light = Light()\nlight.label = 'a'\n", "label"),
        (IMPORT + "light = Light(label='a')\n", "label"),
        (IMPORT + "light = Light(level=Light.ON)\n", "ON"),
        ("import lamp_msgs.msg\nlight = lamp_msgs.msg.Light()\nlight.label = 'a'\n", "label"),
        ("import lamp_msgs.msg as m\ndef f(p):\n    light = m.Light()\n    p.publish(light.label)\n", "label"),
        (IMPORT + "class A:\n  def a(self):\n    self.m = Light()\n  def b(self):\n    self.m.label = ''\n", "label"),
        (
            IMPORT
            + CLASS.format(start="subscription(Light, 'light', self.react, 10)", more="")
            + "        print(data.label)\n",
            "label",
        ),
        (IMPORT + "light = Light()\nlight.level = 1\n", None),
        (IMPORT + "light = Light()\nlight = make()\nlight.label = 'a'\n", None),
        (IMPORT + "light = Light()\nif hasattr(light, 'label'):\n    light.label = 'a'\n", None),
        (IMPORT + "def f(light):\n    light.label = 'a'\nlight = Light()\n", None),
        ("from other_msgs.msg import Light\nlight = Light()\nlight.label = 'a'\n", None),
    ],
)
def test_a_python_source_that_uses_a_lost_field_or_constant_is_named(repository, compare, text, name):
    files = {"lamp_msgs/msg/Light.msg": "uint8 OFF=0\nuint8 level\nstring title\n"}
    found = review_source(repository, compare, "lamp.py", text, files)
    assert found == ([f"uses '{name}', which 'lamp_msgs/Light' no longer has"] if name else [])


CALLBACK = IMPORT + CLASS.format(start="subscription(Light, 'light', self.react, 10)", more="")
SHOW = "        {}\n    def show(self, place, light):\n        print(light.label)\n"


@pytest.mark.parametrize(
    ("code", "is_named"),
    [
        (SHOW.format("self.show(0, data)"), True),
        (SHOW.format("threading.Thread(target=self.show, args=[0, data]).start()"), True),
        (SHOW.format("self.show(data, 0)"), False),
        (SHOW.format("self.lamp.show(0, data)"), False),
        (SHOW.format("self.show(0, data)") + "        self.show(0, None)\n", False),
        (SHOW.format("self.show(0, data)").replace("print", "light = 1; print"), False),
    ],
)
def test_message_that_a_callback_passes_on(repository, compare, code, is_named):
    files = {"lamp_msgs/msg/Light.msg": "uint8 OFF=0\nuint8 level\nstring title\n"}
    found = review_source(repository, compare, "lamp.py", CALLBACK + code, files)
    assert found == (["uses 'label', which 'lamp_msgs/Light' no longer has"] if is_named else [])


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("from lamp_msgs.srv import Name\n{service}        print(data.label)\n", "request label"),
        ("from lamp_msgs.srv import Name\nname = Name.Request()\nname.label = 'a'\n", "request label"),
        ("from lamp_msgs.srv import NameRequest\nname = NameRequest(label='a')\n", "request label"),
        ("from lamp_msgs.srv import Name\n{service}        print(answer.label)\n", None),
    ],
)
def test_a_python_source_that_uses_a_lost_field_of_a_service_is_named(repository, compare, text, name):
    service = CLASS.format(start="service(Name, 'name', self.react)", more=", answer")
    files = {"lamp_msgs/srv/Name.srv": SERVICE.replace("string label\n", "")}
    found = review_source(repository, compare, "lamp.py", text.format(service=service), files)
    assert found == ([f"uses '{name}', which 'lamp_msgs/Name' no longer has"] if name else [])


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("void f() {\n  lamp_msgs::msg::Light light;\n  light.label = 1;\n}\n", "label"),
        ("void f() {\n  auto light = lamp_msgs::msg::Light();\n  light.label = 1;\n}\n", None),
        ("void f(const lamp_msgs::msg::Light::SharedPtr light) {\n  g(light->label);\n}\n", "label"),
        ("void f(const lamp_msgs::LightConstPtr& light) {\n  g(light->label);\n}\n", None),
        ("void f(const lamp_msgs::Light::ConstPtr& light) {\n  g(light->label);\n}\n", "label"),
        ("void f() {\n  g(lamp_msgs::msg::Light::ON);\n}\n", "ON"),
        ("void f(std::shared_ptr<lamp_msgs::msg::Light> light) {\n  g(light->label);\n}\n", "label"),
        ("void f(lamp_msgs::msg::Light& light) {}\nvoid g(Other& light) {\n  light.label = 1;\n}\n", None),
        ("void f(lamp_msgs::msg::Light& light);\nvoid g() {\n  light.label = 1;\n}\n", None),
        ("void f() {\n  lamp_msgs::msg::Light light;\n  light.level = 1;\n  x.light.label = 1;\n}\n", None),
    ],
)
def test_a_cpp_source_that_uses_a_lost_field_or_constant_is_named(repository, compare, text, name):
    files = {"lamp_msgs/msg/Light.msg": "uint8 OFF=0\nuint8 level\nstring title\n"}
    found = review_source(repository, compare, "lamp.cpp", INCLUDE + text, files)
    assert found == ([f"uses '{name}', which 'lamp_msgs/Light' no longer has"] if name else [])


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("void f(const std::shared_ptr<lamp_msgs::srv::Name::Request> name) { g(name->label); }\n", "request label"),
        ("void f() { lamp_msgs::Name name; name.request.label = 1; }\n", "request label"),
        ("void f() { lamp_msgs::Name name; name.response.label = 1; }\n", None),
    ],
)
def test_a_cpp_source_that_uses_a_lost_field_of_a_service_is_named(repository, compare, text, name):
    files = {"lamp_msgs/srv/Name.srv": SERVICE.replace("string label\n", "")}
    found = review_source(repository, compare, "lamp.cpp", text, files)
    assert found == ([f"uses '{name}', which 'lamp_msgs/Name' no longer has"] if name else [])


@pytest.mark.parametrize(
    ("file", "text", "is_found"),
    [
        ("lamp.py", IMPORT, True),
        ("lamp.py", "import lamp_msgs.msg as m\nlight = m.Light()\n", True),
        ("lamp.py", f"try:\n    {IMPORT}except ImportError:\n    Light = None\n", False),
        ("lamp.cpp", "#include <lamp_msgs/Light.h>\n", True),
        ("lamp.cpp", INCLUDE, True),
        ("lamp.cpp", "// " + INCLUDE, False),
        ("lamp.cpp", "#include <lamp_msgs/msg/lightning.hpp>\n", False),
    ],
)
@pytest.mark.parametrize("is_renamed", [False, True])
def test_a_source_that_uses_a_removed_interface_is_named(repository, compare, file, text, is_found, is_renamed):
    files = {"lamp_msgs/msg/Light.msg": "", **({"lamp_msgs/msg/Lamp.msg": MESSAGE} if is_renamed else {})}
    found = review_source(repository, compare, file, text, files)
    assert found == (["uses the interface 'lamp_msgs/Light', which no longer exists"] if is_found else [])


@pytest.mark.parametrize(
    ("code", "is_named"),
    [
        ("state_.label = text;", True),
        ("f(this->state_.label);", True),
        ("other_.state_.label = text;", False),
        ("OtherState state_;\n  state_.label = text;", False),
        ("state_.level = 1;", False),
    ],
)
def test_a_source_that_uses_a_lost_field_of_a_member_of_its_base_class_is_named(repository, compare, code, is_named):
    base = f"#pragma once\n{INCLUDE}class Base {{\nprotected:\n  lamp_msgs::msg::Light state_;\n}};\n"
    repository.commit(
        {
            "lamp_msgs/package.xml": MANIFEST.format(name="lamp_msgs"),
            "lamp/package.xml": MANIFEST.format(name="lamp"),
            "lamp_msgs/msg/Light.msg": MESSAGE,
            "lamp/include/lamp/base.hpp": base,
            "lamp/include/lamp/lamp.hpp": '#pragma once\n#include "lamp/base.hpp"\nclass Lamp : public Base {};\n',
            "lamp/src/lamp.cpp": f'#include "lamp/lamp.hpp"\nvoid Lamp::run() {{\n  {code}\n}}\n',
        }
    )
    repository.write({"lamp_msgs/msg/Light.msg": MESSAGE.replace("string label\n", "")})
    lines = [line for line in breaking(compare(repository)) if line.startswith("uses")]
    assert lines == (["uses 'label', which 'lamp_msgs/Light' no longer has"] if is_named else [])


GENERATED = """cmake_minimum_required(VERSION 3.0)
project(house_msgs)
find_package(catkin REQUIRED COMPONENTS lamp_msgs message_generation)
add_message_files(FILES House.msg)
generate_messages(DEPENDENCIES lamp_msgs)
"""


@pytest.mark.parametrize(
    ("left", "build_tool", "is_found"),
    [([], "catkin", True), (["lamp_msgs/srv/Name.srv"], "catkin", False), ([], "ament", False)],
)
def test_interfaces_that_depend_on_a_package_without_interfaces_are_not_built(
    repository, compare, left, build_tool, is_found
):
    house = MANIFEST.format(name="house_msgs").replace(
        "</package>", f"<buildtool_depend>{build_tool}</buildtool_depend></package>"
    )
    files = {"lamp_msgs/msg/Light.msg": MESSAGE, "lamp_msgs/srv/Name.srv": SERVICE}
    build = {"house_msgs/package.xml": house, "house_msgs/CMakeLists.txt": GENERATED, "house_msgs/msg/House.msg": ""}
    repository.commit({"lamp_msgs/package.xml": MANIFEST.format(name="lamp_msgs"), **files, **build})
    repository.commit({path: None for path in files if path not in left})
    found = breaking(compare(repository, "HEAD~..HEAD"))
    line = "the interfaces depend on 'lamp_msgs', which no longer has any"
    assert (line in found) is is_found
