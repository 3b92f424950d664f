"""The lines of a review about sources that still use the old type of a topic, service or action."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking

MANIFEST = "<package><name>{name}</name><version>1.0.0</version></package>\n"
PUBLISHER = "import rospy\nfrom std_msgs.msg import String, Int32\np = rospy.Publisher('{name}', {type})\n"
SUBSCRIBER = "import rospy\nfrom std_msgs.msg import String, Int32\ns = rospy.Subscriber('{name}', {type}, print)\n"
TOPIC = "subscription '{name}' still has the type {old}; 'lamp/a.py' now uses Int32"


@pytest.mark.parametrize(
    ("topic", "user", "text", "found"),
    [
        ("light", "lamp/b.py", SUBSCRIBER.format(name="light", type="String"), ["String"]),
        ("/light", "lamp/b.py", SUBSCRIBER.format(name="light", type="String"), ["String"]),
        ("/light", "house/b.py", SUBSCRIBER.format(name="/light", type="String"), ["String"]),
        ("light", "house/b.py", SUBSCRIBER.format(name="light", type="String"), ["String"]),
        ("light", "house/b.py", SUBSCRIBER.format(name="light", type="Int32"), []),
        ("~/light", "house/b.py", SUBSCRIBER.format(name="~/light", type="String"), []),
        ("image_raw", "house/b.py", SUBSCRIBER.format(name="image_raw", type="String"), []),
        ("light", "lamp/b.py", SUBSCRIBER.format(name="light", type="Int32"), []),
        ("light", "lamp/b.py", SUBSCRIBER.format(name="lights", type="String"), []),
        ("light", "lamp/test/b.py", SUBSCRIBER.format(name="light", type="String"), []),
        ("light", "lamp/b.py", PUBLISHER.format(name="light", type="String"), []),
    ],
)
def test_a_source_that_subscribes_with_the_old_type_is_named(repository, compare, topic, user, text, found):
    repository.commit(
        {
            "lamp/package.xml": MANIFEST.format(name="lamp"),
            "house/package.xml": MANIFEST.format(name="house"),
            "lamp/a.py": PUBLISHER.format(name=topic, type="String"),
            user: text,
        }
    )
    repository.write({"lamp/a.py": PUBLISHER.format(name=topic, type="Int32")})
    lines = [line for line in breaking(compare(repository)) if "still has the type" in line]
    assert lines == [TOPIC.format(name=topic if topic in text else "light", old=old) for old in found]


def test_a_subscription_whose_old_type_another_source_still_publishes_is_not_named(repository, compare):
    repository.commit(
        {
            "lamp/package.xml": MANIFEST.format(name="lamp"),
            "lamp/a.py": PUBLISHER.format(name="light", type="String"),
            "lamp/simulated.py": PUBLISHER.format(name="light", type="String"),
            "lamp/b.py": SUBSCRIBER.format(name="light", type="String"),
        }
    )
    repository.write({"lamp/a.py": PUBLISHER.format(name="light", type="Int32")})
    assert not [line for line in breaking(compare(repository)) if "still has the type" in line]


def test_a_subscription_of_another_package_is_not_named_if_a_third_one_publishes_the_topic(repository, compare):
    packages = "lamp", "house", "sun"
    repository.commit(
        {
            **{f"{name}/package.xml": MANIFEST.format(name=name) for name in packages},
            "lamp/a.py": PUBLISHER.format(name="light", type="String"),
            "sun/a.py": PUBLISHER.format(name="light", type="Int32"),
            "house/b.py": SUBSCRIBER.format(name="light", type="String"),
        }
    )
    repository.write({"lamp/a.py": PUBLISHER.format(name="light", type="Int32")})
    assert not [line for line in breaking(compare(repository)) if "still has the type" in line]


def test_a_client_with_the_old_type_is_named(repository, compare):
    service = "import rospy\nfrom std_srvs.srv import Empty, Trigger\ns = rospy.Service('tags', {type}, print)\n"
    client = "import rospy\nfrom std_srvs.srv import Trigger\nc = rospy.ServiceProxy('tags', Trigger)\n"
    repository.commit(
        {
            "lamp/package.xml": MANIFEST.format(name="lamp"),
            "lamp/a.py": service.format(type="Trigger"),
            "lamp/b.py": client,
        }
    )
    repository.write({"lamp/a.py": service.format(type="Empty")})
    assert "service client 'tags' still has the type Trigger; 'lamp/a.py' now uses Empty" in breaking(
        compare(repository)
    )


def test_a_client_with_the_type_of_another_package_is_named(repository, compare):
    service = "import rospy\nfrom {package}.srv import Tags\ns = rospy.Service('tags', Tags, print)\n"
    client = "import rospy\nfrom old_msgs.srv import Tags\nc = rospy.ServiceProxy('tags', Tags)\n"
    repository.commit(
        {
            "lamp/package.xml": MANIFEST.format(name="lamp"),
            "lamp/a.py": service.format(package="old_msgs"),
            "lamp/b.py": client,
        }
    )
    repository.write({"lamp/a.py": service.format(package="new_msgs")})
    line = "service client 'tags' still has the type old_msgs/Tags; 'lamp/a.py' now uses new_msgs/Tags"
    assert line in breaking(compare(repository))


def test_a_publisher_whose_type_is_of_an_unknown_package_is_not_named(repository, compare):
    subscriber = "import rospy\nfrom {package}.msg import Tags\ns = rospy.Subscriber('tags', Tags, print)\n"
    publisher = "import rospy\np = rospy.Publisher('tags', find_type().Tags)\n"
    repository.commit(
        {
            "lamp/package.xml": MANIFEST.format(name="lamp"),
            "lamp/a.py": subscriber.format(package="old_msgs"),
            "lamp/b.py": publisher,
        }
    )
    repository.write({"lamp/a.py": subscriber.format(package="new_msgs")})
    assert not [line for line in breaking(compare(repository)) if "still has the type" in line]
