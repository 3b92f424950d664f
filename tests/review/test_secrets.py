"""Passwords and tokens in a review, which are published with it."""

from __future__ import annotations

import pytest

from linkwright.review.texts.secrets import find_secrets_in_text
from tests.review.conftest import sentences, subject

LAUNCH = """from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, DeclareLaunchArgument

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("password", default_value="robot"),
        IncludeLaunchDescription("caster.launch.py", launch_arguments={{{}}}.items()),
    ])
"""
PATH = "arm_description/launch/caster.launch.py"


def test_new_secret_is_hidden_and_named_as_such(package, compare):
    package.commit({PATH: LAUNCH.format("'port': '80'")})
    package.write({PATH: LAUNCH.format("'port': '80', 'token': 'a7#Bc9dE', 'label': 'robot'")})
    (text, *others) = sentences(subject(compare(package), PATH))
    assert "token ***" in text
    assert "(a secret in clear text)" in text
    assert not any("a7#Bc9dE" in sentence for sentence in (text, *others))


def test_removed_secret_is_hidden(package, compare):
    package.commit({PATH: LAUNCH.format("'token': 'a7#Bc9dE'")})
    package.write({PATH: LAUNCH.format("")})
    text = " ".join(sentences(subject(compare(package), PATH)))
    assert "a7#Bc9dE" not in text
    assert "clear text" not in text


def test_word_that_is_also_a_password_is_hidden_only_beside_the_name_of_a_secret(package, compare):
    parameters = "node:\n  ros__parameters:\n    frame: {}\n    password: {}\n"
    package.commit({"arm_description/config/a.yaml": parameters.format("lab", "admin")})
    package.write({"arm_description/config/a.yaml": parameters.format("robot", "robot")})
    lines = sentences(subject(compare(package), "arm_description/config/a.yaml"))
    assert any("frame lab -> robot" in line for line in lines)
    assert any("password *** -> ***" in line for line in lines)


@pytest.mark.parametrize(
    ("path", "text", "secrets"),
    [
        ("a.launch.py", 'DeclareLaunchArgument("wifi_password",\n  default_value="abc")', ["abc"]),
        ("a.launch.py", "{'api_key': 'k1', 'token': token}", []),
        ("a.launch.py", "{'api_key': 'k123', 'token': token}", ["k123"]),
        ("a.cpp", 'nh.param<std::string>("password", password_, "abc");', ["abc"]),
        ("a.cpp", 'if (!strcmp(token, "header")) {}', []),
        ("a.launch", '<param name="password" value="abc"/><arg name="token" default="$(env TOKEN)"/>', ["abc"]),
        ("a.urdf", '<param name="password">abc</param>', ["abc"]),
        ("a.yaml", "password: abc  # not this one\ntokenizer: def\npassword_file: ghi\n", ["abc"]),
        ("a.yaml", "id-token: write\nsecret: ${{ secrets.KEY }}\nurl: rtsp://eve:abc@10.0.0.1/1\n", ["abc"]),
        ("a.yaml", "password: {type: string}\ntoken:\n  type: string\n", []),
    ],
)
def test_secrets_are_found_in_files(path, text, secrets):
    assert list(find_secrets_in_text(path, text)) == secrets
